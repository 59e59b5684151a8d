"""The free space of a disc in a layout, and which places it can reach."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.worlds.arena.arena_layout import ArenaLayout

FINE = 8
"""Cells of the grid in one radius of the disc."""

MOST_CELLS = 4_000_000


class Room:
    """Grid of the positions of a layout where the middle of a disc may be.

    The grid overestimates the free space: a gap that is one cell too narrow counts as free, so a goal
    reported as out of reach certainly is.
    """

    def __init__(self, layout: ArenaLayout, radius: float, boxes: np.ndarray) -> None:
        left, low, right, high = layout.border
        self.border, self.boxes, self.radius = layout.border, np.asarray(boxes, float).reshape(-1, 4), radius
        self.cell = max(radius / FINE, float(np.sqrt((right - left) * (high - low) / MOST_CELLS)))
        self.x = np.arange(left + self.cell / 2, right, self.cell)
        self.y = np.arange(low + self.cell / 2, high, self.cell)
        self.gap = self.gaps(*np.meshgrid(self.x, self.y, indexing="ij"))
        self._labels: np.ndarray | None = None

    def gaps(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return the gap between a disc at each position and the nearest thing or the border.

        The gap is negative where the disc does not fit.
        """
        left, low, right, high = self.border
        gap = np.minimum(np.minimum(x - left, right - x), np.minimum(y - low, high - y))
        for x0, y0, x1, y1 in self.boxes:
            dx, dy = np.maximum(np.maximum(x0 - x, x - x1), 0), np.maximum(np.maximum(y0 - y, y - y1), 0)
            gap = np.minimum(gap, np.sqrt(dx * dx + dy * dy))
        return np.asarray(gap - self.radius)

    def near_middle(self) -> tuple[float, float] | None:
        """Return the position nearest the middle of the arena where the disc has a gap of half its radius.

        If no position has such a gap, return the nearest one with any gap; None if the disc fits nowhere.
        """
        x, y = np.meshgrid(self.x, self.y, indexing="ij")
        left, low, right, high = self.border
        far = (x - (left + right) / 2) ** 2 + (y - (low + high) / 2) ** 2
        for needed in (self.radius / 2, 0.0):
            if (self.gap > needed).any():
                k = np.argmin(np.where(self.gap > needed, far, np.inf))
                return float(x.flat[k]), float(y.flat[k])
        return None

    def joined(self, start: Sequence[float], goal: Sequence[float]) -> bool:
        """Return whether the middle of the disc can move from `start` to within its radius of `goal`."""
        if self._labels is None:
            # start-up time
            from scipy.ndimage import label

            labelled: Any = label(self.gap > -self.cell, np.ones((3, 3)))
            self._labels = np.asarray(labelled[0])
        start_labels = self._around(start, self.cell)
        goal_labels = self._around(goal, self.radius + self.cell)
        return bool((set(start_labels) & set(goal_labels)) - {0})

    def _around(self, place: Sequence[float], reach: float) -> list[int]:
        assert self._labels is not None
        i = np.flatnonzero(np.abs(self.x - place[0]) <= reach)
        j = np.flatnonzero(np.abs(self.y - place[1]) <= reach)
        return np.unique(self._labels[np.ix_(i, j)]).tolist()
