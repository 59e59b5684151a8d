"""Result of the quick form of a paper, `deodar demo NAME`: claims and files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.codec import Json

if TYPE_CHECKING:
    from deodar.analysis.claims import Claim

Show = Callable[[str, float], None]
"""Callback of a running demonstration, called with its present task and the completed share."""


@dataclass(frozen=True)
class Demonstration:
    """Result of a demonstration.

    Attributes:
        claims: the checked claims.
        settings: arguments of the run, apart from the name of the demonstration and its seed.
        written: names of the files, in words.
        sentence: the result in one sentence.
        fill: writes the files into a folder, all but `results.json`.
    """

    claims: Sequence[Claim]
    settings: Mapping[str, Json]
    written: str
    sentence: str
    fill: Callable[[Path], None]
