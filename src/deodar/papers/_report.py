"""What the runs of a paper say: claims, figures, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from deodar.analysis.claims import Claim

if TYPE_CHECKING:
    from matplotlib.figure import Figure


NOT_RUN = "(not run)"
"""Written in place of a number where no runs are kept."""


@dataclass(frozen=True)
class Report:
    """What is said of an experiment.

    Attributes:
        claims: figures and sentences that were checked.
        figures: by file name without its ending.
        tables: Markdown by file name without its ending.
        numbers: what the manual says of the runs, by name: numbers as text, and tables in Markdown.
    """

    claims: Sequence[Claim]
    figures: Mapping[str, Figure] = field(default_factory=dict[str, "Figure"])
    tables: Mapping[str, str] = field(default_factory=dict[str, str])
    numbers: Mapping[str, str] = field(default_factory=dict[str, str])
