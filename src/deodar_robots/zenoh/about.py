"""What travels between a robot and its model: messages, and what a robot says of itself."""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, cast
from urllib.parse import quote

import numpy as np

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import DeodarError, WorldError, did_you_mean
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import is_text, real, show
from deodar.worlds._base import Signal, World
from deodar.worlds._motor_rule import MotorRule

HEADER = struct.Struct("<4sBBHQdQQQ")
"""Magic, type of the numbers, dimensions, parts, sequence, time of the plant, stamp, the stamp that it
answers, number of the commander.
"""

MAGIC = b"DDR1"
TYPES: dict[int, np.dtype[np.generic]] = {
    code: np.dtype(name)
    for code, name in enumerate(("<f4", "<f8", "|u1", "<u2", "<i4", "<i8", "<u4", "<u8", "|i1", "<i2", "|b1"))
}
CODES = {dtype: code for code, dtype in TYPES.items()}
MOST_DIMENSIONS = 8
MOST_BYTES = 2**26
"""Largest array in bytes: a picture of 2900 x 2900 samples of three colours in float32 still fits."""


class BadMessage(ValueError):
    """Raised for bytes that are not a message: short, long, foreign, or too large."""


@dataclass(frozen=True)
class WireMessage:
    """One array on its way, with its place in the sequence and its times.

    Attributes:
        array: the numbers, little-endian, in C order; of a type in `TYPES`.
        sequence: number of the period; it grows by one from period to period.
        time: time of the plant, ms.
        stamp: monotonic clock of the sender when it was sent, ns.
        answers: stamp of the newest message from the other side, ns of the clock of the other side; 0: none.
        commander: number that the robot gave to the sender of a command; 0: none.
        parts: number of messages that belong to the period.
    """

    array: np.ndarray
    sequence: int = 0
    time: float = 0.0
    stamp: int = 0
    answers: int = 0
    commander: int = 0
    parts: int = 1

    def to_bytes(self) -> bytes:
        """Return the message as bytes.

        Raises:
            BadMessage: the numbers have a type that no message carries, or there are too many.
        """
        array = np.asarray(self.array)
        array = np.ascontiguousarray(array, array.dtype.newbyteorder("<")).reshape(array.shape)
        code = CODES.get(array.dtype)
        if code is None:
            raise BadMessage(f"an array of {array.dtype} has no form in a message")
        if array.ndim > MOST_DIMENSIONS or array.nbytes > MOST_BYTES:
            raise BadMessage(f"an array of shape {list(array.shape)} is too large for a message")
        times = self.sequence, self.time, self.stamp, self.answers, self.commander
        header = HEADER.pack(MAGIC, code, array.ndim, self.parts, *times)
        shape = struct.pack(f"<{array.ndim}I", *array.shape)
        return b"".join((header, shape, array.reshape(-1).view(np.uint8).data))  # one copy of the numbers

    @classmethod
    def from_bytes(cls, raw: bytes) -> WireMessage:
        """Read a message; its length is checked before any number is read.

        The array is a read-only view of the bytes. Its numbers may be infinite or undefined (`finite`).

        Raises:
            BadMessage: the bytes are not a message.
        """
        if len(raw) < HEADER.size:
            raise BadMessage(f"is {len(raw)} bytes long, shorter than a header")
        magic, code, dimensions, parts, sequence, time, stamp, answers, commander = HEADER.unpack_from(raw)
        if magic != MAGIC or code not in TYPES or dimensions > MOST_DIMENSIONS or not math.isfinite(time):
            raise BadMessage("has another header")
        start = HEADER.size + 4 * dimensions
        if len(raw) < start:
            raise BadMessage("ends inside its shape")
        shape = struct.unpack_from(f"<{dimensions}I", raw, HEADER.size)
        size = math.prod(shape) * TYPES[code].itemsize
        # NumPy refuses a large shape without numbers, such as 0 x 2^32 x 2^32
        largest = math.prod(max(n, 1) for n in shape) * TYPES[code].itemsize
        if largest > MOST_BYTES or len(raw) - start != size:
            raise BadMessage(f"has {len(raw) - start} bytes for the shape {list(shape)}")
        array = np.frombuffer(raw, TYPES[code], offset=start).reshape(shape)
        return cls(array, sequence, time, stamp, answers, commander, parts)

    @property
    def finite(self) -> bool:
        """Whether all numbers of the array are finite."""
        return self.array.dtype.kind != "f" or bool(np.isfinite(self.array).all())


