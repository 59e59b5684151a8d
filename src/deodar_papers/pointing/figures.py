"""Figures 8 and 11 of the paper, from a run of the demonstration."""

from __future__ import annotations

from typing import TYPE_CHECKING

from deodar_papers.figures.pointing import pointing_figure
from deodar_papers.pointing.narrative import Pointed, discs, distance, plane

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure(result: Pointed) -> Figure:
    """Draw a run of the demonstration."""
    names = [" ".join(pair) for pair in result.asked]
    cycles = list(zip(result.starts, names, strict=True))
    return pointing_figure(result.views, result.moments, cycles, distance(result), discs(), plane())
