"""From the commands of motors to a message: the contract of all types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from msgspec import UNSET

from deodar.errors import WorldError
from deodar.worlds._base import Signal
from deodar.worlds._motor_rule import MotorRule
from deodar_robots.ros2.topic_motor import TopicMotor


class MotorCommand:
    """What a motor sends to a topic.

    Args:
        entry: the setting of the motor.
        where: its place, for messages.
        period: ms between two exchanges.

    Attributes:
        signal: signal of the motor.
        rule: limits, rate of change and rest.
        rests: whether a message is sent at rest; without one the robot keeps the last command.
        fields: names of the parts of the message that the motor commands; two motors share none.
    """

    settings: Sequence[str] = ()
    """Settings that the type uses, besides those of all motors."""

    fields: Sequence[str] = ()

    def __init__(self, entry: TopicMotor, where: str, period: float) -> None:
        for name in ("shape", "fields", "joints", "duration"):
            if getattr(entry, name) is not None and name not in self.settings:
                raise WorldError(f"the type {entry.type} has no setting {name!r}", where)
        self.entry, self.where, self.period = entry, where, period
        self.signal = self.declared()
        rest = self.default_rest() if entry.rest is UNSET else entry.rest
        self.rests = rest is not None
        if entry.slew is not None and rest is None:
            raise WorldError("a rate of change begins at the command at rest, and this motor has none", where)
        low, high = entry.limits or (0.0, 0.0)
        # without a rest none is sent, but a rule has one within its limits
        value = min(max(0.0, low), high) if rest is None else float(rest)  # type: ignore[arg-type]
        rule = {"limits": entry.limits, "slew": entry.slew, "stops_after": entry.stops_after, "rest": value}
        self.rule = MotorRule.from_data(rule, where)

    def declared(self) -> Signal:
        """Return the signal of the motor."""
        raise NotImplementedError

    def default_rest(self) -> float | None:
        """Return the value at rest of a motor that states none; None: no message is sent."""
        return 0.0

    @classmethod
    def message(cls, commands: Sequence[tuple[Any, np.ndarray]]) -> Any:
        """Return the message of all motors of a topic, each with its command."""
        raise NotImplementedError

    def values(self, command: np.ndarray) -> Mapping[str, float]:
        """Return the number of each field."""
        return dict(zip(self.fields, np.reshape(command, -1).astype(float).tolist(), strict=True))
