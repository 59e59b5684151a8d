"""Report of the runs of a paper: claims, figures, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from deodar.analysis.claims import Claim

if TYPE_CHECKING:
    from matplotlib.figure import Figure


NOT_RUN = "(not run)"
"""Replaces a number for which no runs are stored."""


@dataclass(frozen=True)
class Report:
    """Report of an experiment.

    Attributes:
        claims: figures and sentences that were checked.
        figures: by file name without its ending.
        tables: Markdown by file name without its ending.
        numbers: results that the manual states, by name: numbers as text, and tables in Markdown.
    """

    claims: Sequence[Claim]
    figures: Mapping[str, Figure] = field(default_factory=dict[str, "Figure"])
    tables: Mapping[str, str] = field(default_factory=dict[str, str])
    numbers: Mapping[str, str] = field(default_factory=dict[str, str])
