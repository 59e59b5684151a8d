"""What came from the network: the readings of a robot, and the commands for one, checked and counted."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deodar import codec
from deodar.errors import DeodarError, WorldError
from deodar.worlds._base import Signal
from deodar.worlds._link_state import LinkState
from deodar_robots.zenoh.about import BadMessage, WireMessage

AHEAD = 100
"""Periods by which a command may be ahead of the last one. After messages were lost it may be ahead by
`AHEAD_EACH` more for each period of the robot since then, so that a number of a damaged or forged message
neither is obeyed nor makes the numbers of later commands old. Both are guesses.
"""

AHEAD_EACH = 10


class ReadingInbox:
    """Readings from the network. Memory is bounded: the newest reading of each key is kept.

    Methods may be called by any thread.

    Attributes:
        stamp: stamp of the newest message of the robot; 0: none.
        gone: whether the robot has left the network.
        refusals: messages that the robot refused in this run, by reason.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._newest: dict[str, tuple[WireMessage, float]] = {}
        self._keys: frozenset[str] | None = None
        self._error = ""
        self._heard = time.monotonic()
        self._last = 0
        self._received = self._lost = self._refused = 0
        self._round_trip = 0.0
        self.stamp = 0
        self.gone = False
        self.refusals: dict[str, int] = {}

    def want(self, keys: Sequence[str]) -> None:
        """Keep the readings of these keys alone."""
        with self._changed:
            self._keys = frozenset(keys)
            self._newest = {k: v for k, v in self._newest.items() if k in self._keys}

    def begin(self) -> None:
        """Forget all readings."""
        with self._changed:
            self._newest.clear()
            self._keys, self._error, self._last, self.stamp = frozenset(), "", 0, 0
            self.refusals = {}
            self._heard = time.monotonic()

    def offer(self, where: str, raw: bytes) -> None:
        """Take a reading, or count that it is refused."""
        moment = time.monotonic()
        try:
            message = WireMessage.from_bytes(raw)
        except BadMessage:
            message = None
        with self._changed:
            if self._keys is not None and where not in self._keys:
                return
            last = self._newest.get(where)
            back = message is not None and last is not None and message.sequence <= last[0].sequence
            if message is None or back or not message.finite:
                self._refused += 1
                return
            self._newest[where] = message, moment
            self._heard = moment
            self._changed.notify_all()

    def add(self, where: str, message: WireMessage) -> None:
        """Take a reading that was asked for, unless a newer one has come meanwhile."""
        with self._changed:
            last = self._newest.get(where)
            if message.finite and (last is None or last[0].sequence < message.sequence):
                self._newest[where] = message, time.monotonic()

    def end(self, raw: bytes) -> None:
        """Take the message that ends the readings of a period."""
        try:
            message = WireMessage.from_bytes(raw)
        except BadMessage:
            self._refused += 1
            return
        with self._changed:
            if message.sequence <= self._last:
                self._refused += 1
                return
            if self._last:
                self._lost += message.sequence - self._last - 1
            self._last, self._heard = message.sequence, time.monotonic()
            self._received += 1
            self.stamp = message.stamp
            if message.answers:
                self._round_trip = (time.monotonic_ns() - message.answers) / 1e6
            self._changed.notify_all()

    def fail(self, text: str) -> None:
        """Take an error that the robot reports."""
        with self._changed:
            self._error = text[:1000]
            self._changed.notify_all()

    def refuse(self, raw: bytes) -> None:
        """Take the numbers of messages that the robot refused, by reason."""
        try:
            counts = codec.read(raw)
        except DeodarError:
            counts = None
        if isinstance(counts, dict):
            self.refusals = {
                reason: n for reason, n in counts.items() if reason in REASONS and type(n) is int
            }

    def leave(self) -> None:
        """Take the news that the robot has left the network; one that returns has to be begun again."""
        with self._changed:
            self.gone = True
            self._changed.notify_all()

    def require(self) -> None:
        """Raise WorldError if the robot reported an error."""
        if self._error:
            raise WorldError(f"the robot reports: {self._error}")

    def wait(self, sequence: int, seconds: float) -> bool:
        """Return whether a period ended, the robot left or reported an error within some seconds."""
        with self._changed:
            return self._changed.wait_for(
                lambda: self._last >= sequence or self.gone or bool(self._error), seconds
            )

    def wait_for(self, keys: Sequence[str], seconds: float, sequence: int = 0) -> bool:
        """Return whether all these readings, of a period or a later one, are there within some seconds."""

        def complete() -> bool:
            newest = [self._newest.get(k) for k in keys]
            return all(f is not None and f[0].sequence >= sequence for f in newest)

        with self._changed:
            self._changed.wait_for(lambda: self.gone or bool(self._error) or complete(), seconds)
            return complete()

    def reading(self, where: str) -> tuple[np.ndarray, int, float] | None:
        """Return the newest reading of a key, the number of its period, and its age in s."""
        with self._changed:
            newest = self._newest.get(where)
            if newest is None:
                return None
            message, arrived = newest
            return message.array, message.sequence, time.monotonic() - arrived

    def period(self) -> int:
        """Return the number of the last period that ended."""
        return self._last

    def age(self) -> float:
        """Return the time since the last period of the robot, s."""
        return time.monotonic() - self._heard

    def state(self, robot: str) -> LinkState:
        """Return how well the link with a robot works."""
        with self._changed:
            refused = self._refused + sum(self.refusals.values())
            return LinkState(robot, 1000 * self.age(), self._received, self._lost, refused, self._round_trip)


REASONS = {
    "bad": "not a message, or not finite",
    "shape": "of another shape than the motor",
    "foreign": "of another commander",
    "unknown": "for a motor that is not there",
    "old": "with a number that goes back",
    "jump": "with a number that jumps ahead",
}
"""Why a message for a robot is refused."""


