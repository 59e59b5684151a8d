"""The fallback for a result that cannot be written to its folder: write it to another folder."""

from __future__ import annotations

import contextlib
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

import platformdirs

from deodar.cli import _question
from deodar.errors import DeodarError, OutputError, OutputExists, Problem
from deodar.recording import places

Done = TypeVar("Done")


def rescue(error: DeodarError, write: Callable[[Path], Done], first: Sequence[Path], ask: bool) -> Done:
    """Write to the first writable folder, and return the result of `write`.

    On a terminal the user is asked for folders, until one is writable or the answer is empty. The next
    candidates are the system's folder for user data and the folder for temporary files.

    Args:
        error: the error of the requested folder.
        write: writes the result into a folder.
        first: folders that are tried before the user is asked.
        ask: whether the user may be asked.

    Raises:
        OutputError: if no folder is writable; the message lists all of them.
    """
    tried = [error]
    for folder in _folders(tried, first, ask and _question.on_terminal()):
        try:
            places.require_parent(folder / "result")
            return write(folder)
        except DeodarError as again:
            tried.append(again)
    lost = Problem(
        "", "the result could not be written anywhere, so it is lost", "Make room and run it again"
    )
    raise OutputError([*(p for e in tried for p in e.problems), lost]) from None


def elsewhere(error: DeodarError, out: Path, fill: Callable[[Path], None], ask: bool) -> Path:
    """Write a whole folder to another place, under its requested name and a number.

    Args:
        error: the error of `out`; if another process has created `out` meanwhile, the new folder is beside
            it.
        out: the requested folder.
        fill: fills a folder.
        ask: whether the user may be asked.

    Raises:
        OutputError: if no folder is writable.
    """

    def write(parent: Path) -> Path:
        second = places.free(parent, out.name)
        places.write_folder(second, fill)
        return second

    return rescue(error, write, [out.parent] if isinstance(error, OutputExists) else [], ask)


def _folders(tried: list[DeodarError], first: Sequence[Path], ask: bool) -> Iterator[Path]:
    yield from first
    while ask:
        print(
            f"{tried[-1]}\nThe result is still in memory. Another folder for it (empty: a folder of yours is"
            " chosen): ",
            end="",
            file=sys.stderr,
        )
        sys.stderr.flush()
        answer = sys.stdin.readline().strip()
        if not answer:
            break
        yield Path(answer).expanduser()
    yield from _own()


def _own() -> Iterator[Path]:
    """Yield the folders for user data and for temporary files; the caller skips those that it cannot
    create.
    """
    results = platformdirs.user_data_path("deodar", appauthor=False) / "results"
    with contextlib.suppress(OSError):
        results.mkdir(parents=True, exist_ok=True)
    yield results
    yield Path(tempfile.gettempdir())
