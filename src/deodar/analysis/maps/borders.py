"""The borders of a map of regimes that are folds of steady states, computed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import DENSE, ParameterLine
from deodar.analysis.continuation.locus import Locus, nearest
from deodar.analysis.continuation.locus_plane import FoldPlane
from deodar.analysis.continuation.right_hand_side import RightHandSide, right_hand_side
from deodar.analysis.continuation.walk import begun, walk
from deodar.analysis.isolated import Isolated, isolate
from deodar.analysis.maps.labels import RegimeLabel
from deodar.analysis.maps.map_result import RegimeMap
from deodar.analysis.peaks import peaks
from deodar.analysis.settling_copies import driven_alone
from deodar.errors import AnalysisError
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.numerics.axes import Axes


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


INPUT = "input.amplitude"

SETTLING, PASSAGE = 200.0, 1000.0
"""Time constants for which the field runs before Newton's method begins, and beyond a fold."""

BEYOND = 1e-3
"""Distance from a fold at which the state beyond it is computed, as a share of a tenth of the map."""

STATES, HALVINGS = 60, 6
"""Largest number of states between two cells; halvings of the step in which a line stops to be a border."""

ON = 0.02
"""Largest distance of a cusp from the line on which it is, in tenths of the map; the last step of a line is
known as well as this.
"""


@dataclass(frozen=True)
class FoldSearch:
    """Where a fold is sought.

    Attributes:
        name: name of the fold.
        strength: amplitude of the input.
        made: amplitude of an input that has been there before; 0: none.
        awake: whether the state that vanishes has a peak.
    """

    name: str
    strength: float
    made: float
    awake: bool


class BorderField:
    """The field of a map, measured alone, over the parameters of the map.

    States are even about the middle of the axis, in which the input is, unless the field distinguishes both
    sides.

    Args:
        regime_map: the map.

    Raises:
        AnalysisError: the input is not in the middle, or the field has more states than are kept as matrices.
    """

    def __init__(self, regime_map: RegimeMap) -> None:
        settings, doc = regime_map.about, regime_map.document
        isolated = isolate(
            Model(document=doc),
            settings["field"],
            sigma=settings["sigma"] or None,
            center=settings["center"] or None,
            dt=settings["dt"],
            inputs=settings["inputs"],
        )
        self.axes: Axes = isolated.axes
        self.parameters = regime_map.parameters
        small = _small(isolated, doc, regime_map.parameters)
        self.right_hand_side = equations = _even(small, [*regime_map.parameters, INPUT], isolated)
        if equations.size > DENSE:
            raise AnalysisError(
                f"the field has {equations.size} states, and a locus is followed with at most {DENSE}",
                where=isolated.path,
                fix="Map the field on a coarser grid",
            )
        threshold = (find.element(small.document, "field").id, "sigmoid.threshold")
        driven = [
            threshold in driven_alone(doc, small.document, isolated, path) for path in regime_map.parameters
        ]
        self._threshold_of = driven.index(True) if any(driven) else None
        self._threshold = isolated.threshold
        cells = [np.diff(values).max() / 2 for values in regime_map.values]
        self.box = np.array([(v[0] - c, v[-1] + c) for v, c in zip(regime_map.values, cells, strict=True)])

    def fold(self, of: FoldSearch, begin: np.ndarray, end: np.ndarray, axis: int) -> list[Locus]:
        """Return the lines of the fold between two points of the plane that differ in one parameter.

        They are the parts on which the fold is a border; none if there is no such fold.
        """
        equations = self.right_hand_side
        p = np.append(begin, of.strength)
        x = equations.start
        if of.made:
            x = equations.settle(x, np.append(begin, of.made), SETTLING)
        x = equations.settle(x, p, SETTLING)
        line = ParameterLine(equations, axis, p, float(np.ptp(self.box[axis])) / 10)
        start = begun(line, x, float(begin[axis]), float(np.sign(end[axis] - begin[axis])))
        if start is None or self._awake(line.state(start.z), begin) != of.awake:
            return []
        low, high = sorted((float(begin[axis]), float(end[axis])))
        for fold in walk(line, start, (low, high), STATES, step=0.02).bifurcations:
            if fold.kind == "fold":
                plane = FoldPlane(fold, equations.parameters[1 - axis], self.box[[axis, 1 - axis]])
                if self._ends(of, plane, plane.start(fold)):
                    return self._parts(of, plane, fold)
        return []

    def _parts(self, of: FoldSearch, plane: FoldPlane, fold: Bifurcation) -> list[Locus]:
        """Return the parts of a line on which the fold is a border, each with the points on it."""
        walked = plane.both(fold)
        border = [self._ends(of, plane, z) for z in walked]
        marks = plane.points(walked)
        out: list[Locus] = []
        for begin, end in stretches(border):
            part = walked[begin : end + 1]
            if begin > 0:
                part = [self._last(of, plane, walked[begin], walked[begin - 1]), *part]
            if end + 1 < len(walked):
                part.append(self._last(of, plane, walked[end], walked[end + 1]))
            values = np.array([plane.values(z) for z in part])
            first, second = (self.parameters[c] for c in plane.columns)
            on = tuple(mark for mark in marks if _on(values, np.array(mark.values), plane.lengths))
            out.append(
                Locus(f"fold ({of.name})", (first, second), values, on, fold.line).over(*self.parameters)
            )
        return out

    def _last(self, of: FoldSearch, plane: FoldPlane, inside: np.ndarray, outside: np.ndarray) -> np.ndarray:
        """Return the last point of a line that is a border, between one that is and one that is not."""
        for _ in range(HALVINGS):
            chord = outside - inside
            correction = plane.corrected(inside + chord / 2, chord / np.linalg.norm(chord))
            if correction is None:
                break
            if self._ends(of, plane, correction[0]):
                inside = correction[0]
            else:
                outside = correction[0]
        return inside

    def _ends(self, of: FoldSearch, plane: FoldPlane, z: np.ndarray) -> bool:
        """Return whether a peak appears, or vanishes, beyond a fold."""
        x, equations = plane.state(z), self.right_hand_side
        if self._awake(x, plane.parameters(z)) != of.awake:
            return False
        p = plane.parameters(z)
        p[plane.columns] += BEYOND * plane.beyond(z) * plane.lengths
        return self._awake(equations.settle(x, p, PASSAGE, least=1e-6), p) != of.awake

    def _awake(self, x: np.ndarray, parameters: np.ndarray) -> bool:
        """Return whether a state has a peak."""
        threshold = self._threshold if self._threshold_of is None else float(parameters[self._threshold_of])
        return bool(peaks(self.right_hand_side.state(x)["field.activation"], self.axes, threshold))


