"""Where a vehicle fits in an arena, and where starts, goals and objects may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from deodar.errors import Problem, WorldError
from deodar.worlds._settings import finite_rows
from deodar.worlds.arena.arena_layout import ArenaLayout, ArenaObject

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
        longest = max(right - left, high - low) / self.cell
        if not (math.isfinite(self.cell) and longest <= MOST_CELLS):
            raise WorldError(f"an arena of {right - left:g} x {high - low:g} is too long for its width")
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


FAR = 2.0
"""Largest distance of an object from the border, in lengths of its longer side."""


def rows_of(label: str, numbers: npt.ArrayLike, scale: Sequence[float]) -> np.ndarray:
    """Convert a value to rows with one finite number per scale, multiplied by the scales."""
    return finite_rows(label, numbers, len(scale)) * np.asarray(scale)


class Places:
    """Checks of positions in an arena, and their form in messages.

    Attributes:
        border: lower x, lower y, upper x, upper y, m.
        unit, scale: unit of lengths in messages, and its size in metres.
        source: name or file of the arena.
    """

    def __init__(
        self, border: tuple[float, float, float, float], unit: str, scale: float, source: str
    ) -> None:
        self.border, self.unit, self.scale, self.source = border, unit, scale, source

    def misplaced(
        self, rows: np.ndarray, label: str, radius: float, objects: Sequence[Sequence[ArenaObject]]
    ) -> list[Problem]:
        """Return problems of positions that are outside the arena or too near to an object for the radius.

        Args:
            rows: one position for all trials, or one for each; m.
            label: what is there, in messages.
            radius: free distance around it, m.
            objects: the objects of all trials, or of each.
        """
        problems: list[Problem] = []
        left, low, right, high = self.border
        needs = f"; the vehicle needs {radius / self.scale:g} {self.unit} around it" if radius else ""
        count = max(len(rows), len(objects))
        for k in range(count):
            x, y = float(rows[k % len(rows), 0]), float(rows[k % len(rows), 1])
            if min(x - left, right - x, y - low, high - y) < radius:
                span = ", ".join(
                    f"{a / self.scale:g} to {b / self.scale:g}" for a, b in ((left, right), (low, high))
                )
                text = f"lies outside the arena, {span} {self.unit}{needs}"
                problems.append(self.fault(label, rows, k, text, count))
                continue
            present = objects[k % len(objects)]
            inside = [t.name for t in present if _distance(t.box, x, y) < max(radius, 1e-12)]
            if inside:
                problems.append(self.fault(label, rows, k, f"lies inside {inside[0]!r}{needs}", count))
        return problems

    def require_near(self, name: str, centers: Sequence[Sequence[float]]) -> None:
        """Raise WorldError if a middle of an object (m) lies so far outside that its unit must be wrong.

        An object that waits outside the border for its time is not that far away.
        """
        left, low, right, high = self.border
        for x, y in centers:
            apart = math.hypot(max(left - x, x - right, 0.0), max(low - y, y - high, 0.0))
            if apart > FAR * max(right - left, high - low):
                spans = ((left, right), (low, high))
                span = ", ".join(f"{a / self.scale:g} to {b / self.scale:g}" for a, b in spans)
                raise WorldError(
                    f"{self.shown(np.asarray([x, y]))} lies {apart / self.scale:.4g} {self.unit} outside the"
                    f" arena, {span} {self.unit}",
                    where=name,
                    fix=f"Give lengths in {self.unit}, or choose the unit: dd.Arena(..., unit='cm')",
                )

    def fault(self, label: str, rows: np.ndarray, k: int, text: str, count: int) -> Problem:
        """Return a problem of the position of trial `k` of `count`."""
        place = label if count == 1 else f"{label} of trial {k}"
        return Problem(
            f"{self.source}: {place}" if self.source else place, f"{self.shown(rows[k % len(rows)])} {text}"
        )

    def shown(self, row: np.ndarray) -> str:
        """Format a position for a message."""
        return f"({row[0] / self.scale:.4g}, {row[1] / self.scale:.4g})"


def _distance(box: tuple[float, float, float, float], x: float, y: float) -> float:
    return math.hypot(max(box[0] - x, x - box[2], 0.0), max(box[1] - y, y - box[3], 0.0))
