"""The borders of a map of regimes that are folds of steady states, computed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from deodar.analysis.continuation.locus import Locus
from deodar.analysis.continuation.nearest import nearest
from deodar.analysis.maps.border_field import BorderField, FoldSearch
from deodar.analysis.maps.labels import RegimeLabel
from deodar.analysis.maps.map_result import RegimeMap


@dataclass(frozen=True)
class FoldBorder:
    """A border between labels that a fold may be.

    Attributes:
        name: name of the fold.
        inside: labels of the cells in which the state exists that vanishes in the fold.
        outside: labels of the cells in which it does not.
        with_input: whether the state has the input of the map.
        awake: whether the state has a peak, which the input of the map has made.
    """

    name: str
    inside: tuple[RegimeLabel, ...]
    outside: tuple[RegimeLabel, ...]
    with_input: bool
    awake: bool


_PEAKED = (
    RegimeLabel.DRIVEN,
    RegimeLabel.SUSTAINED,
    RegimeLabel.SELECTIVE,
    RegimeLabel.SUSTAINED_SELECTIVE,
)
_SUSTAINED = RegimeLabel.SUSTAINED, RegimeLabel.SUSTAINED_SELECTIVE
_DRIVEN = RegimeLabel.DRIVEN, RegimeLabel.SELECTIVE
_SILENT = (RegimeLabel.SILENT,)

BORDERS = (
    FoldBorder("detection", _SILENT, (*_PEAKED, RegimeLabel.UNBOUNDED), with_input=True, awake=False),
    FoldBorder("forgetting", _SUSTAINED, _DRIVEN, with_input=False, awake=True),
    FoldBorder(
        "detection without input",
        (*_SILENT, *_PEAKED, RegimeLabel.UNBOUNDED),
        (RegimeLabel.ACTIVE,),
        with_input=False,
        awake=False,
    ),
)
"""The borders that are folds: of the resting state with input, of a peak without input, and of the resting
state without input.
"""


class CellEdge(NamedTuple):
    """The edge between two cells: the parameter that differs, the cell inside, and the step to the other."""

    axis: int
    cell: tuple[int, int]
    step: int


def regime_loci(found: RegimeMap) -> list[Locus]:
    """Compute the borders of a map that are folds of the field, as lines over its parameters.

    From a cell beside a border the steady state that vanishes there is followed to the next cell. If it ends
    in a fold, the fold is followed in both parameters. This is repeated until each edge between two cells of
    the border has a line within a cell, or has no fold.

    The fold `detection` ends the resting state with the map's input, and silence; `forgetting` ends the peak
    without input, and self-sustained; `detection without input` ends the resting state without input, and
    active at rest lies beyond it. A line ends at a cusp, or where another fold becomes the border.

    Other borders are no folds. Where a peak grows steadily out of its input no state vanishes. Selective
    begins at a branch point, and unbounded is a matter of the width of a peak.

    Args:
        found: the map.

    Returns:
        The lines; an empty list if no border is a fold.

    Raises:
        AnalysisError: the input of the map is not in the middle of the field, or the field has more states
            than are kept as matrices.
    """
    field = BorderField(found)
    return [line for border in BORDERS for line in _lines(found, field, border)]


def _lines(regime_map: RegimeMap, field: BorderField, border: FoldBorder) -> list[Locus]:
    """Return the lines that are a border."""
    strength = float(regime_map.about["strength"])
    search = FoldSearch(
        border.name,
        strength if border.with_input else 0.0,
        strength if border.awake else 0.0,
        border.awake,
    )
    pending = list(edges(regime_map, border))
    out: list[Locus] = []
    while pending:
        edge = pending.pop(0)
        begin, end = _ends(regime_map, border, edge)
        lines = field.fold(search, begin, end, edge.axis)
        out += lines
        pending = [e for e in pending if all(cells_between(regime_map, e, line) > 1 for line in lines)]
    return out


def edges(regime_map: RegimeMap, border: FoldBorder) -> Iterator[CellEdge]:
    """Return the edges between cells inside and outside of a border."""
    inside, outside = (np.isin(regime_map.labels, kinds) for kinds in (border.inside, border.outside))
    for i, j in np.argwhere(inside):
        for axis, step in ((0, -1), (0, 1), (1, -1), (1, 1)):
            beside = [int(i), int(j)]
            beside[axis] += step
            if 0 <= beside[axis] < regime_map.labels.shape[axis] and outside[tuple(beside)]:
                yield CellEdge(axis, (int(i), int(j)), step)


def cells_between(regime_map: RegimeMap, edge: CellEdge, line: Locus) -> float:
    """Return the distance of the middle of an edge to a line, in cells; the larger coordinate counts."""
    cells = np.array([np.diff(values).mean() for values in regime_map.values])
    begin, end = (_place(regime_map, edge, steps) for steps in (0, 1))
    return nearest(line.values / cells, (begin + end) / 2 / cells)[0]


def _ends(regime_map: RegimeMap, border: FoldBorder, edge: CellEdge) -> tuple[np.ndarray, np.ndarray]:
    """Return the points between which a fold is sought, a cell more on each side.

    Beside a fold a run may count as settled before it has passed it.
    """
    behind = list(edge.cell)
    behind[edge.axis] -= edge.step
    in_map = 0 <= behind[edge.axis] < regime_map.labels.shape[edge.axis]
    back = -1 if in_map and regime_map.labels[tuple(behind)] in border.inside else 0
    return _place(regime_map, edge, back), _place(regime_map, edge, 2)


def _place(regime_map: RegimeMap, edge: CellEdge, steps: int) -> np.ndarray:
    """Return the parameters of the cell that lies a number of steps across an edge, or at the map's end."""
    at = list(edge.cell)
    at[edge.axis] = int(np.clip(at[edge.axis] + steps * edge.step, 0, regime_map.labels.shape[edge.axis] - 1))
    return np.array([values[k] for values, k in zip(regime_map.values, at, strict=True)])
