"""Gaussian stimuli over samples, as dnf-composer computes them."""

from __future__ import annotations

import numpy as np


def line(count: int, position: float, width: float, circular: bool) -> np.ndarray:
    """Return exp(-d^2 / (2 width^2)) at the samples 1, 2, ..., count; all arguments are in samples."""
    x = np.arange(1.0, count + 1)
    if circular:
        d = np.abs(x - (np.fmod(position - 1, count) + 1))
        d = np.minimum(d, count - d)
    else:
        d = x - position
    return np.exp(-0.5 * (d / width) ** 2)


def along(points: np.ndarray, extent: float | None, position: float, width: float) -> np.ndarray:
    """Return one factor of a plane, exp(-d^2 / (2 width^2)); all arguments are in units.

    A circular distance is at most half of the extent, which need not be a whole number of steps; None: the
    axis is not circular.
    """
    d = np.abs(points - position)
    return np.exp(-0.5 * ((d if extent is None else np.minimum(d, extent - d)) / width) ** 2)
