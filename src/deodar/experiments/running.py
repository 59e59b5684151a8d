"""A running trial, as actions see it."""

from __future__ import annotations

import dataclasses as dc
import heapq
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from deodar.session.session import Session
from deodar.session.snapshot import SessionSnapshot

Kept = tuple[float, Mapping[str, np.ndarray]]
"""Document time, and for each port what it then held."""


class RunningTrial:
    """A trial that runs, and what is still to be done to it.

    Attributes:
        session: the model in its world.
        pushes: for each action that pushes when something has happened the path of the boost that stands in
            the model for it.
        recording: whether what is recorded is kept now.
        snapshots: what was kept, by name.
        outcome: what an action ended the trial with; empty while it runs.
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
        self._count += 1  # what falls on one moment is done in the order in which it was asked for
        heapq.heappush(self._due, (self.session.tick + steps, self._count, what))

    def do(self) -> None:
        """All that is due, until the trial has ended."""
        while self._due and self._due[0][0] <= self.session.tick and not self.outcome:
            heapq.heappop(self._due)[2]()

    def until(self) -> int | None:
        """Steps until something is due; None: nothing is."""
        return self._due[0][0] - self.session.tick if self._due else None

    def restart(self) -> None:
        """States of all elements as they were at the start; everything else goes on."""
        assert self._start is not None
        now = self.session.snapshot()
        self.session.restore(dc.replace(now, states=self._start.states))
