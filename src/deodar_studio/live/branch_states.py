"""Whole states of a run at intervals, from which every moment in between is computed again."""

from __future__ import annotations

import dataclasses as dc
import time

import jax
import numpy as np

from deodar.errors import RecordError
from deodar.session.journal import Change, JournalReader, StepProgress, repeat_changes, until
from deodar.session.session import Session
from deodar.session.session_snapshot import SessionSnapshot
from deodar.worlds._base import World

SECONDS = 65.0
"""Wall time of running that the states cover, in seconds: a little more than the ring of shown states."""

INTERVAL = 1.0
"""Shortest wall time between two stored states, in seconds."""

SHARE = 0.02
"""Largest share of the wall time that storing may take."""

MOST_BYTES = 256 * 2**20
"""Largest sum of the sizes of the stored states, in bytes."""

PAUSE = 0.5
"""Longest wall time between two exchanges that counts as running, in seconds."""


@dc.dataclass
class _BranchState:
    """A state, its world, and the changes of the session since, up to the next state."""

    snapshot: SessionSnapshot
    world: World | None
    wall: float
    nbytes: int
    changes: list[Change] = dc.field(default_factory=list[Change])

    @property
    def tick(self) -> int:
        return self.snapshot.clock.tick


class BranchStates:
    """States of the last minute of a session, in a bounded amount of memory.

    A moment is computed again from the last state before it: the session takes the same steps, with the
    changes of its journal at their ticks. If the memory would exceed the limit, states are removed so that
    the time between two of them grows in proportion to their age.
    """

    def __init__(self, interval: float = INTERVAL, most: int = MOST_BYTES) -> None:
        self._interval, self._most = interval, most
        self._stored: list[_BranchState] = []
        self._reader = JournalReader()
        self._wall, self._followed_at, self._due = 0.0, 0.0, 0.0
        self._too_large = 0

    @property
    def nbytes(self) -> int:
        """Sum of the sizes of the stored states."""
        return sum(state.nbytes for state in self._stored)

    @property
    def ticks(self) -> list[int]:
        """Ticks of the stored states."""
        return [state.tick for state in self._stored]

    def follow(self, session: Session) -> None:
        """Store the changes of the session since the last call, and its state if one is due.

        Call it before steps are taken.
        """
        moment = time.perf_counter()
        self._wall += min(moment - self._followed_at, PAUSE) if self._stored else 0.0
        self._followed_at = moment
        self.note(session)
        waits = session.next_dt != session.dt  # a snapshot does not hold a step that is still to come
        if self._too_large or waits or (self._stored and self._wall < self._due):
            return
        if self._stored and self._stored[-1].tick == session.tick:
            return
        snapshot = session.snapshot()
        nbytes = size(snapshot)
        if 2 * nbytes > self._most:
            self._too_large = nbytes
            self._stored.clear()
            return
        self._stored.append(_BranchState(snapshot, session.world, self._wall, nbytes))
        self._due = self._wall + max(self._interval, (time.perf_counter() - moment) / SHARE)
        while len(self._stored) > 1 and self._stored[1].wall < self._wall - SECONDS:
            self._stored.pop(0)
        while self.nbytes > self._most:
            self._thin()

    def note(self, session: Session) -> None:
        """Store the changes of the session since the last call."""
        gone, new = self._reader.news(session.journal)
        if self._stored:
            changes = self._stored[-1].changes
            changes[len(changes) - gone :] = new

    def forget(self) -> None:
        """Forget all states, because the run must not return to them."""
        self._stored.clear()

    def branch(self, session: Session, tick: int, progress: StepProgress) -> None:
        """Take a session back to an earlier tick; later states are forgotten.

        The state has the bits that it had at this tick, also where parameters were changed before, inputs
        injected or objects moved. If an error occurs, the session keeps its present state.

        Raises:
            RecordError: no state before this tick is stored, or the world cannot be read again.
        """
        self.note(session)
        k = next((k for k in reversed(range(len(self._stored))) if self._stored[k].tick <= tick), None)
        self._require(session, k)
        assert k is not None
        begin = self._stored[k]
        present, world = session.snapshot(), session.world
        changes = until(begin.changes, tick)
        try:
            session.go_back(begin.snapshot, begin.world)
            repeat_changes(session, changes, tick, progress)
        except BaseException:
            session.go_back(present, world)
            self._reader.skip(session.journal)
            raise
        begin.changes = changes
        del self._stored[k + 1 :]
        self._due = self._wall
        self._reader.skip(session.journal)

    def _require(self, session: Session, k: int | None) -> None:
        """Raise RecordError if a moment cannot be computed again."""
        worlds = {session.world, *(state.world for state in self._stored)}
        live = next((world for world in worlds if world is not None and not world.repeatable), None)
        if live is not None:
            raise RecordError(
                f"The run cannot continue from this moment: the world {type(live).__name__} cannot be read"
                " again",
                fix="Save a snapshot before the moment you want to return to",
            )
        if self._too_large:
            raise RecordError(
                f"The run cannot continue from this moment: a state of it takes {self._too_large / 2**20:.0f}"
                f" MiB, and states up to {self._most // 2 / 2**20:.0f} MiB are kept",
                fix="Save a snapshot of the moment you want to return to",
            )
        if k is None:
            raise RecordError(
                "The run cannot continue from this moment: no state before it is kept any more",
                fix="Choose a later moment",
            )

    def _thin(self) -> None:
        """Remove the state whose neighbours are closest to each other, in proportion to its age."""
        if len(self._stored) <= 2:
            self._stored.pop(0)
            return
        walls = np.array([state.wall for state in self._stored])
        gaps, ages = walls[2:] - walls[:-2], self._wall - walls[1:-1]
        k = int(np.argmin(gaps / np.maximum(ages, 1e-9))) + 1
        self._stored[k - 1].changes += self._stored.pop(k).changes


def size(snapshot: SessionSnapshot) -> int:
    """Return the bytes of the arrays of a snapshot, each counted once."""
    of_elements = [array for pair in snapshot.states.values() for row in pair for array in row.values()]
    theirs = [] if snapshot.world is None else jax.tree.leaves(snapshot.world.world)
    bases: dict[int, int] = {}
    for array in [*of_elements, *(leaf for leaf in theirs if hasattr(leaf, "nbytes"))]:
        base = array
        while isinstance(base, np.ndarray) and isinstance(base.base, np.ndarray):
            base = base.base
        bases[id(base)] = int(base.nbytes)
    return sum(bases.values())
