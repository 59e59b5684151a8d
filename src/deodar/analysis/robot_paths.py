"""Paths of a robot in the plane: length, entry into a disc, clearance, speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from deodar.errors import AnalysisError
from deodar.parameters import show


def points(path: ArrayLike) -> np.ndarray:
    """Return a path as an array (points, 2); other columns (such as a heading) are dropped."""
    array = np.asarray(path, float)
    if array.ndim != 2 or array.shape[1] < 2 or not len(array) or not np.isfinite(array[:, :2]).all():
        raise AnalysisError(f"a path is rows of x and y, all of them finite, not {show(path)}")
    return array[:, :2]


def path_length(path: ArrayLike) -> float:
    """Return the sum of the distances between consecutive points, in the unit of the path."""
    return float(np.linalg.norm(np.diff(points(path), axis=0), axis=1).sum())


def path_until(path: ArrayLike, goal: Sequence[float] | np.ndarray, radius: float) -> np.ndarray | None:
    """Return the path until it first enters a disc around a goal; the last point is on the disc's edge.

    None if the path never enters the disc.

    Args:
        path: rows of x and y.
        goal: x and y of the middle of the disc.
        radius: radius of the disc, above 0.
    """
    line = points(path)
    offsets = line - np.asarray(goal, float)[:2]
    inside = np.flatnonzero(np.linalg.norm(offsets, axis=1) <= radius)
    if not len(inside):
        return None
    k = int(inside[0])
    if k == 0:
        return line[:1]
    # the last segment crosses the circle at |a + s (b - a)|^2 = radius^2: take the smaller root
    a, step = offsets[k - 1], offsets[k] - offsets[k - 1]
    square, across = float(step @ step), float(a @ step)
    share = (-across - np.sqrt(max(across**2 - square * (float(a @ a) - radius**2), 0.0))) / square
    return np.concatenate([line[:k], [line[k - 1] + np.clip(share, 0.0, 1.0) * (line[k] - line[k - 1])]])


def path_divergence(
    path: ArrayLike, shortest: ArrayLike, goal: Sequence[float] | np.ndarray, radius: float
) -> float | None:
    """Return Lp / Lo: the length of a path divided by that of the shortest path.

    Both end where they enter the disc around the goal. None if the path never enters the disc, or if the
    shortest path begins inside it.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), section 5.1.
    """
    gone, least = path_until(path, goal, radius), path_until(shortest, goal, radius)
    if gone is None or least is None or path_length(least) == 0:
        return None
    return path_length(gone) / path_length(least)


def clearance(places: ArrayLike, boxes: ArrayLike, border: Sequence[float]) -> np.ndarray:
    """Return the distance of each position to the nearest box or to the border; 0 inside a box or outside the
    border.

    Args:
        places: positions, (..., 2).
        boxes: rows of lower x, lower y, upper x, upper y.
        border: the same four numbers of the enclosing rectangle.
    """
    at = np.asarray(places, float)
    x, y = at[..., 0], at[..., 1]
    left, low, right, high = border
    nearest = np.minimum(np.minimum(x - left, right - x), np.minimum(y - low, high - y))
    for x0, y0, x1, y1 in np.asarray(boxes, float).reshape(-1, 4):
        nearest = np.minimum(
            nearest,
            np.hypot(np.maximum(np.maximum(x0 - x, x - x1), 0), np.maximum(np.maximum(y0 - y, y - y1), 0)),
        )
    return np.maximum(nearest, 0.0)


def speeds(path: ArrayLike, times: ArrayLike, over: int = 1) -> np.ndarray:
    """Return the speed at each point but the first `over`, in the unit of the path per unit of time.

    It is the distance from the point `over` points earlier, divided by the time between them.
    """
    line, at = points(path), np.asarray(times, float)
    return np.linalg.norm(line[over:] - line[:-over], axis=1) / (at[over:] - at[:-over])
