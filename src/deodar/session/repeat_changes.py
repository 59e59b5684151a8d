"""Take the steps of a session again, with the changes of its journal."""

from __future__ import annotations

import time
import types
from collections.abc import Callable, Mapping

import numpy as np

from deodar.errors import RecordError
from deodar.parameters import FrozenArray
from deodar.session.recorder import Change
from deodar.session.session import Session

TOGETHER = 0.05
"""Wall time of the steps between two reports of progress, in seconds."""

StepProgress = Callable[[int, int], None]
"""Function that is called with the number of steps taken and their total."""


def is_push(change: Change) -> bool:
    """Return whether a change is an injected input, which lasts for steps."""
    return change.what.startswith("push ")


def repeat_changes(
    session: Session,
    changes: list[Change],
    tick: int,
    progress: StepProgress,
    stops: Mapping[int, Callable[[], None]] = types.MappingProxyType({}),
) -> None:
    """Advance a session to a tick, as fast as possible, with changes at their ticks.

    `stops` has functions that are called at a tick, before its changes.

    Raises:
        RecordError: a change cannot be repeated.
    """
    first, left = session.tick, list(changes)
    together = 1
    while True:
        if session.tick in stops:
            stops[session.tick]()
        while left and left[0].tick <= session.tick:
            repeat_change(session, left.pop(0), tick)
        if session.tick >= tick:
            return
        end = min([tick, *(t for t in stops if t > session.tick), *(c.tick for c in left[:1])])
        began, n = time.perf_counter(), min(end - session.tick, together)
        session.step(n)
        seconds = time.perf_counter() - began
        together = max(1, min(2 * together, round(n * TOGETHER / max(seconds, 1e-9))))
        progress(session.tick - first, tick - first)


def repeat_change(session: Session, change: Change, tick: int) -> None:
    """Make a change of a journal again; an injected input lasts at most up to `tick`."""
    what, value = change.what, change.value
    verb, _, name = what.partition(" ")
    if what == "document":
        session.edit(value)
    elif what == "dt":
        session.dt = value
    elif what == "world":
        session.world = value
    elif verb == "push":
        amount, n = value
        given = amount.data if isinstance(amount, FrozenArray) else np.asarray(amount, float)
        session.inject(name, given, min(n, tick - session.tick))
    elif verb == "world.move":
        session.move(name, value)
    elif verb == "world.place":
        session.place(name, *value)
    elif verb == "world.remove":
        session.remove(name)
    elif verb == "world.push":
        session.push_body(name, value)
    elif what in ("reset", "restore"):
        raise RecordError(f"The run cannot continue from this moment: a {what} lies before it")
    else:
        session.set(what, value.data if isinstance(value, FrozenArray) else value)
