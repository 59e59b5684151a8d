"""A running trial, as actions access it."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, Protocol

import numpy as np

from deodar.session.keep import with_learned
from deodar.session.run import whole
from deodar.session.session import Session
from deodar.session.session_snapshot import SessionSnapshot
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
    """A running trial, and its scheduled actions; its subclasses are a session, and a copy in a batch.

    Attributes:
        dt: Euler step.
        pushes: for each push whose time is not the same in all trials, the path of its boost in the model.
        recording: whether values are recorded now.
        snapshots: the recorded snapshots, by name.
        outcome: the outcome with which an action ended the trial; empty while it runs.
    """

    def __init__(
        self,
        trial: int,
        actions: Sequence[ScheduledAction],
        start: float,
        dt: float,
        pushes: Mapping[Any, str],
    ) -> None:
        self.dt = dt
        self.pushes = pushes
        self.recording = True
        self.snapshots: dict[str, Kept] = {}
        self.outcome = ""
        self._begun = start
        self._due: list[tuple[int, int, Callable[[], object]]] = []
        self._waiting: list[tuple[int, ScheduledAction]] = []
        self._count = 0
        for action in actions:
            at = action.time(trial)
            moment = whole(at if action.when else at - start, dt, "the time of an action")
            if action.when:
                self._waiting.append((moment, action))
            else:
                self._call(moment, lambda action=action: self._apply(action))

    # ------------------------------------------------------------------------------------ what actions access

    @property
    def tick(self) -> int:
        """Number of steps so far."""
        raise NotImplementedError

    @property
    def time(self) -> float:
        """Document time."""
        raise NotImplementedError

    @property
    def world(self) -> World | None:
        """The world that actions change."""
        raise NotImplementedError

    def get(self, path: str) -> Any:
        """Return the present value of a parameter."""
        raise NotImplementedError

    def set(self, path: str, value: Any) -> None:
        """Change a parameter from the next step on."""
        raise NotImplementedError

    def read(self, path: str) -> np.ndarray:
        """Return the present value of a port."""
        raise NotImplementedError

    def restart(self, keep_learned: bool) -> None:
        """Reset the states of all elements, those that were learned only if `keep_learned` is false, to their
        values at the start; everything else continues.
        """
        raise NotImplementedError

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

    def _call(self, tick: int, what: Callable[[], object]) -> None:
        self._count += 1  # calls at one time run in the order in which they were scheduled
        heapq.heappush(self._due, (tick, self._count, what))

    def _apply(self, action: ScheduledAction) -> None:
        world = self.world if action.world_method else None
        if world is None:
            action.apply(self)
            return
        with errors_of(world, action.world_method):
            action.apply(self)
        self._world_changed()

    def _world_changed(self) -> None:
        """Use the changed objects of the world from now on."""


class SessionTrial(RunningTrial):
    """A trial that a session runs.

    Attributes:
        session: the model in its world.
    """

    def __init__(
        self,
        session: Session,
        trial: int,
        actions: Sequence[ScheduledAction],
        pushes: Mapping[Any, str],
        restarts: bool,
    ) -> None:
        self.session = session
        super().__init__(trial, actions, session.time, session.dt, pushes)
        self._start: SessionSnapshot | None = session.snapshot() if restarts else None

    @property
    def tick(self) -> int:
        return self.session.tick

    @property
    def time(self) -> float:
        return self.session.time

    @property
    def world(self) -> World | None:
        return self.session.world

    def get(self, path: str) -> Any:
        return self.session.get(path)

    def set(self, path: str, value: Any) -> None:
        self.session.set(path, value)

    def read(self, path: str) -> np.ndarray:
        return self.session.read(path).copy()

    def restart(self, keep_learned: bool) -> None:
        assert self._start is not None
        states = self._start.states
        self.session.put_states(with_learned(self.session.snapshot(), states) if keep_learned else states)
