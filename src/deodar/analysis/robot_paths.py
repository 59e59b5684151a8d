"""Paths of a robot in the plane: length, entry into a disc, clearance, speed, and the shortest on a grid."""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from deodar.errors import AnalysisError
from deodar.parameters import show
from deodar.summary import Summarised, Summary


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


# ------------------------------------------------------------------------------------------ the shortest path


SLACK = 1e-6
"""Tolerance of the clearance, as a share of a cell, for rounding of walls that are given in metres."""


@dataclass(frozen=True, repr=False)
class Grid(Summarised):
    """Positions that the middle of a robot may have, on a square grid.

    Attributes:
        x, y: coordinates of the columns and rows.
        cell: distance between two columns or rows.
        free: whether each position keeps the clearance, (x, y).
    """

    x: np.ndarray
    y: np.ndarray
    cell: float
    free: np.ndarray

    def place(self, index: tuple[int, int]) -> tuple[float, float]:
        """Return the coordinates of a cell."""
        return float(self.x[index[0]]), float(self.y[index[1]])

    def nearest(self, place: Sequence[float] | np.ndarray) -> tuple[int, int]:
        """Return the free cell nearest to a position."""
        if not self.free.any():
            raise AnalysisError(
                "there is no free cell on the grid", fix="Use less clearance, or a finer grid"
            )
        far = (self.x[:, None] - place[0]) ** 2 + (self.y[None, :] - place[1]) ** 2
        i, j = np.unravel_index(int(np.argmin(np.where(self.free, far, np.inf))), self.free.shape)
        return int(i), int(j)

    def regions(self) -> np.ndarray:
        """The connected region of each cell, as a number; 0 for cells that are not free."""
        # start-up time: scipy.ndimage is only needed here
        from scipy.ndimage import label

        labelled: Any = label(self.free, np.ones((3, 3)))
        return np.asarray(labelled[0])

    def _summary(self) -> Summary:
        n, m = self.free.shape
        return Summary(f"Grid of {n} x {m} positions, {self.free.mean():.0%} free")


def arena_grid(boxes: npt.ArrayLike, border: Sequence[float], cell: float = 1.0, least: float = 4.0) -> Grid:
    """Create the grid of an arena; cells are free that keep a distance from all boxes and the border.

    Args:
        boxes: rows of lower x, lower y, upper x, upper y.
        border: the same four numbers of the arena.
        cell: distance between cells; the first cell is at the lower left corner.
        least: smallest distance from boxes and border, in the same unit.
    """
    left, low, right, high = border
    if not (cell > 0 and least >= 0 and right - left > cell and high - low > cell):
        raise AnalysisError(
            f"cells of {cell:g} with a clearance of {least:g} do not fit into an arena of {right - left:g} x"
            f" {high - low:g}"
        )
    x = left + cell * np.arange(math.floor((right - left) / cell + 1e-9) + 1)
    y = low + cell * np.arange(math.floor((high - low) / cell + 1e-9) + 1)
    places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    return Grid(x, y, cell, clearance(places, boxes, border) >= least - SLACK * cell)


def shortest_path(
    on: Grid, start: Sequence[float] | np.ndarray, goal: Sequence[float] | np.ndarray
) -> np.ndarray | None:
    """Find the shortest path (points, 2) from the free cell nearest the start to that nearest the goal.

    Each cell has eight neighbours. The heuristic of A* is the distance on an empty grid: ``cell * (max(dx,
    dy) + (sqrt(2) - 1) * min(dx, dy))``. The choice among several shortest paths is deterministic. None if
    the grid has no path.

    Reference:
        Hart, Nilsson & Raphael (1968), IEEE Trans. Syst. Sci. Cybern. 4(2), 100-107; as used by Billing, Lowe
        & Sandamirskaya (2015), Adapt. Behav. 23(5), section 5.1 and appendix B.
    """
    first, last = on.nearest(start), on.nearest(goal)
    # a frame of cells that are not free, so that neighbours need no bounds check
    width = on.free.shape[1] + 2
    free = np.pad(on.free, 1).ravel().tolist()
    begin, end = ((i + 1) * width + j + 1 for i, j in (first, last))
    aim_i, aim_j, diagonal = last[0] + 1, last[1] + 1, math.sqrt(2.0)
    moves = [
        (di * width + dj, diagonal if di and dj else 1.0)
        for di in (-1, 0, 1)
        for dj in (-1, 0, 1)
        if di or dj
    ]
    cost = [math.inf] * len(free)
    before = [-1] * len(free)
    closed = [False] * len(free)
    cost[begin] = 0.0
    waiting = [(0.0, begin)]
    while waiting:
        _, at = heapq.heappop(waiting)
        if at == end:
            break
        if closed[at]:
            continue
        closed[at] = True
        cost_here = cost[at]
        for move, weight in moves:
            to = at + move
            if free[to] and not closed[to] and cost_here + weight < cost[to]:
                cost[to] = cost_here + weight
                before[to] = at
                di, dj = abs(to // width - aim_i), abs(to % width - aim_j)
                ahead = di + (diagonal - 1) * dj if di > dj else dj + (diagonal - 1) * di
                heapq.heappush(waiting, (cost_here + weight + ahead, to))
    if not math.isfinite(cost[end]):
        return None
    line = [end]
    while line[-1] != begin:
        line.append(before[line[-1]])
    return np.asarray([on.place((k // width - 1, k % width - 1)) for k in reversed(line)])
