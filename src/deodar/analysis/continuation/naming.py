"""The names that Dynamic Field Theory has for bifurcations, from the peaks on both sides."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.walk import WalkPoint
from deodar.analysis.peaks import peaks
from deodar.elements.field import Field
from deodar.numerics.axes import Axes

BEYOND = 1e-3
"""Distance from a fold at which the state beyond it is computed, as a share of the length of the line."""

PASSAGE = 1000.0
"""Time constants for which the model runs there at most; it passes the fold in about pi / sqrt(distance)."""

GROWTH = 8.0
"""Time for which a growing mode grows from a branch point on, in units of 1 / its growth rate: by 3000."""

MOVED = 1e-2
"""Largest activation by which the state is moved along the mode."""

AHEAD = 6
"""Points on the unstable side of a branch point among which the one that is left fastest is taken."""


def named(bifurcation: Bifurcation, points: Sequence[WalkPoint]) -> Bifurcation:
    """Return a bifurcation with its name, where a stable state loses its stability in it.

    From the bifurcation the model runs at a value just beyond it: if peaks appear, it is a detection; if a
    peak vanishes that has localised input, a reverse detection, and without such input forgetting. If it
    loses its stability at a branch point and fewer peaks are left, it is a selection.

    Args:
        bifurcation: the bifurcation.
        points: the points of its branch.
    """
    if bifurcation.kind == "Hopf":
        return bifurcation
    line = bifurcation.line
    before, after = points[bifurcation.index], points[bifurcation.index + 1]
    mode = bifurcation.vector / np.abs(bifurcation.vector).max()
    if bifurcation.kind == "fold":
        # both points lie on the side where the states exist
        values = [line.value(before.z), line.value(after.z)]
        value = bifurcation.value + BEYOND * line.length * float(np.sign(bifurcation.value - np.mean(values)))
        parameters = line.all_parameters(line.point(bifurcation.state, value))
        states = [line.right_hand_side.settle(bifurcation.state, parameters, PASSAGE)]
    else:
        first = max(0, bifurcation.index + 1 - AHEAD)
        behind, ahead = (
            points[first : bifurcation.index + 1],
            points[bifurcation.index + 1 : bifurcation.index + 1 + AHEAD],
        )
        side = behind if float(before.rates.real.max()) > float(after.rates.real.max()) else ahead
        unstable = max(side, key=lambda point: float(point.rates.real.max()))
        parameters = line.all_parameters(unstable.z)
        longest = GROWTH / max(float(unstable.rates.real.max()) * line.slowest, 1e-3)
        x = line.state(unstable.z)
        states = [
            line.right_hand_side.settle(x + sign * MOVED * mode, parameters, longest + 50) for sign in (1, -1)
        ]
    for path, axes, threshold in _fields(bifurcation):
        counts = [_count(bifurcation, x, path, axes, threshold) for x in (bifurcation.state, *states)]
        peaks_here, beyond = counts[0], min(counts[1:])
        if beyond == peaks_here:
            continue
        if bifurcation.kind == "branch point":
            name = "selection" if 1 <= beyond < peaks_here else ""
        elif beyond > peaks_here:
            name = "detection"
        else:
            shape = line.right_hand_side.read(f"{path}.input", bifurcation.state, parameters)
            local = bool(axes) and np.ptp(shape) > 1e-6 * max(1.0, float(np.abs(shape).max()))
            name = "reverse detection" if local or not axes else "forgetting"
        if name:
            return dc.replace(bifurcation, instability=name, where=path)
    return bifurcation


def _fields(bifurcation: Bifurcation) -> list[tuple[str, Axes, float]]:
    """Return path, axes and threshold of the fields of the model that are not held."""
    equations = bifurcation.line.right_hand_side
    return [
        (e.path, tuple(e.element.axes), float(getattr(e.element.sigmoid, "threshold", 0.0)))
        for e in equations.doc.entries
        if isinstance(e.element, Field) and e.id not in equations.held
    ]


def _count(bifurcation: Bifurcation, x: np.ndarray, path: str, axes: Axes, threshold: float) -> int:
    activation = bifurcation.line.right_hand_side.state(x)[f"{path}.activation"]
    return len(peaks(activation, axes, threshold))
