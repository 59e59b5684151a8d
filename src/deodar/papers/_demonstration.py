"""What the quick form of a paper, `deodar demo NAME`, gives: claims, and the files that go with them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deodar.analysis.claims import Claim

Show = Callable[[str, float], None]
"""Called while a demonstration runs, with what it does and the share that is done."""


@dataclass(frozen=True)
class Demonstration:
    """A demonstration that was run.

    Attributes:
        claims: what was checked.
        settings: what the run was given, apart from the name of the demonstration and its seed.
        written: names of the files, in words.
        sentence: the result in one sentence.
        fill: writes the files into a folder, all but `results.json`.
    """

    claims: Sequence[Claim]
    settings: Mapping[str, Any]
    written: str
    sentence: str
    fill: Callable[[Path], None]