def bundle(messages: Sequence[WireMessage]) -> bytes:
    """Return several messages as one, each after its length."""
    raws = [message.to_bytes() for message in messages]
    return b"".join(part for raw in raws for part in (struct.pack("<I", len(raw)), raw))


def unbundle(raw: bytes) -> list[WireMessage]:
    """Read the messages of a bundle.

    Raises:
        BadMessage: the bytes are not a bundle of messages.
    """
    messages: list[WireMessage] = []
    start = 0
    while start < len(raw):
        if len(raw) - start < 4:
            raise BadMessage("ends inside a length")
        (length,) = struct.unpack_from("<I", raw, start)
        messages.append(WireMessage.from_bytes(raw[start + 4 : start + 4 + length]))
        start += 4 + length
    return messages


RobotClock = Literal["step", "live"]
CLOCKS: tuple[RobotClock, ...] = ("step", "live")
VERSION = 1
OLDER = b"older"
"""Asks for the state of a robot in the form of older versions."""

MOST_TEXT = 2**20
"""Longest text about a robot, in characters."""

Requests = Sequence[tuple[str, Axes]]
"""Sensors that are read, each over the axes that the model states."""


@dataclass(frozen=True)
class About:
    """Description of a robot on the network.

    Attributes:
        name: name of the robot, the first part of all its keys.
        clock: step, where the robot waits for the command of each period, or live, where it does not wait.
        period: ms between two exchanges; None: it never changes.
        sensors, motors: signals by name.
        rules: rules of motors by name; a motor without one allows any command.
        repeatable: whether a restored state leads to the same readings again.
        reads: whether the robot answers `begin` and `read`, so that sensors can be read over any axes; a
            robot without deodar does not.
        of: description of the world that is served.
    """

    name: str
    clock: RobotClock
    period: float | None
    sensors: Mapping[str, Signal]
    motors: Mapping[str, Signal]
    rules: Mapping[str, MotorRule] = field(default_factory=dict[str, MotorRule])
    repeatable: bool = False
    reads: bool = False
    of: Mapping[str, Json] = field(default_factory=dict[str, Json])

    def rule(self, motor: str) -> MotorRule:
        """Return the rule of a motor."""
        return self.rules.get(motor, MotorRule())

    @classmethod
    def of_world(cls, world: World, name: str, clock: RobotClock) -> About:
        """Return the description of a world that is served under a name."""
        repeatable = clock == "step" and world.repeatable
        signals = dict(world.sensors), dict(world.motors)
        return cls(name, clock, world.period, *signals, dict(world.rules), repeatable, True, world.describe())

    def to_text(self) -> str:
        """Return the description as JSON."""
        motors = {name: _signal(signal) | self.rule(name).to_data() for name, signal in self.motors.items()}
        description: JsonObject = {
            "robot": VERSION,
            "name": self.name,
            "kind": "zenoh",
            "clock": self.clock,
            "period": self.period,
            "repeatable": self.repeatable,
            "reads": self.reads,
            "sensors": {name: _signal(signal) for name, signal in self.sensors.items()},
            "motors": motors,
            "of": dict(self.of),
        }
        return codec.line(description)

    @classmethod
    def from_text(cls, content: bytes) -> About:
        """Read a description.

        Raises:
            WorldError: the text does not describe a robot.
        """
        if len(content) > MOST_TEXT:
            raise WorldError(
                f"a robot describes itself in {len(content)} bytes; at most {MOST_TEXT} are read"
            )
        try:
            parsed = codec.read(content)
        except DeodarError as error:
            raise WorldError(f"what a robot says of itself {error.problems[0].what}") from None
        if not isinstance(parsed, dict) or parsed.get("robot") != VERSION:
            raise WorldError(f"what a robot says of itself is not version {VERSION} of a robot")
        description = cast("dict[str, Any]", parsed)
        name, clock, period = (
            description.get("name"),
            description.get("clock", "live"),
            description.get("period"),
        )
        if not isinstance(name, str) or not name or not is_text(name):
            raise WorldError(f"the name of a robot is {show(name)}; expected text")
        if clock not in CLOCKS:
            raise WorldError(f"the clock is {show(clock)}; expected step or live", where=name)
        step = None if period is None else real(period)
        if period is not None and (step is None or not 0 < step < math.inf):
            raise WorldError(f"the period is {show(period)}; expected ms above 0", where=name)
        if clock == "step" and description.get("reads") is not True:
            raise WorldError("a robot with the clock step has to answer `begin` and `read`", where=name)
        sensors, motors = (
            _signals(description.get(kind), f"{name} {kind}") for kind in ("sensors", "motors")
        )
        entries = cast("dict[str, dict[str, Any]]", description.get("motors") or {})
        rules = {motor: MotorRule.from_data(entries[motor], f"{name} {motor}") for motor in motors}
        flags = description.get("repeatable") is True, description.get("reads") is True
        of = description.get("of")
        return cls(name, clock, step, sensors, motors, rules, *flags, of if isinstance(of, dict) else {})


