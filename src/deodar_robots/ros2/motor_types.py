"""Types of messages that motors send: the setting of a motor, the contract, and a command of each type."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import UNSET, Meta, UnsetType

from deodar.errors import WorldError
from deodar.worlds._base import Signal
from deodar.worlds._motor_rule import STOPS_AFTER, MotorRule
from deodar_robots.ros2.message_types import full_name, header, make
from deodar_robots.ros2.reading import ArraySamples, chosen_fields, entries
from deodar_robots.ros2.wire import require_topic

Above0 = Annotated[float, Meta(gt=0)]


class TopicMotor(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A motor whose commands go to a topic. Several motors may command parts of one message.

    Attributes:
        topic: name of the topic.
        type: type of its messages, such as geometry_msgs/Twist.
        shape: number of values, where the type leaves it open.
        fields: which numbers of a message the command is; a single name instead of a list is one number.
        joints: names of the joints, in the order of the command.
        limits: smallest and largest value of each sample.
        slew: largest change of each sample per second.
        rest: value of each sample at rest; null: nothing is sent, and the robot keeps the last command.
        stops_after: time without a command after which the command at rest is sent, ms.
        duration: time in which joints reach the commanded point, ms; by default two exchanges.
    """

    topic: str
    type: str
    shape: ArraySamples | None = None
    fields: str | list[str] | None = None
    joints: list[str] | None = None
    limits: tuple[float, float] | None = None
    slew: Above0 | None = None
    rest: float | UnsetType | None = UNSET
    stops_after: Above0 = STOPS_AFTER
    duration: Above0 | None = None


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
        if entry.slew is not None:
            self.require_rest()
        low, high = entry.limits or (0.0, 0.0)
        # without a rest none is sent, but a rule has one within its limits
        value = min(max(0.0, low), high) if rest is None else float(rest)  # type: ignore[arg-type]
        rule = {"limits": entry.limits, "slew": entry.slew, "stops_after": entry.stops_after, "rest": value}
        self.rule = MotorRule.from_data(rule, where)

    def require_rest(self) -> None:
        """Raise WorldError if the motor has no command at rest."""
        if not self.rests:
            raise WorldError(
                "a rate of change begins at the command at rest, and this motor has none", self.where
            )

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


VELOCITIES = {
    f"{kind}.{axis}": unit for kind, unit in (("linear", "m/s"), ("angular", "rad/s")) for axis in "xyz"
}
"""Fields of a Twist, and their units: x is forward, y to the left, z up."""

JOINT_UNITS = {"positions": "rad", "velocities": "rad/s"}


class TwistCommand(MotorCommand):
    """Velocities of a geometry_msgs/Twist: by default forward (m/s) and turning to the left (rad/s)."""

    settings = ("fields",)

    def declared(self) -> Signal:
        default = ("linear.x", "angular.z")
        self.fields, shape, unit = chosen_fields(self.entry.fields, default, VELOCITIES, self.where)
        return Signal(f"{', '.join(self.fields)} of {self.entry.topic}", shape, unit)

    @classmethod
    def message(cls, commands: Sequence[tuple[MotorCommand, np.ndarray]]) -> Any:
        values = dict.fromkeys(VELOCITIES, 0.0)
        for motor, command in commands:
            values |= motor.values(command)
        parts = {
            kind: make("geometry_msgs/msg/Vector3", **{axis: values[f"{kind}.{axis}"] for axis in "xyz"})
            for kind in ("linear", "angular")
        }
        return make("geometry_msgs/msg/Twist", **parts)


class StampedTwistCommand(TwistCommand):
    """A Twist with the time at which it was sent."""

    @classmethod
    def message(cls, commands: Sequence[tuple[MotorCommand, np.ndarray]]) -> Any:
        return make(
            "geometry_msgs/msg/TwistStamped", header=header(time.time()), twist=super().message(commands)
        )


