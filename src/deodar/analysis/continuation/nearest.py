"""The point of a line in a plane that is nearest to another point, where the larger coordinate counts."""

from __future__ import annotations

import numpy as np


def nearest(line: np.ndarray, at: np.ndarray) -> tuple[float, np.ndarray]:
    """Return the distance of a point to a line of straight pieces, and the nearest point of the line.

    The distance of two points is the larger of the absolute differences of both coordinates.

    Args:
        line: its points, one row each.
        at: the point.
    """
    begin = line[:-1] - at if len(line) > 1 else line - at
    chord = np.diff(line, axis=0) if len(line) > 1 else np.zeros((1, 2))
    # the larger coordinate is convex along a piece: its least is at an end, a zero, or where both are equal
    (a, b), (da, db) = begin.T, chord.T
    above = np.stack([np.zeros_like(a), -np.ones_like(a), -a, -b, b - a, -b - a])
    below = np.stack([np.ones_like(a), -np.ones_like(a), da, db, da - db, da + db])
    shares = np.divide(above, below, out=np.zeros_like(above), where=below != 0).clip(0, 1)
    places = begin + shares[..., None] * chord
    distances = np.abs(places).max(-1)
    best = np.unravel_index(int(distances.argmin()), distances.shape)
    return float(distances[best]), places[best] + at
