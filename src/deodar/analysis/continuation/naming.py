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


def named(found: Bifurcation, points: Sequence[WalkPoint]) -> Bifurcation:
    """Return a bifurcation with its name, where a stable state loses its stability in it.

    From the bifurcation the model runs at a value just beyond it: if peaks appear, it is a detection; if a
    peak vanishes that has localised input, a reverse detection, and without such input forgetting. If it
    loses its stability at a branch point and fewer peaks are left, it is a selection.

    Args:
        found: the bifurcation.
        points: the points of its branch.
    """
    if found.kind == "Hopf":
        return found
    line = found.line
    before, after = points[found.index], points[found.index + 1]
    mode = found.vector / np.abs(found.vector).max()
    if found.kind == "fold":
        # both points lie on the side where the states exist
        values = [line.value(before.z), line.value(after.z)]
        value = found.value + BEYOND * line.length * float(np.sign(found.value - np.mean(values)))
        parameters = line.all_parameters(line.point(found.state, value))
        states = [line.right_hand_side.settle(found.state, parameters, PASSAGE)]
    else:
        first = max(0, found.index + 1 - AHEAD)
        behind, ahead = points[first : found.index + 1], points[found.index + 1 : found.index + 1 + AHEAD]
        side = behind if float(before.rates.real.max()) > float(after.rates.real.max()) else ahead
        unstable = max(side, key=lambda point: float(point.rates.real.max()))
        parameters = line.all_parameters(unstable.z)
        longest = GROWTH / max(float(unstable.rates.real.max()) * line.slowest, 1e-3)
        x = line.state(unstable.z)
        states = [
            line.right_hand_side.settle(x + sign * MOVED * mode, parameters, longest + 50) for sign in (1, -1)
        ]
    for path, axes, threshold in _fields(found):
        counts = [_count(found, x, path, axes, threshold) for x in (found.state, *states)]
        here, beyond = counts[0], min(counts[1:])
        if beyond == here:
            continue
        if found.kind == "branch point":
            name = "selection" if 1 <= beyond < here else ""
        elif beyond > here:
            name = "detection"
        else:
            shape = line.right_hand_side.read(f"{path}.input", found.state, parameters)
            local = bool(axes) and np.ptp(shape) > 1e-6 * max(1.0, float(np.abs(shape).max()))
            name = "reverse detection" if local or not axes else "forgetting"
        if name:
            return dc.replace(found, instability=name, where=path)
    return found


def _fields(found: Bifurcation) -> list[tuple[str, Axes, float]]:
    """Return path, axes and threshold of the fields of the model that are not held."""
    own = found.line.right_hand_side
    return [
        (e.path, tuple(e.element.axes), float(getattr(e.element.sigmoid, "threshold", 0.0)))
        for e in own.doc.entries
        if isinstance(e.element, Field) and e.id not in own.held
    ]


def _count(found: Bifurcation, x: np.ndarray, path: str, axes: Axes, threshold: float) -> int:
    activation = found.line.right_hand_side.state(x)[f"{path}.activation"]
    return len(peaks(activation, axes, threshold))