@dataclass(frozen=True)
class Command:
    """The newest command of a motor.

    Attributes:
        value: the command, copies first.
        sequence: number of its period.
        arrived: monotonic clock at its arrival, s.
    """

    value: np.ndarray
    sequence: int
    arrived: float


class CommandInbox:
    """Commands from the network, of one commander at a time.

    Anybody may send; a message that is not a finite array of the motor's shape from the present commander,
    with a sequence number above the last and not far beyond it, is counted and never acted on. Memory is
    bounded: the newest command of each motor is kept. Methods may be called by any thread.

    Args:
        motors: signals of the motors by name.
        complete: called when all commands of a period are there, with its number and its start in ms.
        period: ms between two commands; None: it never changes.

    Attributes:
        counts: messages by what became of them: accepted, or one of `REASONS`.
        stamp: stamp of the newest accepted message; 0: none.
    """

    def __init__(
        self,
        motors: Mapping[str, Signal],
        complete: Callable[[int, float], None] | None = None,
        period: float | None = None,
    ) -> None:
        self.counts: Counter[str] = Counter()
        self.stamp = 0
        self._motors = dict(motors)
        self._complete = complete
        self._lock = threading.Lock()
        self._commander = 0
        self._copies = 1
        self._newest: dict[str, Command] = {}
        self._ended, self._halted = 0, -1
        self._waiting: tuple[int, int, float] | None = None
        self._period = period
        self._reached, self._reached_at = 0, time.monotonic()
        self._before: Counter[str] = Counter()

    @property
    def commander(self) -> int:
        """Number of the present commander; 0: none."""
        return self._commander

    def begin(self, commander: int, copies: int = 1) -> None:
        """Accept commands of one commander alone, from its first on; 0: of none."""
        with self._lock:
            self._commander, self._copies = commander, copies
            self._newest.clear()
            self._waiting, self._ended, self._halted, self.stamp = None, 0, -1, 0
            self._reached, self._reached_at = 0, time.monotonic()
            self._before = self.counts.copy()

    def offer(self, motor: str, raw: bytes) -> None:
        """Take a message for a motor, or count why it is not taken."""
        with self._lock:
            message = self._message(raw)
            if message is None:
                return
            refused = self._refused(motor, message)
            self.counts[refused or "accepted"] += 1
            if refused:
                return
            lead = 1 if self._copies == 1 else 0
            numbers = message.array[None] if lead else message.array
            self._newest[motor] = Command(numbers, message.sequence, time.monotonic())
            self._reach(message)
        self._check()

    def end(self, raw: bytes) -> None:
        """Take the message that ends the commands of a period; its parts are the number of commands."""
        with self._lock:
            message = self._message(raw)
            if message is None:
                return
            refused = "old" if message.sequence <= self._ended else self._jump(message)
            if refused:
                self.counts[refused] += 1
                return
            self._reach(message)
            self._waiting = message.sequence, message.parts, message.time
        self._check()

    def halt(self, raw: bytes) -> None:
        """Take the message that puts all motors to rest: forget the commands up to its number."""
        with self._lock:
            message = self._message(raw)
            if message is None:
                return
            if self._jump(message):
                self.counts["jump"] += 1
                return
            self._halted = max(self._halted, message.sequence)
            self._newest = {m: c for m, c in self._newest.items() if c.sequence > self._halted}

    def commands(self, sequence: int | None = None) -> dict[str, Command]:
        """Return the newest command of each motor, or those of one period."""
        with self._lock:
            return {m: c for m, c in self._newest.items() if sequence is None or c.sequence == sequence}

    def refusals(self) -> dict[str, int]:
        """Return the numbers of messages that were refused since the commander began, by reason."""
        with self._lock:
            return {k: n for k in REASONS if (n := self.counts[k] - self._before[k])}

    def _reach(self, message: WireMessage) -> None:
        """Note the newest message that was accepted."""
        self.stamp = message.stamp
        if message.sequence > self._reached:
            self._reached, self._reached_at = message.sequence, time.monotonic()

    def _jump(self, message: WireMessage) -> str:
        """Return `jump` if the number of a message is too far ahead of the last one, else ""."""
        waited = 1000 * (time.monotonic() - self._reached_at) / (self._period or 1000.0)
        return "jump" if message.sequence > self._reached + AHEAD + AHEAD_EACH * waited else ""

    def _message(self, raw: bytes) -> WireMessage | None:
        """Return a message of the present commander; None, and a count, for another one."""
        try:
            message = WireMessage.from_bytes(raw)
        except BadMessage:
            self.counts["bad"] += 1
            return None
        if self._commander and message.commander == self._commander:
            return message
        self.counts["foreign"] += 1
        return None

    def _refused(self, motor: str, message: WireMessage) -> str:
        """Return why a command of the commander is not accepted; empty: it is."""
        signal = self._motors.get(motor)
        if signal is None:
            return "unknown"
        lead = () if self._copies == 1 else (self._copies,)
        shape = message.array.shape
        expected = shape[len(lead) :] if signal.shape is None else signal.shape
        if shape != (*lead, *expected):
            return "shape"
        if message.array.dtype.kind != "f" or not message.finite:
            return "bad"
        last = self._newest.get(motor)
        after = self._halted if last is None else max(last.sequence, self._halted)
        return "old" if message.sequence <= after else self._jump(message)

    def _check(self) -> None:
        with self._lock:
            if self._waiting is None:
                return
            sequence, parts, start = self._waiting
            if sum(c.sequence == sequence for c in self._newest.values()) < parts:
                return
            self._waiting, self._ended = None, sequence
        if self._complete is not None:
            self._complete(sequence, start)
