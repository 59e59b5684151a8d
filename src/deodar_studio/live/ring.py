"""The published states of the last minute of a run, in a bounded amount of memory."""

from __future__ import annotations

import bisect
import dataclasses as dc
import threading
from collections import Counter
from collections.abc import Mapping

import numpy as np

from deodar.session.port_reader import PortKey
from deodar_studio.live.published import PublishedState

SECONDS = 60.0
"""Wall time of running that the ring covers, in seconds."""

MOST_BYTES = 256 * 2**20
"""Largest sum of the sizes of the stored arrays, in bytes."""

PAUSE = 0.5
"""Longest wall time between two states that counts as running, in seconds; the rest was a pause."""


@dc.dataclass(frozen=True)
class TimeSpan:
    """The moments that can be shown.

    Attributes:
        first, last: document time of the first and of the last moment.
        frames: number of moments.
        full_from: from this time on no moment was removed to save memory.
    """

    first: float
    last: float
    frames: int
    full_from: float


@dc.dataclass
class _Stored:
    state: PublishedState
    wall: float
    thinned: bool = False


class StateRing:
    """Published states of the last minute of running.

    The engine adds states; other threads read them. Arrays are stored in single precision, and once where
    consecutive states share them. If the memory would exceed the limit, states are removed so that the time
    between two of them grows in proportion to their age.
    """

    def __init__(self, seconds: float = SECONDS, most: int = MOST_BYTES) -> None:
        self._seconds, self._most = seconds, most
        self._lock = threading.Lock()
        self._stored: list[_Stored] = []
        self._uses: Counter[int] = Counter()
        self._wall, self._added = 0.0, 0.0
        self.nbytes = 0

    def add(self, state: PublishedState, now: float) -> None:
        """Add a state at the wall time `now`; it replaces the last one if no step was taken between them."""
        with self._lock:
            last = self._stored[-1] if self._stored else None
            before = {} if last is None else last.state.arrays
            arrays = {place: _own(array, before.get(place)) for place, array in state.arrays.items()}
            stored = _Stored(self._sharing(state, arrays, last), self._wall)
            if last is not None and last.state.tick == state.tick:
                stored.thinned = last.thinned
                self._count(arrays, 1)
                self._remove(-1)
            else:
                self._wall += min(now - self._added, PAUSE) if last is not None else 0.0
                stored.wall = self._wall
                self._count(arrays, 1)
            self._added = now
            self._stored.append(stored)
            while self._stored[0].wall < self._wall - self._seconds:
                self._remove(0)
            while self.nbytes > self._most and self._stored:
                self._thin()

    def span(self) -> TimeSpan | None:
        """Return the moments that can be shown; None before the first."""
        with self._lock:
            if not self._stored:
                return None
            first = len(self._stored) - 1
            while first > 0 and not self._stored[first].thinned:
                first -= 1
            times = [self._stored[k].state.time for k in (0, -1, first)]
            return TimeSpan(times[0], times[1], len(self._stored), times[2])

    def at(self, time: float, further: int = 0) -> tuple[int, PublishedState] | None:
        """Return the last state up to a time, or that `further` states later, and its index.

        Outside the span it is the first or the last state; None if the ring is empty.
        """
        with self._lock:
            if not self._stored:
                return None
            k = bisect.bisect_right(self._stored, time, key=lambda one: one.state.time) - 1
            k = min(max(max(k, 0) + further, 0), len(self._stored) - 1)
            return k, self._stored[k].state

    def states(self) -> list[PublishedState]:
        """Return all stored states in order of time."""
        with self._lock:
            return [stored.state for stored in self._stored]

    def until(self, tick: int) -> StateRing:
        """Return a new ring with the states up to a tick."""
        ring = StateRing(self._seconds, self._most)
        with self._lock:
            for stored in self._stored:
                if stored.state.tick <= tick:
                    ring._stored.append(dc.replace(stored))
                    ring._count(stored.state.arrays, 1)
            ring._wall = ring._stored[-1].wall if ring._stored else 0.0
            ring._added = self._added
        return ring

    def _sharing(
        self, state: PublishedState, arrays: Mapping[PortKey, np.ndarray], last: _Stored | None
    ) -> PublishedState:
        scene, before = state.scene, None if last is None else last.state.scene
        if scene is not None and before is not None:
            boxes = before.boxes if before.boxes == scene.boxes else scene.boxes
            marks = before.marks if before.marks == scene.marks else scene.marks
            scene = dc.replace(scene, boxes=boxes, marks=marks)
        return dc.replace(state, arrays=arrays, scene=scene)

    def _count(self, arrays: Mapping[PortKey, np.ndarray], by: int) -> None:
        for array in arrays.values():
            before = self._uses[id(array)]
            self._uses[id(array)] = before + by
            if before == 0 or before + by == 0:
                self.nbytes += by * array.nbytes
            if before + by == 0:
                del self._uses[id(array)]

    def _remove(self, k: int) -> None:
        self._count(self._stored.pop(k).state.arrays, -1)

    def _thin(self) -> None:
        """Remove the state whose neighbours are closest to each other, in proportion to its age."""
        if len(self._stored) <= 2:
            self._remove(0)
            return
        walls = np.array([stored.wall for stored in self._stored])
        gaps, ages = walls[2:] - walls[:-2], walls[-1] - walls[1:-1]
        k = int(np.argmin(gaps / np.maximum(ages, 1e-9))) + 1
        self._stored[k + 1].thinned = True
        self._remove(k)


def _own(array: np.ndarray, before: np.ndarray | None) -> np.ndarray:
    """Return a copy in single precision, or the known array if that has the same values."""
    if before is not None and before.shape == array.shape:
        same = array.astype(np.float32) if array.dtype != np.float32 else array
        return before if np.array_equal(before, same) else np.array(same)
    return np.array(array, np.float32)
