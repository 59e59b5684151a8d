"""A bag of ROS 2 as a world."""

from __future__ import annotations

import atexit
import hashlib
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import WorldError, did_you_mean
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._base import Signal, World
from deodar.worlds._settings import number, parse_argument
from deodar_robots.ros2.example_node import scan
from deodar_robots.ros2.message_types import Unreadable, from_bytes, hash_of
from deodar_robots.ros2.motor_types import commands
from deodar_robots.ros2.sensor_types import SENSOR_TYPES, readings
from deodar_robots.ros_bag.bag_file import BagContent, BagMessages, content, write_bag

PERIOD = 50.0
"""Period of a bag that does not state one, ms."""

NEAR = 1e-6


@register
class ROSBag(World):
    r"""A bag of ROS 2 (rosbag2, with files of SQLite or MCAP), replayed: open loop, repeatable.

    Each sensor shows the newest message of a topic at the time of the model, which begins with the first
    message of the bag; before its first message a sensor shows that. A message that cannot be read ends the
    run with an error that names topic and time. Nothing is sent, and no ROS is installed; the extra is
    `network`.

    Without `sensors`, each topic of a known type is a sensor with the name of the topic, and its shape is
    that of the first message. In a bag that deodar wrote, sensors have the names that they had.

    Equation:
        y(t) = \mathrm{message}(t_k),\quad t_k \le t < t_{k+1}

    Parameters:
        file: path of the folder that holds metadata.yaml, or of its .db3 or .mcap file.
        sensors: for each sensor its topic, type and settings, as of `ROS2`; None: all topics.
        motors: for each motor its topic, type and settings, as of `ROS2`; they are accepted and have no
            effect. None: those of the record in a bag that deodar wrote.
        period: ms between two readings; a whole number of steps of the model. None: that of the record in a
            bag that deodar wrote, else 50 ms.

    Shapes:
        Those of the messages, as of `ROS2`. All copies of a model read the same bag.

    Reference:
        Macenski, Foote, Gerkey, Lalancette & Woodall (2022), Robot Operating System 2, Science Robotics 7,
        eabm6074.
    """

    opens = (".db3", ".mcap")
    stands_in = False

    def __init__(
        self,
        file: str | Path,
        sensors: Mapping[str, Any] | None = None,
        motors: Mapping[str, Any] | None = None,
        period: float | None = None,
    ) -> None:
        if not isinstance(file, (str, Path)):
            raise WorldError(f"file is {show(file)}; expected the path of a bag")
        self.name, self._path = str(file), Path(file)
        self.content = content(self._path)
        added = self.content.added
        origin = added.get("origin")
        self._origin: int = origin if isinstance(origin, int) else self.content.start
        stated = added.get("period") if period is None else period
        self.period = self._step = number("period", PERIOD if stated is None else stated, above=0.0)
        given = _all_sensors(self.content, self._path) if sensors is None else dict(sensors)
        self._settings: JsonObject = codec.parse(codec.line(given))
        self._readings = readings(self._settings)
        for name, (topic, type, _) in self._readings.items():
            self._require(f"sensors {name}", topic, type)
        self.sensors = {name: reading.signal for name, (_, _, reading) in self._readings.items()}
        topics = {topic for topic, _, _ in self._readings.values()}
        self._messages = {topic: BagMessages(self._path, topic, self.content.start) for topic in topics}
        self._newest: dict[str, tuple[int, np.ndarray]] = {}
        shapes: Mapping[str, tuple[int, ...] | None]
        self._moved: Json = None if motors is None else codec.parse(codec.line(dict(motors)))
        if motors is None:
            names = added.get("motors")
            shapes = dict.fromkeys(map(str, names if isinstance(names, list) else ()), None)
        else:
            moved = commands(self._moved, self._step)
            shapes = {name: motor.signal.shape for name, (_, _, motor) in moved.items()}
        self.motors = {name: Signal("accepted, without effect", shape) for name, shape in shapes.items()}

    def _require(self, where: str, topic: str, type: str) -> None:
        """Raise WorldError if a topic of the bag does not have a type."""
        found = self.content.topics.get(topic)
        if found is None or not found.count:
            fix = did_you_mean(topic, self.content.topics)
            raise WorldError(f"the bag {self.name} has no message on {topic}", where, fix)
        if found.type != type:
            short = found.type.replace("/msg/", "/")
            raise WorldError(
                f"{topic} has the type {found.type} in the bag {self.name}, not {type}",
                where,
                f'State it: "type": "{short}"',
            )
        if found.hash and found.hash != hash_of(type):
            raise WorldError(f"{topic} has another version of {type} than that of ROS 2 Jazzy", where)

    @property
    def duration(self) -> float:
        """Time of the last message, ms."""
        return (self.content.end - self._origin) / 1e6

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        if time >= self.duration + self._step * (1 - NEAR):
            raise WorldError(f"ends at {self.duration:g} ms, and the run continues to {time:g} ms", self.name)
        topic, type, reading = self._readings[sensor]
        stamp, raw = self._messages[topic].at(self._origin + round(1e6 * time))
        newest = self._newest.get(sensor)
        if newest is None or newest[0] != stamp:
            try:
                newest = self._newest[sensor] = stamp, reading.read(from_bytes(raw, type))
            except Unreadable as error:
                moment = (stamp - self._origin) / 1e6
                text = f"the message of {topic} at {moment:g} ms is refused: {error}"
                raise WorldError(text, self.name, error.fix) from None
        return reading.sampled(newest[1], axes, sensor)

    def describe(self) -> dict[str, Json]:
        said: JsonObject = {"world": "ROSBag", "file": self.name, "period": self._step}
        topics = {topic: [t.type, t.count] for topic, t in self.content.topics.items()}
        text = codec.line([topics, self.content.start, self.content.end], ascii=True)
        said |= {"sensors": self._settings, "motors": self._moved}
        return {**said, "sha256": hashlib.sha256(text.encode()).hexdigest()}

    @classmethod
    def open(cls, argument: str) -> ROSBag:
        """Make the world of a text such as `lab-bag, period=20`."""
        file, settings = parse_argument(cls, argument)
        return cls(file, **settings)

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> ROSBag:
        given: Any = described
        return cls(given["file"], given["sensors"], given["motors"], given["period"])

    @classmethod
    def example(cls) -> ROSBag:
        """Return a bag with a scan of eight beams every 50 ms for 20 s."""
        folder = Path(tempfile.mkdtemp(prefix="deodar-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        near = np.linspace(0.5, 4.0, 8)
        messages = (("/scan", 50_000_000 * k, scan(np.roll(near, k))) for k in range(400))
        write_bag(folder, {"/scan": "sensor_msgs/msg/LaserScan"}, messages, {})
        return cls(folder)

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return (Axis("beam", 0, 7, 8),)


def _all_sensors(found: BagContent, path: Path) -> dict[str, Json]:
    """Return a setting for each topic whose messages a sensor can read."""
    stated = found.added.get("sensors")
    if isinstance(stated, dict):
        return dict(stated)
    sensors: dict[str, Json] = {}
    for topic, about in found.topics.items():
        if about.type in SENSOR_TYPES and about.count:
            entry: JsonObject = {"topic": topic, "type": about.type}
            shape = _shape(path, topic, about.type, found.start)
            sensors[topic.strip("/")] = entry if shape is None else {**entry, "shape": list(shape)}
    if not sensors:
        known = ", ".join(f"{topic} ({about.type})" for topic, about in found.topics.items())
        raise WorldError("has no topic that a sensor reads", str(path), f"Its topics: {known}")
    return sensors


def _shape(path: Path, topic: str, type: str, start: int) -> tuple[int, ...] | None:
    """Return the shape of the first message, where its type leaves it open."""
    lengths = {"LaserScan": "ranges", "JointState": "position"}
    short = type.rpartition("/")[2]
    if short not in lengths and not short.endswith("MultiArray"):
        return None
    try:
        message = from_bytes(BagMessages(path, topic, start).at(start)[1], type)
    except Unreadable as error:
        raise WorldError(f"the first message of {topic} is refused: {error}", str(path), error.fix) from None
    if short in lengths:
        return (len(getattr(message, lengths[short])),)
    return tuple(int(each.size) for each in message.layout.dim) or (len(message.data),)
