"""Figures of files of analyses: a map of regimes, branches of steady states, or loci, as from the objects."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from deodar.analysis.continuation.branch import SteadyBranch
from deodar.analysis.continuation.locus import Locus
from deodar.analysis.maps.map_result import RegimeMap
from deodar.errors import FigureError
from deodar.figures.bifurcation import bifurcation_diagram
from deodar.figures.locus import locus_figure
from deodar.figures.regime_map import regime_map_figure
from deodar.recording.record import about

if TYPE_CHECKING:
    import xarray

MAP, BRANCH, LOCUS = "map of regimes", "branch", "locus"
"""What a file may hold, in words."""

_KINDS = {RegimeMap.KIND: MAP, SteadyBranch.KIND: BRANCH, Locus.KIND: LOCUS}


def kind_of(data: xarray.Dataset) -> str:
    """Return which analysis a record holds, in words; empty for a run."""
    made = about(data)
    return next((words for key, words in _KINDS.items() if key in made), "")


def analysis_figure(files: Sequence[tuple[Path, str]], shown: str = "") -> Figure:
    """Draw files of analyses in one figure: branches, loci, or a map with loci on it.

    Args:
        files: paths of the files, and what each holds.
        shown: the port that is drawn of branches; "": the activation of the first field.

    Raises:
        FigureError: the files are not drawn together.
        RecordError: a file is damaged.
    """
    maps, branches, loci = ([path for path, kind in files if kind == own] for own in (MAP, BRANCH, LOCUS))
    if len(maps) > 1 or (branches and (maps or loci)) or len(maps + branches + loci) < len(files):
        raise FigureError(
            f"these are not drawn together: {', '.join(kind or 'a run' for _, kind in files)}",
            fix="Give branches, loci, or one map and loci",
        )
    if shown and not branches:
        raise FigureError(f"{shown!r} is a port, and only branches have ports")
    if branches:
        return bifurcation_diagram(*(SteadyBranch.load(path) for path in branches), shown=shown)
    lines = [Locus.load(path) for path in loci]
    if maps:
        return regime_map_figure(RegimeMap.load(maps[0]), lines)
    return locus_figure(*lines)
