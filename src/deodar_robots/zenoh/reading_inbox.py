"""The readings that came from a robot: the newest of each sensor, and how well the link works."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence

import numpy as np

from deodar.errors import WorldError
from deodar.worlds._link_state import LinkState
from deodar_robots.zenoh.message import BadMessage, WireMessage


class ReadingInbox:
    """Readings from the network. Memory is bounded: the newest reading of each key is kept.

    Methods may be called by any thread.

    Attributes:
        stamp: stamp of the newest message of the robot; 0: none.
        gone: whether the robot has left the network.
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
            return LinkState(
                robot, 1000 * self.age(), self._received, self._lost, self._refused, self._round_trip
            )
