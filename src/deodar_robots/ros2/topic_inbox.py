"""The newest reading of each sensor from the messages of topics: checked, counted, of bounded size."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.errors import WorldError
from deodar.worlds._link_state import LinkState
from deodar_robots.ros2.message_types import Unreadable, from_bytes
from deodar_robots.ros2.reading import Decode, Reading
from deodar_robots.ros2.wire import Attachment, type_of_wire


class TopicInbox:
    """Readings from topics. Memory is bounded: the newest reading of each sensor is kept.

    What takes long to decode, such as a compressed picture, is kept as it came until the sensor is read. So
    it delays no message of another topic, and a message that a newer one replaces is not decoded.

    A message that is cut or damaged, of another type, without an attachment, with a number that goes back,
    with undefined numbers or of another shape is counted and never read. Methods may be called by any thread.

    Args:
        sensors: topic, type and reading of each sensor.
        hashes: hash of each type.

    Attributes:
        counts: messages by what became of them: accepted, or refused.
    """

    def __init__(self, sensors: Mapping[str, tuple[str, str, Reading]], hashes: Mapping[str, str]) -> None:
        self.counts: Counter[str] = Counter()
        self._sensors, self._hashes = dict(sensors), dict(hashes)
        self._changed = threading.Condition()
        self._decoding = {name: threading.Lock() for name in sensors}
        self._beginnings = 0
        self._undecoded: dict[str, tuple[Decode, float]] = {}
        self._damaged: dict[str, float] = {}
        self._newest: dict[str, tuple[np.ndarray, float]] = {}
        self._last: dict[str, Attachment] = {}
        self._refused: dict[str, Unreadable] = {}
        self._received: Counter[str] = Counter()
        self._lost = 0
        self._heard = time.monotonic()

    def begin(self) -> None:
        """Forget all readings."""
        with self._changed:
            self._beginnings += 1
            self._newest.clear()
            self._undecoded.clear()
            self._refused.clear()
            self._heard = time.monotonic()

    def offer(self, topic: str, key: str, raw: bytes, attached: bytes | None) -> None:
        """Take a message of a topic, or count that it is refused.

        Args:
            topic: the topic.
            key: key of the message, that ends in its type and the hash of its type.
            raw: the message.
            attached: its attachment.
        """
        now = time.monotonic()
        readers = {n: (t, r) for n, (place, t, r) in self._sensors.items() if place == topic}
        taken: dict[str, np.ndarray | Decode] = {}
        refused: dict[str, Unreadable] = {}
        attachment = None
        try:
            attachment = Attachment.from_bytes(attached)
            for type in {t for t, _ in readers.values()}:
                self._require_type(type, key)
                message = from_bytes(raw, type)
                for name, (_, reading) in readers.items():
                    try:
                        taken[name] = reading.take(message)
                    except Unreadable as error:
                        refused[name] = error
        except Unreadable as error:
            refused = dict.fromkeys(readers, error)
        with self._changed:
            if attachment is not None and self._goes_back(topic, attachment):
                taken, refused = {}, dict.fromkeys(readers, Unreadable("its sequence number goes back"))
            self.counts["refused" if refused else "accepted"] += 1
            for name, value in taken.items():
                if callable(value):
                    self._undecoded[name] = value, now
                else:
                    self._newest[name] = value, now
                    self._refused.pop(name, None)
                self._received[name] += 1
                self._heard = now
            self._refused |= refused
            self._changed.notify_all()

    def _require_type(self, type: str, key: str) -> None:
        """Raise Unreadable if a message has another type, or another version of it."""
        *_, found, hash = key.split("/")
        if type_of_wire(found) != type:
            raise Unreadable(f"it is a {type_of_wire(found)}", "State its type")
        if hash != self._hashes[type]:
            raise Unreadable(f"its {type} is of another version ({hash[:20]}...) than that of ROS 2 Jazzy")

    def _goes_back(self, topic: str, attachment: Attachment) -> bool:
        """Return whether a message is not newer than the last one of its publisher; count what was lost."""
        last = self._last.get(topic)
        if last is not None and last.publisher == attachment.publisher:
            step = attachment.sequence - last.sequence
            if step <= 0:
                return True
            self._lost += step - 1
        self._last[topic] = attachment
        return False

    def wait_for(self, names: Sequence[str], seconds: float) -> bool:
        """Return whether all these sensors have a reading within some seconds.

        Decoding that has begun is completed, at most one picture of each sensor.
        """
        until = time.monotonic() + seconds
        while True:
            with self._changed:
                if all(n in self._newest for n in names):
                    return True
                seconds = max(0.0, until - time.monotonic())
                if not self._changed.wait_for(lambda: self._arrived(names), seconds):
                    return False
            for name in names:
                self._decode(name)
            if time.monotonic() >= until:  # where newer messages wait already, the wait above never ends it
                with self._changed:
                    return all(n in self._newest for n in names)

    def _arrived(self, names: Sequence[str]) -> bool:
        return all(name in self._newest or name in self._undecoded for name in names)

    def _decode(self, name: str) -> None:
        """Decode the newest message for a sensor, unless it is decoded; one that cannot be is refused."""
        topic = self._sensors[name][0]
        with self._decoding[name]:
            with self._changed:
                beginnings = self._beginnings
                decode, moment = self._undecoded.pop(name, (None, 0.0))
            if decode is None:
                return
            try:
                reading: np.ndarray | Unreadable = decode()
            except Unreadable as error:
                reading = error
            with self._changed:
                if beginnings != self._beginnings:
                    return
                if isinstance(reading, Unreadable):
                    self._refused[name] = reading
                    self._received[name] -= 1
                    if self._damaged.get(topic) != moment:  # several sensors may read one message
                        self._damaged[topic] = moment
                        self.counts.update(accepted=-1, refused=1)
                else:
                    self._newest[name] = reading, moment
                    self._refused.pop(name, None)
                self._changed.notify_all()

    def reading(self, name: str) -> tuple[np.ndarray, float] | None:
        """Return what the newest message said for a sensor, and its age in s."""
        self._decode(name)
        with self._changed:
            found = self._newest.get(name)
            return None if found is None else (found[0], time.monotonic() - found[1])

    def refused(self, name: str) -> Unreadable | None:
        """Return why the last message for a sensor was refused; None: it was not."""
        with self._changed:
            return self._refused.get(name)

    def state(self, robot: str) -> LinkState:
        """Return how well the link works."""
        with self._changed:
            by = dict(self._received)
            age = 1000 * (time.monotonic() - self._heard)
            return LinkState(robot, age, sum(by.values()), self._lost, self.counts["refused"], 0.0, by)


def silence(
    name: str, topic: str, at: str, age: float | None, why: Unreadable | None, near: str
) -> WorldError:
    """Return the error of a sensor without a fresh reading.

    Args:
        name: name of the sensor.
        topic: its topic.
        at: endpoint.
        age: age of its newest reading, s; None: there was none.
        why: why the last message was refused; None: none was.
        near: what to type if nothing came.
    """
    since = "has no message that was read" if age is None else f"was last read {age:.2f} s ago"
    text = f"the topic {topic} at {at} {since}"
    if why is not None:
        return WorldError(f"{text}; its last message was refused: {why}", f"sensor {name!r}", why.fix)
    return WorldError(text, f"sensor {name!r}", near)
