"""A running trial, as actions access it."""

from __future__ import annotations

import dataclasses as dc
import heapq
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from deodar.session.session import Session
from deodar.session.snapshot import SessionSnapshot

Kept = tuple[float, Mapping[str, np.ndarray]]
"""Document time, and the value of each port at that time."""


class RunningTrial:
    """A running trial, and its scheduled actions.

    Attributes:
        session: the model in its world.
        pushes: for each push that waits for an event, the path of its boost in the model.
        recording: whether values are recorded now.
        snapshots: the recorded snapshots, by name.
        outcome: the outcome with which an action ended the trial; empty while it runs.
    """

    def __init__(self, session: Session, pushes: Mapping[Any, str], restarts: bool) -> None:
        self.session = session
        self.pushes = pushes
        self.recording = True
        self.snapshots: dict[str, Kept] = {}
        self.outcome = ""
        self._start: SessionSnapshot | None = session.snapshot() if restarts else None
        self._due: list[tuple[int, int, Callable[[], object]]] = []
        self._count = 0

    def later(self, steps: int, what: Callable[[], object]) -> None:
        """Call `what` in `steps` steps from now; 0: before the next step."""
        self._count += 1  # calls at one time run in the order in which they were scheduled
        heapq.heappush(self._due, (self.session.tick + steps, self._count, what))

    def do(self) -> None:
        """Run all calls that are due, until the trial has ended."""
        while self._due and self._due[0][0] <= self.session.tick and not self.outcome:
            heapq.heappop(self._due)[2]()

    def until(self) -> int | None:
        """Return the number of steps until the next call; None without one."""
        return self._due[0][0] - self.session.tick if self._due else None

    def restart(self) -> None:
        """Reset the states of all elements to their values at the start; everything else continues."""
        assert self._start is not None
        now = self.session.snapshot()
        self.session.restore(dc.replace(now, states=self._start.states))
