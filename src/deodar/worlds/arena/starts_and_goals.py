"""Starts and goals: one row for all trials or one for each trial, and the checks of their positions."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from deodar.errors import Problem, WorldError
from deodar.worlds._settings import finite_rows
from deodar.worlds.arena.arena_layout import ArenaObject

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
