"""A running trial, as actions access it."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, Protocol

import numpy as np

from deodar.experiments.trial_copies import TrialCopies
from deodar.model import find
from deodar.session.run import whole
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of

Kept = tuple[float, Mapping[str, np.ndarray]]
"""Document time, and the value of each port at that time."""


class ScheduledAction(Protocol):
    """What a schedule requires of an action.

    Class attributes:
        world_method: name of the world's method that it calls; empty: none.
    """

    world_method: ClassVar[str]

    @property
    def when(self) -> str:
        """The event after which it is done; empty: at a time of its own."""
        ...

    def time(self, trial: int) -> float:
        """Return the document time for a trial; with `when` the time after that event."""
        ...

    def apply(self, running: Any) -> None:
        """Carry out the action now."""
        ...


class RunningTrial:
    """A running trial, and its scheduled actions.

    Attributes:
        row: index of the trial among those of the call.
        dt: Euler step.
        pushes: for each push whose time is not the same in all trials, the path of its boost in the model.
        recording: whether values are recorded now.
        snapshots: the recorded snapshots, by name.
        outcome: the outcome with which an action ended the trial; empty while it runs.
    """

    def __init__(
        self, copies: TrialCopies, row: int, actions: Sequence[ScheduledAction], pushes: Mapping[Any, str]
    ) -> None:
        self._copies, self.row, self.dt, self.pushes = copies, row, copies.dt, pushes
        self.recording = True
        self.snapshots: dict[str, Kept] = {}
        self.outcome = ""
        self._begun = start = copies.run.clock.time
        self._due: list[tuple[int, int, Callable[[], object]]] = []
        self._waiting: list[tuple[int, ScheduledAction]] = []
        self._count = 0
        for action in actions:
            at = action.time(copies.trials[row])
            moment = whole(at if action.when else at - start, self.dt, "the time of an action")
            if action.when:
                self._waiting.append((moment, action))
            else:
                self._call(moment, lambda action=action: self._apply(action))

    # ------------------------------------------------------------------------------------ what actions access

    @property
    def tick(self) -> int:
        """Number of steps so far."""
        return self._copies.run.clock.tick

    @property
    def time(self) -> float:
        """Document time."""
        return self._copies.run.clock.time

    @property
    def world(self) -> World | None:
        """The world that actions change."""
        return self._copies.world_of(self.row)

    def get(self, path: str) -> Any:
        """Return the present value of a parameter."""
        return find.value(self._copies.document(self.row), path)

    def set(self, path: str, value: Any) -> None:
        """Change a parameter from the next step on."""
        self._copies.set(self.row, path, value)

    def read(self, path: str) -> np.ndarray:
        """Return the present value of a port."""
        return self._copies.read(self.row, path)

    def restart(self, keep_learned: bool) -> None:
        """Reset the states of all elements, those that were learned only if `keep_learned` is false, to their
        values at the start; everything else continues.
        """
        self._copies.restart(self.row, keep_learned)

    def later(self, steps: int, what: Callable[[], object]) -> None:
        """Call `what` in `steps` steps from now; 0: before the next step."""
        self._call(self.tick + steps, what)

    # ------------------------------------------------------------------------------------------- the schedule

    @property
    def due(self) -> int | None:
        """The tick of the next call; None without one."""
        return self._due[0][0] if self._due else None

    @property
    def delay(self) -> int | None:
        """The smallest delay, in steps, of an action that waits for an event; None without one."""
        return min((moment for moment, _ in self._waiting), default=None)

    def notice(self, happened: Mapping[str, float | None]) -> None:
        """Schedule the actions whose events have occurred, at the given document times."""
        waiting: list[tuple[int, ScheduledAction]] = []
        for moment, action in self._waiting:
            time = happened[action.when]
            if time is None:
                waiting.append((moment, action))
            else:
                tick = round((time - self._begun) / self.dt)
                self._call(tick + moment, lambda action=action: self._apply(action))
        self._waiting = waiting

    def do(self) -> None:
        """Run all calls that are due, until the trial has ended."""
        while self._due and self._due[0][0] <= self.tick and not self.outcome:
            heapq.heappop(self._due)[2]()

    def _call(self, tick: int, action: Callable[[], object]) -> None:
        self._count += 1  # calls at one time run in the order in which they were scheduled
        heapq.heappush(self._due, (tick, self._count, action))

    def _apply(self, action: ScheduledAction) -> None:
        world = self.world if action.world_method else None
        if world is None:
            action.apply(self)
            return
        with errors_of(world, action.world_method):
            action.apply(self)
        self._copies.use_world(self.row)
