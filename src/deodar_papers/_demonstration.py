"""Result of the quick form of a paper, `deodar demo NAME`: claims and files."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from deodar.cli._options import shown
from deodar.codec import Json

if TYPE_CHECKING:
    from deodar.analysis.claims import Claim


class Show(Protocol):
    """What a running demonstration shows."""

    def __call__(self, task: str, share: float) -> None:
        """Show the present task and the completed share, until the next call."""
        ...

    def line(self, text: str) -> None:
        """Print a line of the result."""
        ...


@dataclass(frozen=True)
class Demonstration:
    """Result of a demonstration.

    Attributes:
        claims: the checked claims.
        settings: arguments of the run, apart from the name of the demonstration and its seed.
        written: names of the files, in words.
        sentence: the result in one sentence.
        fill: writes the files into a folder, all but `results.json`.
        model: name of a document in the folder that the studio may open; "" for none.
    """

    claims: Sequence[Claim]
    settings: Mapping[str, Json]
    written: str
    sentence: str
    fill: Callable[[Path], None]
    model: str = ""

    def lines(self, out: Path) -> Iterator[str]:
        """Yield what is printed after the folder `out` is written."""
        for c in self.claims:
            mark = "?" if c.holds is None else "yes" if c.holds else "NO"
            measured = f" -> {c.value}" if c.holds is not True or isinstance(c.value, int) else ""
            yield f"  {mark:4}{c.name}{measured}"
        yield f"Written to {shown(out)}: {self.written} and results.json."
        yield self.sentence
