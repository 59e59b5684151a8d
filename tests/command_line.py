"""Commands typed in the process of a test."""

from __future__ import annotations

import contextlib
import io
import json
import shlex
from pathlib import Path
from typing import Any, NamedTuple

from deodar.cli import main


class Typed(NamedTuple):
    """What a command leaves.

    Attributes:
        status: its exit status.
        out: what it printed.
        err: what it printed on stderr.
    """

    status: int
    out: str
    err: str

    @property
    def words(self) -> str:
        """Everything printed, in one line."""
        return " ".join(f"{self.out} {self.err}".split())

    @property
    def json(self) -> Any:
        """What was printed, read as JSON."""
        return json.loads(self.out)


def typed(*words: str | Path) -> Typed:
    """Run a command as if it was typed behind `deodar`: texts are split as by a shell, paths are not."""
    line = [part for word in words for part in ([str(word)] if isinstance(word, Path) else shlex.split(word))]
    out, err = io.TextIOWrapper(io.BytesIO(), "utf-8"), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(line)
        except SystemExit as ended:
            status = ended.code if isinstance(ended.code, int) else int(ended.code is not None)
    out.seek(0)
    return Typed(status, out.read(), err.getvalue())
