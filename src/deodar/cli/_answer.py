"""What a command answers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from deodar import codec

if TYPE_CHECKING:
    from deodar.errors import Problem


INTERRUPTED = 130
"""The exit status after Ctrl-C, as shells have it: 128 and the number of SIGINT."""


@dataclass(frozen=True)
class CommandAnswer:
    """The answer of a command, which `main` prints.

    Attributes:
        fields: what `--json` prints.
        lines: what is printed without it, one after another; a line may be made when it is printed.
        status: the exit status.
    """

    fields: object
    lines: Iterable[str] = ()
    status: int = 0

    def tell(self, as_json: bool) -> int:
        """Print the answer, and return the status."""
        for line in (codec.text(self.fields),) if as_json else self.lines:
            print(line)
        return self.status


def problem_data(problems: Sequence[Problem]) -> list[dict[str, Any]]:
    """Return problems as plain data, with what to type in a shell, and as edits of the document."""
    return [
        {"severity": p.severity, "where": p.where, "what": p.what, "fix": p.fix_at("shell")}
        | ({"edits": [e.plain_data() for e in p.edits]} if p.edits else {})
        for p in problems
    ]
