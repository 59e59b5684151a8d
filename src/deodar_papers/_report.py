"""Report of the runs of a paper: claims, also those that are shares of runs, figures, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from deodar.analysis import statistics
from deodar.analysis.claims import Claim
from deodar.analysis.statistics import rounded

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


def required_share(name: str, true: Sequence[bool], least: float, source: str, quick: bool) -> Claim:
    """Return the required claim that at least a share of the runs is true.

    Args:
        name: the claim, in words.
        true: whether it holds in each run.
        least: the least share; 1 allows no exception.
        source: where the target is stated.
        quick: whether few runs decide it only if their interval excludes the target.
    """
    hits, n = sum(true), len(true)
    interval = statistics.wilson(hits, n) if n else None
    if least == 1.0:
        holds = None if not n else hits == n
    else:
        holds = statistics.decided(hits / n if n else None, interval, n, least, 1.0, quick)
    value = round(hits / n, 4) if n else None
    return Claim(name, value, f">= {least:g}", holds, "required", source, n, rounded(interval), origin="ours")


def reported_share(name: str, true: Sequence[bool], source: str) -> Claim:
    """Return a share without a target."""
    interval = statistics.wilson(sum(true), len(true)) if true else None
    value = round(sum(true) / len(true), 4) if true else None
    return Claim(name, value, "none", None, "reported", source, len(true), rounded(interval), origin="none")
