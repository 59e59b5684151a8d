"""The commands that a robot received: counted, checked, and the newest of each motor."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from deodar.worlds._base import Signal
from deodar_robots.zenoh.message import BadMessage, WireMessage


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
    with a sequence number above the last, is counted and never acted on. Memory is bounded: the newest
    command of each motor is kept. Methods may be called by any thread.

    Args:
        motors: signals of the motors by name.
        complete: called when all commands of a period are there, with its number and its start in ms.

    Attributes:
        counts: messages by what became of them: accepted, bad (not a message, or not finite), shape (of
            another shape), foreign (not of the commander), unknown (no such motor), old (a number that goes
            back).
        stamp: stamp of the newest accepted message; 0: none.
    """

    def __init__(
        self, motors: Mapping[str, Signal], complete: Callable[[int, float], None] | None = None
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

    def offer(self, motor: str, raw: bytes) -> None:
        """Take a message for a motor, or count why it is not taken."""
        try:
            message = WireMessage.from_bytes(raw)
        except BadMessage:
            self.counts["bad"] += 1
            return
        with self._lock:
            refused = self._refused(motor, message)
            self.counts[refused or "accepted"] += 1
            if refused:
                return
            lead = 1 if self._copies == 1 else 0
            numbers = message.array[None] if lead else message.array
            self._newest[motor] = Command(numbers, message.sequence, time.monotonic())
            self.stamp = message.stamp
        self._check()

    def end(self, raw: bytes) -> None:
        """Take the message that ends the commands of a period; its parts are the number of commands."""
        try:
            message = WireMessage.from_bytes(raw)
        except BadMessage:
            self.counts["bad"] += 1
            return
        with self._lock:
            if not self._commander or message.commander != self._commander:
                self.counts["foreign"] += 1
                return
            if message.sequence <= self._ended:
                self.counts["old"] += 1
                return
            self.stamp = message.stamp
            self._waiting = message.sequence, message.parts, message.time
        self._check()

    def halt(self, raw: bytes) -> None:
        """Take the message that puts all motors to rest: forget the commands up to its number."""
        try:
            message = WireMessage.from_bytes(raw)
        except BadMessage:
            self.counts["bad"] += 1
            return
        with self._lock:
            if not self._commander or message.commander != self._commander:
                self.counts["foreign"] += 1
                return
            self._halted = max(self._halted, message.sequence)
            self._newest = {m: c for m, c in self._newest.items() if c.sequence > self._halted}

    def commands(self, sequence: int | None = None) -> dict[str, Command]:
        """Return the newest command of each motor, or those of one period."""
        with self._lock:
            return {m: c for m, c in self._newest.items() if sequence is None or c.sequence == sequence}

    def _refused(self, motor: str, message: WireMessage) -> str:
        """Return why a command is not accepted; empty: it is."""
        if not self._commander or message.commander != self._commander:
            return "foreign"
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
        return "old" if message.sequence <= after else ""

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
