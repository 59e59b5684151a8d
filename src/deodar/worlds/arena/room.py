"""Where a disc has room in a layout, and from where it gets where."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.worlds.arena.layout import ArenaLayout

FINE = 8
"""Cells of the grid in one radius of the disc."""

MOST_CELLS = 4_000_000


class Room:
    """The places of a layout where the middle of a disc may be, on a grid.

    The grid errs towards room: a gap that is a cell too narrow passes for one, so that what is called out of
    reach certainly is.
    """

    def __init__(self, layout: ArenaLayout, radius: float, boxes: np.ndarray) -> None:
        left, low, right, high = layout.border
        self.border, self.boxes, self.radius = layout.border, np.asarray(boxes, float).reshape(-1, 4), radius
        self.cell = max(radius / FINE, float(np.sqrt((right - left) * (high - low) / MOST_CELLS)))
        self.x = np.arange(left + self.cell / 2, right, self.cell)
        self.y = np.arange(low + self.cell / 2, high, self.cell)
        self.gap = self.gaps(*np.meshgrid(self.x, self.y, indexing="ij"))
        self._labels: np.ndarray | None = None

    def gaps(self, x: Any, y: Any) -> np.ndarray:
        """For places the gap between a disc there and the nearest thing or the border; negative where it does
        not fit.
        """
        left, low, right, high = self.border
        gap = np.minimum(np.minimum(x - left, right - x), np.minimum(y - low, high - y))
        for x0, y0, x1, y1 in self.boxes:
            dx, dy = np.maximum(np.maximum(x0 - x, x - x1), 0), np.maximum(np.maximum(y0 - y, y - y1), 0)
            gap = np.minimum(gap, np.sqrt(dx * dx + dy * dy))
        return np.asarray(gap - self.radius)

    def near_middle(self) -> tuple[float, float] | None:
        """The place nearest the middle of the arena where the disc stands free by half its radius (else: free
        at all); None: nowhere.
        """
        x, y = np.meshgrid(self.x, self.y, indexing="ij")
        left, low, right, high = self.border
        far = (x - (left + right) / 2) ** 2 + (y - (low + high) / 2) ** 2
        for wanted in (self.radius / 2, 0.0):
            if (self.gap > wanted).any():
                k = np.argmin(np.where(self.gap > wanted, far, np.inf))
                return float(x.flat[k]), float(y.flat[k])
        return None

    def joined(self, start: Sequence[float], goal: Sequence[float]) -> bool:
        """Whether the middle of the disc gets from one place to within its radius of another."""
        if self._labels is None:
            # start-up time
            from scipy.ndimage import label

            found: Any = label(self.gap > -self.cell, np.ones((3, 3)))
            self._labels = np.asarray(found[0])
        here = self._around(start, self.cell)
        there = self._around(goal, self.radius + self.cell)
        return bool((set(here) & set(there)) - {0})

    def _around(self, place: Sequence[float], reach: float) -> list[int]:
        assert self._labels is not None
        i = np.flatnonzero(np.abs(self.x - place[0]) <= reach)
        j = np.flatnonzero(np.abs(self.y - place[1]) <= reach)
        return np.unique(self._labels[np.ix_(i, j)]).tolist()