def stretches(flags: Sequence[bool]) -> list[tuple[int, int]]:
    """Return the first and the last place of each stretch of places that are true."""
    changes = np.flatnonzero(np.diff([False, *flags, False]))
    return [(int(begin), int(after) - 1) for begin, after in changes.reshape(-1, 2)]


def _on(values: np.ndarray, at: np.ndarray, lengths: np.ndarray) -> bool:
    """Return whether a point lies on a line, of which it may be the end."""
    return nearest(values / lengths, at / lengths)[0] < ON


def _small(isolated: Isolated, doc: Document, parameters: tuple[str, str]) -> Model:
    """Return the isolated field with one input, and document parameters with the names of the map."""
    small = Model(document=isolated.session.document)
    for name in ("second", "boost"):
        small.remove(name)
    middle = [float(axis.points[[0, -1]].mean()) for axis in isolated.axes]
    for axis, center, position in zip(isolated.axes, middle, isolated.center, strict=True):
        # on an even number of samples no sample is in the middle; a periodic axis has none
        if not axis.periodic and abs(position - center) > 0.51 * axis.step:
            raise AnalysisError(
                f"the input of the map is at {position:g}, and the middle of {axis.name} is {center:g}",
                where=isolated.path,
                fix="Map the field with its input in the middle",
            )
    if middle:
        small.set("input.center", middle[0])
    changed = small.document
    for path in parameters:
        leaves = driven_alone(doc, small.document, isolated, path)
        field = find.element(small.document, "field")
        if any(path == f"{field.path}.{leaf}" for ident, leaf in leaves if ident == field.id):
            continue  # a field that is called so has the path already
        changed = edit.document_parameter(changed, path, float(np.ravel(find.value(doc, path))[0]))
        for ident, leaf in leaves:
            changed = edit.link(changed, ident, leaf, path)
    small.commit(changed)
    return small


def _even(small: Model, parameters: list[str], isolated: Isolated) -> RightHandSide:
    """Return the right-hand side of even states; of all states where the field distinguishes both sides."""
    whole = right_hand_side(small, parameters)
    if not isolated.axes:
        return whole
    test = np.random.default_rng(0).standard_normal(whole.size)
    state = {key: x + np.flip(x) for key, x in whole.state(test).items()}
    rates = whole.state(whole.rates(whole.vector(state), whole.values))
    if any(np.abs(x - np.flip(x)).max() > 1e-6 * (1 + np.abs(x).max()) for x in rates.values()):
        return whole
    return right_hand_side(small, parameters, even=[axis.name for axis in isolated.axes])
