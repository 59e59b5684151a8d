"""The commands on their way to topics, and the command at rest when none follows."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping

import numpy as np

from deodar.errors import WorldError
from deodar_robots.ros2.message_types import to_bytes
from deodar_robots.ros2.motor_types import MotorCommand

Publish = Callable[[str, bytes, bool], None]
"""Sends a message on a topic, and waits for the network where asked for."""


class CommandSender:
    """Sends commands within the rules of their motors. A thread sends the command at rest when no command of
    a topic came for the shortest `stops_after` of its motors.

    Args:
        motors: topic, type and command of each motor.
        publish: sends a message.
        period: ms between two commands.
    """

    def __init__(
        self, motors: Mapping[str, tuple[str, str, MotorCommand]], publish: Publish, period: float
    ) -> None:
        self._motors, self._publish, self._period = dict(motors), publish, period
        self._changed = threading.Condition()
        self._before: dict[str, np.ndarray] = {}
        self._due: dict[str, float] = {}
        self._closed = False
        self._thread = threading.Thread(target=self._watch, name="ros2 rest", daemon=True)
        if self._motors:
            self._thread.start()

    def send(self, commands: Mapping[str, np.ndarray]) -> None:
        """Send commands by name of the motor, without an axis of copies.

        Raises:
            WorldError: a command is not finite, or has another shape than its motor.
        """
        with self._changed:
            for name, command in commands.items():
                topic, _, motor = self._motors[name]
                if np.shape(command) != motor.signal.shape or not np.isfinite(command).all():
                    what = f"has the shape {list(np.shape(command))}, or is not finite"
                    raise WorldError(f"a command for {topic} {what}", f"motor {name!r}")
                self._before[name] = motor.rule.allowed(
                    np.asarray(command), self._before.get(name), self._period
                )
            now = time.monotonic()
            for topic in {self._motors[name][0] for name in commands}:
                self._emit(topic, False)
                self._due[topic] = now + self._stops_after(topic)
            self._changed.notify_all()

    def rest(self) -> None:
        """Send the command at rest on all topics that were commanded."""
        with self._changed:
            for topic in list(self._due):
                self._rest(topic)

    def close(self) -> None:
        """Send the command at rest, and end the thread."""
        self.rest()
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join()

    def _stops_after(self, topic: str) -> float:
        """Return the time without a command after which a topic goes to rest, s."""
        return min(m.rule.stops_after for t, _, m in self._motors.values() if t == topic) / 1000

    def _emit(self, topic: str, waits: bool) -> None:
        """Send the present commands of a topic as one message."""
        parts = [
            (m, self._before[n]) for n, (t, _, m) in self._motors.items() if t == topic and n in self._before
        ]
        self._publish(topic, to_bytes(parts[0][0].message(parts)), waits)

    def _rest(self, topic: str) -> None:
        """Put the motors of a topic to rest; those without a command at rest keep the last one."""
        del self._due[topic]
        there = [n for n, (t, _, _) in self._motors.items() if t == topic and n in self._before]
        resting = [name for name in there if self._motors[name][2].rests]
        for name in resting:
            self._before[name] = self._motors[name][2].rule.at_rest(self._before[name])
        if resting:
            self._emit(topic, True)
        for name in there:
            del self._before[name]

    def _watch(self) -> None:
        with self._changed:
            while not self._closed:
                now = time.monotonic()
                for topic in [t for t, due in self._due.items() if due <= now]:
                    self._rest(topic)
                soonest = min(self._due.values(), default=None)
                self._changed.wait(None if soonest is None else max(0.0, soonest - now))