def key(robot: str, *parts: str) -> str:
    """Return the key of a robot and of what belongs to it; names may have any characters."""
    return "/".join([quote(robot, safe=""), *(quote(part, safe="") for part in parts)])


def reading_keys(robot: str, requests: Requests) -> list[str]:
    """Return the key of each reading: that of the sensor, with a number from its second reading on."""
    seen: dict[str, int] = {}
    keys: list[str] = []
    for sensor, _ in requests:
        count = seen[sensor] = seen.get(sensor, -1) + 1
        keys.append(key(robot, "sensor", sensor, *([str(count)] if count else [])))
    return keys


def requests_to_data(requests: Requests) -> list[Json]:
    """Return requests as plain data."""
    return [
        [sensor, [[a.name, a.lower, a.upper, a.samples, a.periodic, a.unit] for a in axes]]
        for sensor, axes in requests
    ]


def requests_from_data(data: Any, sensors: Mapping[str, Signal]) -> list[tuple[str, Axes]]:
    """Read requests.

    Raises:
        WorldError: they are not requests, or the robot has no such sensor.
    """
    requests: list[tuple[str, Axes]] = []
    try:
        for sensor, axes in data:
            if sensor not in sensors:
                raise WorldError(f"there is no sensor {show(sensor)}", fix=did_you_mean(str(sensor), sensors))
            requests.append((sensor, tuple(Axis(*values) for values in axes)))
    except (TypeError, ValueError):
        raise WorldError("is not a list of sensors and their axes") from None
    return requests


def _signal(signal: Signal) -> JsonObject:
    description: JsonObject = {"meaning": signal.meaning, "unit": signal.unit}
    description["shape"] = None if signal.shape is None else list(signal.shape)
    if signal.period is not None:
        description["period"] = signal.period
    if signal.each:
        description["each"] = True
    if signal.bounds is not None:
        description["bounds"] = [list(pair) for pair in signal.bounds]
    return description


def _signals(signals: Any, where: str) -> dict[str, Signal]:
    if not isinstance(signals or {}, dict):
        raise WorldError(f"is {show(signals)}; expected signals by name", where=where)
    entries = cast("dict[str, Any]", signals or {})
    return {name: _read_signal(name, entry, where) for name, entry in entries.items()}


def _read_signal(name: str, entry: Any, where: str) -> Signal:
    place = f"{where}.{name}"
    if not isinstance(entry, dict):
        raise WorldError(f"is {show(entry)}; expected the description of a signal", where=place)
    description = cast("dict[str, Any]", entry)
    shape, period, bounds = description.get("shape"), description.get("period"), description.get("bounds")
    sizes = _sizes(shape, place)
    step = None if period is None else real(period)
    if period is not None and (step is None or not 0 < step < math.inf):
        raise WorldError(f"period is {show(period)}; expected ms above 0", where=place)
    pairs = _pairs(bounds, place)
    words = [description.get(label, "") for label in ("meaning", "unit")]
    if not all(isinstance(word, str) and is_text(word) for word in words):
        raise WorldError("its meaning and unit are text", where=place)
    return Signal(words[0], sizes, words[1], step, description.get("each") is True, pairs)


def _sizes(shape: Any, place: str) -> tuple[int, ...] | None:
    if shape is None:
        return None
    sizes: Any = shape if isinstance(shape, list) else [None]
    if not (all(type(n) is int and 0 < n <= 10**6 for n in sizes) and len(sizes) < 8):
        raise WorldError(f"shape is {show(shape)}; expected numbers of samples, or null", where=place)
    return tuple(sizes)


def _pairs(bounds: Any, place: str) -> tuple[tuple[float, float], ...] | None:
    if bounds is None:
        return None
    try:
        return tuple((float(low), float(high)) for low, high in bounds)
    except (TypeError, ValueError):
        raise WorldError(f"bounds is {show(bounds)}; expected pairs of numbers", where=place) from None
