"""Blocks of an arena that are probably misplaced: two at one place, one outside, one on the start."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from deodar.errors import Problem
from deodar.worlds.arena.objects import ArenaObjects, ArenaSlot
from deodar.worlds.arena.starts_and_goals import Places

LEAST = 1e-5
"""Smallest overlap that is stated, in lengths of the longer side of the arena."""


class BlockCheck:
    """The blocks of an arena in all trials, and the warnings about their places.

    Walls and boxes of a layout are no blocks: they may overlap.
    """

    def __init__(self, objects: ArenaObjects, places: Places) -> None:
        self.slots = [s for s in objects.slots if s is not None and s.name not in objects.fixed]
        self.places = places
        self.trials = max((max(len(s.rows), len(s.windows)) for s in self.slots), default=1)
        left, low, right, high = places.border
        self.least = LEAST * max(right - left, high - low)
        self.corners = {s.name: self._corners(s) for s in self.slots}
        self.windows = {s.name: self._windows(s) for s in self.slots}

    def warnings(self, starts: np.ndarray, vehicle: str, radius: float) -> Iterator[Problem]:
        """Yield a warning for each pair of blocks that overlap at one time, each block that lies outside the
        arena, and each block that covers the start of the vehicle; of several trials the first is named.

        Args:
            starts: x, y and heading of the vehicle, m and rad, for all trials or for each.
            vehicle: name of the vehicle.
            radius: its radius, m.
        """
        corners, windows, inside = self.corners, self.windows, np.asarray(self.places.border)
        for s in self.slots:
            lower, upper = _common(corners[s.name], inside[None])
            exists = windows[s.name][:, 0] < windows[s.name][:, 1]
            outside = exists & (upper - lower < self.least).any(axis=1)
            if outside.any():
                fault = f"the block {s.name!r} lies outside the arena{self._of(outside)}: no camera sees it"
                yield Problem("arena", fault, "Move it inside", "warning")
        for s in self.slots:
            x_y = np.resize(starts[:, :2], (max(self.trials, len(starts)), 2))
            box, window = (np.resize(a[s.name], (len(x_y), a[s.name].shape[1])) for a in (corners, windows))
            offset = np.maximum(np.maximum(box[:, :2] - x_y, x_y - box[:, 2:]), 0.0)
            covers = (window[:, 0] <= 0) & (window[:, 1] > 0) & (np.hypot(*offset.T) < radius - self.least)
            if covers.any():
                fault = f"the block {s.name!r} covers the start of the {vehicle}{self._of(covers)}"
                yield Problem("arena", f"{fault}, which is pushed aside", "Move one of them", "warning")
        yield from self.overlaps()

    def overlaps(self, block: str | None = None) -> Iterator[Problem]:
        """Yield a warning for each pair of blocks that overlap at one time; with `block` for its pairs."""
        corners, windows, inside = self.corners, self.windows, np.asarray(self.places.border)
        for first, second in itertools.combinations([s.name for s in self.slots], 2):
            if block not in (None, first, second):
                continue
            lower, upper = _common(corners[first], corners[second])
            start = np.maximum(windows[first][:, 0], windows[second][:, 0])
            together = start < np.minimum(windows[first][:, 1], windows[second][:, 1])
            seen, to = _common(np.concatenate([lower, upper], axis=1), inside[None])
            overlap = together & (to - seen > self.least).all(axis=1)
            if overlap.any():
                k = int(np.argmax(overlap))
                w, h = (upper - lower)[k] / self.places.scale
                fault = f"the blocks {first!r} and {second!r} overlap by {w:.4g} x {h:.4g} {self.places.unit}"
                fix = f"Move one of them, or give them different times: arena.place({second!r}, windows=...)"
                yield Problem("arena", fault + self._of(overlap), fix, "warning")

    def _of(self, trials: np.ndarray) -> str:
        return f" in trial {int(np.argmax(trials))}" if len(trials) > 1 else ""

    def _corners(self, slot: ArenaSlot) -> np.ndarray:
        """Return lower x, lower y, upper x, upper y in each trial, m; NaN where there is no such block."""
        items = [slot.item(k) for k in range(self.trials)]
        return np.asarray([[np.nan] * 4 if block is None else block.box for block in items])

    def _windows(self, slot: ArenaSlot) -> np.ndarray:
        return np.asarray([slot.window(k) for k in range(self.trials)])


def _common(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lower and the upper corner of what boxes (n, 4) have in common."""
    return np.maximum(first[:, :2], second[:, :2]), np.minimum(first[:, 2:], second[:, 2:])
