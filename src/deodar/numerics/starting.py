"""Values that a new element starts with in an editor, scaled to its axes."""

from __future__ import annotations

import math

import numpy as np

from deodar.numerics.axes import Axes, cell, shape
from deodar.parameters import PerAxis

STRENGTH = 6.0
"""Amplitude of a new input: it lifts a field of the usual resting level (-5) just above its threshold (0)."""

SHARE = 20
"""The width sigma of new kernels and inputs is the range of the axis divided by this number (a guess: at 101
samples it is five of them, and about five peaks find room).
"""

MOST_WEIGHTS = 1_000_000
"""Largest number of weights that are made for a new element."""


def middle(axes: Axes) -> PerAxis:
    """Return the middle of each axis."""
    return one_or_each(tuple((a.lower + a.upper) / 2 for a in axes))


def widths(axes: Axes) -> tuple[float, ...]:
    """Return the width sigma of a new kernel or input along each axis."""
    return tuple(a.range / SHARE for a in axes)


def one_or_each(values: tuple[float, ...]) -> PerAxis:
    """Return one value for all axes if they agree, else one for each."""
    return values[0] if values and len(set(values)) == 1 else values


def bump(axes: Axes, width: str, sigmas: float = 1) -> dict[str, PerAxis]:
    """Return the values of a new input around one position; its amplitude alone without axes.

    Args:
        axes: the axes of the input.
        width: name of the parameter of its width.
        sigmas: the width in sigma, as in `widths`.
    """
    if not axes:
        return {"amplitude": STRENGTH}
    wide = one_or_each(tuple(sigmas * sigma for sigma in widths(axes)))
    return {"center": middle(axes), width: wide, "amplitude": STRENGTH}


def hill(axes: Axes, at: float = 0.5) -> np.ndarray:
    """Return a Gaussian of height 1 over the axes, centred at a share of each range."""
    out = np.ones(shape(axes))
    for d, axis in enumerate(axes):
        distance = axis.points - (axis.lower + at * axis.range)
        sides = [1] * len(axes)
        sides[d] = axis.samples
        out = out * np.exp(-0.5 * (distance / (axis.range / SHARE)) ** 2).reshape(sides)
    return out


def map_of_places(axes: Axes, arriving: Axes) -> np.ndarray | None:
    """Return weights, target samples first, that copy every sample of the source to the nearest one in order.

    The integral over the source keeps its values. None for more than `MOST_WEIGHTS` weights.
    """
    rows, columns = math.prod(shape(axes)), math.prod(shape(arriving))
    if rows * columns > MOST_WEIGHTS:
        return None
    out = np.zeros((rows, columns))
    nearest = np.round(np.arange(rows) * max(0, columns - 1) / max(1, rows - 1)).astype(int)
    out[np.arange(rows), nearest] = 1.0 / cell(arriving)
    return out.reshape(shape(axes) + shape(arriving))