class ArrayCommand(MotorCommand):
    """The numbers of a std_msgs/Float64MultiArray; what they mean is a matter of the robot."""

    settings = ("shape",)
    fields = ("data",)

    def declared(self) -> Signal:
        shape = self.entry.shape
        if shape is None or len(shape) != 1:
            raise WorldError("a Float64MultiArray needs its shape", self.where, 'State it: "shape": [2]')
        if self.entry.rest is UNSET:
            raise WorldError(
                "a Float64MultiArray needs its command at rest",
                self.where,
                'For speeds "rest": 0; for positions "rest": null, so that the robot keeps the last one',
            )
        return Signal(f"numbers of {self.entry.topic}", tuple(shape))

    @classmethod
    def message(cls, commands: Sequence[tuple[MotorCommand, np.ndarray]]) -> Any:
        layout = make("std_msgs/msg/MultiArrayLayout", dim=[], data_offset=0)
        return make(
            "std_msgs/msg/Float64MultiArray", layout=layout, data=np.asarray(commands[0][1], np.float64)
        )


class JointCommand(MotorCommand):
    """One point of a trajectory_msgs/JointTrajectory, that `joints` reach within `duration`.

    The command is their positions (rad), or with `fields` "velocities" their velocities (rad/s). Positions
    have no command at rest: joints stop at the last point.
    """

    settings = ("fields", "joints", "duration")

    def declared(self) -> Signal:
        names, field = self.entry.joints, self.entry.fields or "positions"
        if not names or len(set(names)) < len(names):
            fix = 'State their names: "joints": ["shoulder", "elbow"]'
            raise WorldError("names no joints, or one twice", self.where, fix)
        if not isinstance(field, str) or field not in JOINT_UNITS:
            raise WorldError(
                f"there is no field {field!r}", self.where, f"Name one: {', '.join(JOINT_UNITS)}"
            )
        self.fields, self.field = (field,), field
        return Signal(f"{field} of the joints of {self.entry.topic}", (len(names),), JOINT_UNITS[field])

    def default_rest(self) -> float | None:
        return None if self.field == "positions" else 0.0

    @classmethod
    def message(cls, commands: Sequence[tuple[Any, np.ndarray]]) -> Any:
        motor, command = commands[0]
        point = {name: np.zeros(0) for name in ("positions", "velocities", "accelerations", "effort")}
        point[motor.field] = np.asarray(command, np.float64)
        seconds, nanoseconds = divmod(round(1e6 * (motor.entry.duration or 2 * motor.period)), 10**9)
        late = make("builtin_interfaces/msg/Duration", sec=seconds, nanosec=nanoseconds)
        points = [make("trajectory_msgs/msg/JointTrajectoryPoint", **point, time_from_start=late)]
        # the time 0 means at once
        return make(
            "trajectory_msgs/msg/JointTrajectory",
            header=header(),
            joint_names=list(motor.entry.joints),
            points=points,
        )


MOTOR_TYPES: Mapping[str, type[MotorCommand]] = {
    "geometry_msgs/msg/Twist": TwistCommand,
    "geometry_msgs/msg/TwistStamped": StampedTwistCommand,
    "std_msgs/msg/Float64MultiArray": ArrayCommand,
    "trajectory_msgs/msg/JointTrajectory": JointCommand,
}


def commands(data: Any, period: float) -> dict[str, tuple[str, str, MotorCommand]]:
    """Return topic, type and command of each motor, from a setting as plain data.

    Raises:
        WorldError: an entry is not what its type needs, or two motors command one number.
    """
    found: dict[str, tuple[str, str, MotorCommand]] = {}
    taken: dict[tuple[str, str], str] = {}
    types: dict[str, str] = {}
    for name, entry in entries(data, TopicMotor, "motors").items():
        where = f"motors {name}"
        topic, type = require_topic(entry.topic, where), full_name(entry.type, tuple(MOTOR_TYPES), where)
        if types.setdefault(topic, type) != type:
            raise WorldError(f"the topic {topic} has the type {types[topic]} for another motor", where)
        command = MOTOR_TYPES[type](entry, where, period)
        for field in command.fields:
            other = taken.setdefault((topic, field), name)
            if other != name:
                raise WorldError(f"{field} of {topic} is commanded by the motor {other!r}", where)
        found[name] = topic, type, command
    return found
