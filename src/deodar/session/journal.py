"""The journal of a session: the calls that changed it, which are repeated, and written into records."""

from __future__ import annotations

import dataclasses as dc
import time
import types
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import RecordError
from deodar.model import document_files as documents
from deodar.model.document import Document
from deodar.parameters import FrozenArray
from deodar.recording.provenance import described

TOGETHER = 0.05
"""Wall time of the steps between two reports of progress, in seconds."""

StepProgress = Callable[[int, int], None]
"""Function that is called with the number of steps taken and their total."""


class Advanced(Protocol):
    """What changes are repeated on: a session."""

    @property
    def tick(self) -> int: ...
    def step(self, n: int = 1) -> None: ...


WORDS = {
    "inject": "push",
    "move": "world.move",
    "place": "world.place",
    "remove": "world.remove",
    "push_body": "world.push",
    "narrow_motor": "world.narrow",
}
"""Methods whose entry in a record is a word and the name of an element or object."""

SEVERAL = ("inject", "place", "narrow_motor")
"""Methods with several arguments after the name."""

INCOMPLETE = {"edit": "document", "dt": "dt", "world": "world", "reset": "reset", "restore": "restore"}
"""Methods whose entry in a record is a word, and does not describe the change completely."""


@dc.dataclass(frozen=True)
class Change:
    """An entry of the journal of a session: the tick, the method that was called, and its arguments.

    `method` may also be a property that was set: `dt`, or `world`.
    """

    tick: int
    method: str
    arguments: tuple[Any, ...]

    def repeat(self, session: Advanced) -> None:
        """Make the change again, at the present tick of a session."""
        member = getattr(type(session), self.method)
        call = member.__set__ if isinstance(member, property) else member
        call(session, *(a.data if isinstance(a, FrozenArray) else a for a in self.arguments))


class JournalReader:
    """Reads the journal of a session while it grows."""

    def __init__(self, journal: Sequence[Change] = ()) -> None:
        self.skip(journal)

    def skip(self, journal: Sequence[Change]) -> None:
        """Continue after the last change."""
        self._seen, self._last = len(journal), journal[-1] if journal else None

    def news(self, journal: Sequence[Change]) -> tuple[int, Sequence[Change]]:
        """Return how many of the last changes count no more (0 or 1: of several moves the last one counts),
        and the changes since the last call.
        """
        gone = int(self._seen > 0 and journal[self._seen - 1] is not self._last)
        new = journal[self._seen - gone :]
        self.skip(journal)
        return gone, new


# ---------------------------------------------------------------------------------------------- repeating


def until(changes: Iterable[Change], tick: int) -> list[Change]:
    """Return the changes that a session has seen at a tick; an injected input lasts at most until then."""
    out: list[Change] = []
    for change in changes:
        age = tick - change.tick
        if change.method == "inject" and age >= 0:
            path, amount, n = change.arguments
            change = dc.replace(change, arguments=(path, amount, min(n, age)))
            age -= 1  # without a step it has no effect
        out += [change] if age >= 0 else []
    return out


def repeat_changes(
    session: Advanced,
    changes: Sequence[Change],
    tick: int,
    progress: StepProgress,
    stops: Mapping[int, Callable[[], None]] = types.MappingProxyType({}),
) -> None:
    """Advance a session to a tick, as fast as possible, with changes at their ticks.

    `stops` has functions that are called at a tick, before its changes.

    Raises:
        RecordError: a change cannot be repeated.
    """
    first, pending = session.tick, list(changes)
    together = 1
    while True:
        if session.tick in stops:
            stops[session.tick]()
        while pending and pending[0].tick <= session.tick:
            change = pending.pop(0)
            if change.method in ("reset", "restore"):
                raise RecordError(
                    f"The run cannot continue from this moment: a {change.method} lies before it"
                )
            change.repeat(session)
        if session.tick >= tick:
            return
        end = min([tick, *(t for t in stops if t > session.tick), *(c.tick for c in pending[:1])])
        began, n = time.perf_counter(), min(end - session.tick, together)
        session.step(n)
        seconds = time.perf_counter() - began
        together = max(1, min(2 * together, round(n * TOGETHER / max(seconds, 1e-9))))
        progress(session.tick - first, tick - first)


# ---------------------------------------------------------------------------------------------- in records


def to_file(change: Change) -> JsonObject:
    """Return a change as a record states it: tick, what was changed, and its new value."""
    method, (name, *arguments) = change.method, change.arguments
    if method in INCOMPLETE:
        subject, value = INCOMPLETE[method], described(name) if method == "world" else name
    else:
        subject = f"{WORDS[method]} {name}" if method in WORDS else name
        value = arguments if method in SEVERAL else arguments[0] if arguments else None
    return {"tick": change.tick, "what": subject, "value": _plain(value)}


def from_file(entry: Mapping[str, Any]) -> Change:
    """Return the change that a record states.

    Raises:
        RecordError: the record does not describe it completely.
    """
    tick, subject, value = int(entry["tick"]), str(entry["what"]), entry["value"]
    if subject in INCOMPLETE.values():
        raise RecordError(f"the change of {subject!r} at step {tick} cannot be repeated from the record")
    word, _, name = subject.partition(" ")
    for method, method_word in WORDS.items():
        if method_word == word:
            arguments = value if method in SEVERAL else [] if method == "remove" else [value]
            return Change(tick, method, (name, *arguments))
    return Change(tick, "set", (subject, value))


def _plain(value: Any) -> Json:
    """Return a changed value as plain data."""
    if isinstance(value, Document):
        return documents.to_data(value)[0]
    if isinstance(value, FrozenArray):
        return value.data.tolist()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(part) for part in value]
    if dc.is_dataclass(value) and not isinstance(value, type):
        return repr(value)
    try:
        return codec.parse(codec.line(value))
    except (TypeError, ValueError):
        return repr(value)
