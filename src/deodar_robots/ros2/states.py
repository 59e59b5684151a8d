"""Vectors of numbers: the message types JointState, Odometry and Imu."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from deodar.errors import WorldError
from deodar.worlds._base import Signal
from deodar_robots.ros2.message_types import Unreadable
from deodar_robots.ros2.reading import Reading, chosen_fields, finite

JOINT_UNITS = {"position": "rad", "velocity": "rad/s", "effort": "N m"}
"""Fields of a JointState; of a joint that slides the units are m, m/s and N."""


class JointReading(Reading):
    """The positions, velocities or efforts of a sensor_msgs/JointState, in the order of `joints`.

    Without `joints` they have the order of the message, and their number is stated by `shape`.
    """

    settings = ("shape", "fields", "joints")

    def declared(self) -> Signal:
        names = self.entry.joints
        if names is not None and (not names or len(set(names)) < len(names)):
            raise WorldError("names no joint, or one twice", self.where)
        if names is not None and self.entry.shape not in (None, [len(names)]):
            raise WorldError(f"{self.entry.shape} is not the number of its {len(names)} joints", self.where)
        self.field = self.choice(tuple(JOINT_UNITS))
        shape = self.shape_of(1, "[7]") if names is None else (len(names),)
        meaning = f"{self.field} of the joints of {self.entry.topic}"
        return Signal(meaning, shape, JOINT_UNITS[self.field], self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        values, names = getattr(message, self.field), list(message.name)
        if self.entry.joints is not None:
            missing = [name for name in self.entry.joints if name not in names]
            if missing:
                shown = ", ".join(names[:8])
                raise Unreadable(f"it has no joint {missing[0]!r}", f"Its joints: {shown}")
            if len(values) != len(names):
                raise Unreadable(f"it has {len(names)} joints and {len(values)} of {self.field}")
            values = values[[names.index(name) for name in self.entry.joints]]
        if values.shape != self.signal.shape:
            raise Unreadable(f"it has {len(values)} of {self.field}, not {self.signal.shape[0]}")  # type: ignore[index]
        return finite(values, self.field)


class VectorReading(Reading):
    """Chosen fields of a message, as a vector."""

    settings = ("fields",)
    known: ClassVar[Mapping[str, tuple[str, Callable[[Any], float]]]]
    """Unit and value of each field by name."""
    default: ClassVar[Sequence[str]]

    def declared(self) -> Signal:
        units = {name: unit for name, (unit, _) in self.known.items()}
        self.names, shape, unit = chosen_fields(self.entry.fields, self.default, units, self.where)
        meaning = f"{', '.join(self.names)} of {self.entry.topic}"
        return Signal(meaning, shape, unit, self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        values = [self.known[name][1](message) for name in self.names]
        return finite(values, "state").reshape(self.signal.shape or ())


class OdometryReading(VectorReading):
    """Fields of a nav_msgs/Odometry: by default x and y (m) and yaw (rad), in the frame of its header."""

    default = ("x", "y", "yaw")
    known = {
        "x": ("m", lambda m: m.pose.pose.position.x),
        "y": ("m", lambda m: m.pose.pose.position.y),
        "z": ("m", lambda m: m.pose.pose.position.z),
        "roll": ("rad", lambda m: angles(m.pose.pose.orientation)[0]),
        "pitch": ("rad", lambda m: angles(m.pose.pose.orientation)[1]),
        "yaw": ("rad", lambda m: angles(m.pose.pose.orientation)[2]),
        "linear.x": ("m/s", lambda m: m.twist.twist.linear.x),
        "linear.y": ("m/s", lambda m: m.twist.twist.linear.y),
        "linear.z": ("m/s", lambda m: m.twist.twist.linear.z),
        "angular.x": ("rad/s", lambda m: m.twist.twist.angular.x),
        "angular.y": ("rad/s", lambda m: m.twist.twist.angular.y),
        "angular.z": ("rad/s", lambda m: m.twist.twist.angular.z),
    }


class ImuReading(VectorReading):
    """Fields of a sensor_msgs/Imu: by default angular velocities (rad/s), then accelerations (m/s^2)."""

    default = ("angular.x", "angular.y", "angular.z", "linear.x", "linear.y", "linear.z")
    known = {
        "angular.x": ("rad/s", lambda m: m.angular_velocity.x),
        "angular.y": ("rad/s", lambda m: m.angular_velocity.y),
        "angular.z": ("rad/s", lambda m: m.angular_velocity.z),
        "linear.x": ("m/s^2", lambda m: m.linear_acceleration.x),
        "linear.y": ("m/s^2", lambda m: m.linear_acceleration.y),
        "linear.z": ("m/s^2", lambda m: m.linear_acceleration.z),
        "roll": ("rad", lambda m: angles(m.orientation)[0]),
        "pitch": ("rad", lambda m: angles(m.orientation)[1]),
        "yaw": ("rad", lambda m: angles(m.orientation)[2]),
    }


def angles(quaternion: Any) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of a rotation (rad): about x, then y, then z, of fixed axes.

    Raises:
        Unreadable: the quaternion has not the length 1.
    """
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if not abs(length - 1) < 0.01:
        raise Unreadable(f"its orientation has the length {length:g}, not 1")
    x, y, z, w = (part / length for part in (x, y, z, w))
    return (
        math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x)))),
        math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    )
