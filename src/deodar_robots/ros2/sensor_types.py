"""Types of messages that sensors read: arrays, distances, states of a robot, and pictures."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from deodar.errors import WorldError
from deodar.guarded.guarded_file import GuardedFile
from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal
from deodar.worlds._image import PICTURE, sampled
from deodar_robots.ros2 import compressed
from deodar_robots.ros2.message_types import MOST_BYTES, Unreadable, full_name
from deodar_robots.ros2.reading import Decode, Reading, TopicSensor, chosen_fields, entries, finite
from deodar_robots.ros2.wire import require_topic


class ArrayReading(Reading):
    """The numbers of a std_msgs/Float32MultiArray or Float64MultiArray, in C order of `shape`."""

    settings = ("shape",)

    def declared(self) -> Signal:
        if self.entry.shape is None:
            fix = 'State it: "shape": [50, 50]'
            raise WorldError(f"a {self.entry.type} needs its shape", self.where, fix)
        return Signal(f"numbers of {self.entry.topic}", tuple(self.entry.shape), "", self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        shape = self.signal.shape or ()
        begin = message.layout.data_offset
        values = np.asarray(message.data)[begin:]
        if len(values) != math.prod(shape):
            raise Unreadable(f"it has {len(values)} numbers, not {math.prod(shape)}")
        if not np.isfinite(values).all():
            raise Unreadable("its numbers are not finite")
        return values.reshape(shape)


class ScanReading(Reading):
    """The ranges (m) or intensities of a sensor_msgs/LaserScan, from `angle_min` on, counter-clockwise.

    A beam without an echo (infinite) has the distance `range_max`, one with an echo that is too near (minus
    infinity) `range_min`. Any other distance outside of both is not defined.
    """

    settings = ("shape", "fields", "undefined")

    def declared(self) -> Signal:
        shape = self.shape_of(1, "[360]")
        self.field = self.choice(("ranges", "intensities"))
        unit = "m" if self.field == "ranges" else ""
        return Signal(f"{self.field} of {self.entry.topic} by angle", shape, unit, self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        values = getattr(message, self.field)
        if values.shape != self.signal.shape:
            raise Unreadable(
                f"it has {len(values)} {self.field}, not {self.entry.shape[0]}",  # type: ignore[index]
                f'State their number: "shape": [{len(values)}]',
            )
        if self.field == "intensities":
            return finite(values, self.field)
        return defined(values, message.range_min, message.range_max, self.entry.undefined)


class RangeReading(Reading):
    """The distance (m) of a sensor_msgs/Range; infinite distances as in a LaserScan."""

    settings = ("undefined",)

    def declared(self) -> Signal:
        return Signal(f"distance of {self.entry.topic}", (), "m", self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        given = np.asarray(message.range, np.float32)
        return defined(given, message.min_range, message.max_range, self.entry.undefined)


def defined(values: np.ndarray, nearest: float, farthest: float, undefined: float | None) -> np.ndarray:
    """Return distances without infinite ones.

    Args:
        values: distances, m.
        nearest: smallest distance that the sensor measures, m.
        farthest: largest one, m.
        undefined: number in place of what is not defined; None: there has to be none.

    Raises:
        Unreadable: a distance is not defined, or the limits are not in order.
    """
    low, high = np.float32(nearest), np.float32(farthest)
    if not 0 <= low <= high < np.inf:
        raise Unreadable(f"its distances are between {low:g} and {high:g} m")
    found = np.array(values, np.float32)
    found[values == np.inf], found[values == -np.inf] = high, low
    strange = ~((found >= low) & (found <= high))
    if strange.any():
        if undefined is None:
            what = f"{int(strange.sum())} of its distances are undefined, or outside of {low:g} to {high:g} m"
            raise Unreadable(what, f'State a distance in their place: "undefined": {high:g}')
        found[strange] = undefined
    return found


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


COLOURS = {
    "rgb8": (3, (0, 1, 2)),
    "bgr8": (3, (2, 1, 0)),
    "mono8": (1, (0, 0, 0)),
    "rgba8": (4, (0, 1, 2)),
    "bgra8": (4, (2, 1, 0)),
}
"""Bytes of a pixel, and the places of red, green and blue among them."""

DEPTHS = {"32FC1": (np.dtype(np.float32), 1.0), "16UC1": (np.dtype(np.uint16), 0.001)}
"""Type of a depth, and its unit in m."""

PICTURE_MEMORY = 2**29
"""Bytes that a child may take for a picture of MOST_BYTES, which it holds several times."""

PICTURE_SECONDS = 20.0
"""Longest time for a picture, s, with the start of the child."""


class PictureReading(Reading):
    """The colours of a sensor_msgs/Image, 0 to 1, or with `fields` "depth" its depths in m.

    Colours are means over the pixels of each sample of the axes, as of all pictures. Depths are over columns
    from the left and rows from the top, means over the pixels of each cell of `shape`.
    """

    settings = ("shape", "fields", "undefined")

    def declared(self) -> Signal:
        self.field = self.choice(("colour", "depth"))
        if self.field == "depth":
            shape = self.shape_of(2, "[64, 48]")
            return Signal(f"depth in {self.entry.topic} over columns and rows", shape, "m", self.entry.period)
        if self.entry.shape is not None or self.entry.undefined is not None:
            raise WorldError("colours have no shape, and none is undefined", self.where)
        return Signal(PICTURE.meaning, None, period=self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        known = DEPTHS if self.field == "depth" else COLOURS
        if message.encoding not in known:
            fix = f"The field {self.field} has the encodings {', '.join(known)}"
            raise Unreadable(f"its encoding is {message.encoding!r}", fix)
        return self._depths(message) if self.field == "depth" else colours(message)

    def sampled(self, taken: np.ndarray, axes: Axes, sensor: str) -> np.ndarray:
        return sampled(taken, axes, sensor) if self.field == "colour" else taken

    def _depths(self, message: Any) -> np.ndarray:
        dtype, unit = DEPTHS[message.encoding]
        order = dtype.newbyteorder(">" if message.is_bigendian else "<")
        depths = rows(message, dtype.itemsize).view(order)
        across, down = self.signal.shape or (1, 1)
        if message.width % across or message.height % down:
            what = f"it has {message.width} x {message.height} pixels, no multiple of {across} x {down}"
            raise Unreadable(what, f'State their number or a part of it: "shape": [{message.width}, ...]')
        found = depths.astype(np.float32) * np.float32(unit)
        strange = ~(np.isfinite(found) & (found > 0))
        if strange.any():
            if self.entry.undefined is None:
                what = f"{int(strange.sum())} of its depths are undefined"
                raise Unreadable(what, 'State a depth in their place, in m: "undefined": 10')
            found[strange] = self.entry.undefined
        cells = found.reshape(down, message.height // down, across, message.width // across)
        return np.ascontiguousarray(finite(cells.mean((1, 3), float).T, "mean depth"))


class CompressedReading(Reading):
    """The colours of a sensor_msgs/CompressedImage, a JPEG or PNG file, which a child process reads."""

    def declared(self) -> Signal:
        return Signal(PICTURE.meaning, None, period=self.entry.period)

    def take(self, message: Any) -> Decode:
        return functools.partial(self._decoded, message.data, message.format)

    def _decoded(self, content: np.ndarray, form: str) -> np.ndarray:
        guard = GuardedFile(WorldError, self.entry.topic, PICTURE_MEMORY, PICTURE_SECONDS)
        try:
            return guard.call(compressed.pixels_of, content.tobytes(), MOST_BYTES)
        except WorldError as error:
            problem = error.problems[0]
            raise Unreadable(f"its picture {problem.what}; it says {form!r}") from None

    def sampled(self, taken: np.ndarray, axes: Axes, sensor: str) -> np.ndarray:
        return sampled(taken, axes, sensor)


def colours(message: Any) -> np.ndarray:
    """Return the picture (height, width, 3) of an Image of colours, as bytes."""
    size, places = COLOURS[message.encoding]
    pixels = rows(message, size).reshape(message.height, message.width, size)
    return pixels if pixels.shape[2] == 3 and places == (0, 1, 2) else pixels[:, :, list(places)]


def rows(message: Any, size: int) -> np.ndarray:
    """Return the rows of an Image, without what follows the last pixel of each; `size` bytes are a pixel.

    Raises:
        Unreadable: the rows are shorter than the width, or the data does not fill them.
    """
    wide = message.width * size
    if not message.width or not message.height or message.step < wide:
        raise Unreadable(f"it has {message.width} x {message.height} pixels in rows of {message.step} bytes")
    if len(message.data) != message.step * message.height:
        raise Unreadable(f"it has {len(message.data)} bytes, not {message.height} rows of {message.step}")
    lines = np.asarray(message.data, np.uint8).reshape(message.height, message.step)
    return np.ascontiguousarray(lines[:, :wide])


SENSOR_TYPES: Mapping[str, type[Reading]] = {
    "nav_msgs/msg/Odometry": OdometryReading,
    "sensor_msgs/msg/CompressedImage": CompressedReading,
    "sensor_msgs/msg/Image": PictureReading,
    "sensor_msgs/msg/Imu": ImuReading,
    "sensor_msgs/msg/JointState": JointReading,
    "sensor_msgs/msg/LaserScan": ScanReading,
    "sensor_msgs/msg/Range": RangeReading,
    "std_msgs/msg/Float32MultiArray": ArrayReading,
    "std_msgs/msg/Float64MultiArray": ArrayReading,
}


def readings(data: Any) -> dict[str, tuple[str, str, Reading]]:
    """Return topic, type and reading of each sensor, from a setting as plain data.

    Raises:
        WorldError: an entry is not what its type needs.
    """
    found: dict[str, tuple[str, str, Reading]] = {}
    for name, entry in entries(data, TopicSensor, "sensors").items():
        where = f"sensors {name}"
        topic, type = require_topic(entry.topic, where), full_name(entry.type, tuple(SENSOR_TYPES), where)
        found[name] = topic, type, SENSOR_TYPES[type](entry, where)
    return found
