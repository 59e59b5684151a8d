"""Bags of ROS 2 as files: reading them, and writing messages and records."""

from __future__ import annotations

import heapq
import os
import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar import codec
from deodar.codec import JsonObject
from deodar.errors import Fix, RecordError, WorldError
from deodar.guarded.guarded_file import GuardedFile
from deodar.model.unit import unit_seconds
from deodar.recording import places
from deodar.recording.record import time_dimension
from deodar_robots.ros2.message_types import hash_of, make, store, to_bytes
from deodar_robots.ros_bag.bag_reading import KEY, messages_of, require_package, summary_of

MOST_MESSAGES = 256
MOST_HELD = 2**25
"""Number and bytes of the messages of a topic that are held at a time."""

VERSION = 9
"""Version of the metadata that is written, that of ROS 2 Jazzy."""


@dataclass(frozen=True)
class BagTopic:
    """A topic of a bag.

    Attributes:
        type: type of its messages, such as sensor_msgs/msg/LaserScan.
        hash: hash of the type; empty: the bag does not state it.
        count: number of messages.
    """

    type: str
    hash: str
    count: int


@dataclass(frozen=True)
class BagContent:
    """What a bag holds.

    Attributes:
        topics: topics by name.
        start: time of the first message, ns.
        end: time of the last message, ns.
        added: what deodar added to the metadata; empty for a bag of another program.
    """

    topics: Mapping[str, BagTopic]
    start: int
    end: int
    added: JsonObject


def content(path: Path) -> BagContent:
    """Return what a bag holds.

    Raises:
        WorldError: it is not a bag, is damaged, or holds no message.
    """
    require_package()
    if not os.path.exists(path):  # False for a name that is too long
        raise WorldError("there is no such bag", str(path), "Name the folder that holds metadata.yaml")
    summary = GuardedFile(WorldError, str(path)).call(summary_of, str(path))
    topics = {name: BagTopic(kind, digest, count) for name, kind, digest, count in summary["topics"]}
    added = codec.read(summary["custom"].encode()) if summary["custom"] else {}
    added = added if isinstance(added, dict) else {}
    return BagContent(dict(sorted(topics.items())), summary["start"], summary["end"], added)


class BagMessages:
    """The messages of a topic of a bag by time. Memory is bounded; a bag is open only while it is read.

    Args:
        path: the bag.
        topic: the topic.
        start: time of the first message of the bag, ns.
    """

    def __init__(self, path: Path, topic: str, start: int) -> None:
        self._path, self._topic = path, topic
        self._starts = [start]
        self._held = -1
        self._times: list[int] = []
        self._raws: list[bytes] = []
        self._last = False

    def at(self, moment: int) -> tuple[int, bytes]:
        """Return the time (ns) and the bytes of the newest message at a time; before the first one, of that.

        Raises:
            WorldError: the bag is damaged, or has no message on the topic.
        """
        self._hold(max(0, bisect_right(self._starts, moment) - 1))
        while self._times[-1] <= moment and not self._last:
            if self._held + 1 == len(self._starts):
                self._starts.append(self._times[-1])
            self._hold(self._held + 1)
        k = max(0, bisect_right(self._times, moment) - 1)
        return self._times[k], self._raws[k]

    def _hold(self, number: int) -> None:
        """Read some messages, of at least two times, from the beginning of a batch on."""
        if number == self._held:
            return
        guard = GuardedFile(WorldError, str(self._path))
        limits = MOST_MESSAGES, MOST_HELD
        part = guard.call(messages_of, str(self._path), self._topic, self._starts[number], limits)
        times, raws, last = part["times"], part["raws"], part["last"]
        if not times:
            raise WorldError(f"the topic {self._topic} has no message", str(self._path))
        self._held, self._times, self._raws, self._last = number, times, raws, last


def write_bag(
    folder: Path, types: Mapping[str, str], messages: Iterable[tuple[str, int, bytes]], added: JsonObject
) -> None:
    """Write a bag into an empty folder: metadata.yaml, and a file of SQLite.

    Args:
        folder: the folder.
        types: type of each topic.
        messages: topic, time (ns) and bytes of each message, in the order of time.
        added: what deodar adds to the metadata.
    """
    types_of = store()
    # an extra
    from rosbags.rosbag2 import Writer

    inner = folder / "bag"
    with Writer(inner, version=VERSION) as writer:
        writer.set_custom_data(KEY, codec.line(added, ascii=True))
        known = {
            topic: writer.add_connection(topic, type, typestore=types_of, rihs01=hash_of(type))
            for topic, type in types.items()
        }
        for topic, time, raw in messages:
            writer.write(known[topic], time, raw)
    for file in list(inner.iterdir()):
        file.rename(folder / file.name)
    inner.rmdir()


BLOCK = 2**20
"""Number of values that are read at a time."""

SINGLE, DOUBLE = "std_msgs/msg/Float32MultiArray", "std_msgs/msg/Float64MultiArray"


def save(data: xarray.Dataset, path: str | Path, force: bool = False) -> Path:
    """Write a record as a bag.

    The topic of `eye.output` is /eye/output. Its messages are Float32MultiArray, or Float64MultiArray for all
    types of numbers but float32; their dimensions have the names of the axes. The time of a message is that
    of the sample in ns, so that the world `ROSBag` reads what the record holds, at its times.

    Args:
        data: the record, of one trial; it is read in blocks.
        path: the folder.
        force: whether to replace an existing folder.

    Raises:
        RecordError: a variable has no time or several trials, or its unit of time is not in seconds.
        OutputExists: the folder exists, and `force` is not given.
        OutputError: it cannot be written.
    """
    path = Path(path)
    times = {str(name): _times(str(name), variable) for name, variable in data.data_vars.items()}
    topics = _topics(list(times))
    types = {topics[n]: SINGLE if data[n].dtype == np.float32 else DOUBLE for n in times}
    steps = [int(np.diff(t).min()) for t in times.values() if len(t) > 1]
    elements = _elements(data)
    moved = [str(e.get("motor", "left")) for e in elements.values() if e.get("kind") == "Motor"]
    added: JsonObject = {"record": 1, "origin": 0, "motors": list(moved)}
    added["sensors"] = _sensors(data, elements, topics, types)
    if steps:
        added["period"] = min(steps) / 1e6
    parts = [_messages(data[name], topics[name], times[name]) for name in times]
    places.claim_folder(path, force)
    places.write_folder(
        path, lambda folder: write_bag(folder, types, heapq.merge(*parts, key=lambda m: m[1]), added), force
    )
    return path


def _times(name: str, variable: xarray.DataArray) -> np.ndarray:
    """Return the times of the samples in ns."""
    time = time_dimension(variable)
    if time is None:
        raise RecordError("has no times", where=name, fix="Name the variables that have some")
    lead = list(map(str, variable.dims))[: list(map(str, variable.dims)).index(time)]
    if lead:
        fix = Fix(
            f"Choose one: record.sel({{{lead[0]!r}: ...}})",
            "Choose one: --trial 0" if lead == ["trial"] else "Choose one: --where PATH=VALUE",
        )
        raise RecordError(f"is over {', '.join(lead)}, and a bag holds one run", name, fix)
    unit = str(variable[time].attrs.get("units", "ms"))
    if unit == "abstract":
        raise RecordError(
            "has abstract times, and a bag has nanoseconds", name, Fix("Save it as .csv", "Type: --to csv")
        )
    stamps = np.round(np.asarray(variable[time].values, float) * unit_seconds(unit) * 1e9).astype(np.int64)
    if len(stamps) and stamps[0] < 0:
        raise RecordError("begins before the time 0, and a bag does not", name)
    return stamps


def _topics(names: list[str]) -> dict[str, str]:
    """Return a topic for each variable; two may differ in what no name of a topic holds."""
    found: dict[str, str] = {}
    for name in names:
        parts = [re.sub(r"\W", "_", part, flags=re.ASCII) or "_" for part in re.split(r"[./]", name)]
        parts = [f"_{part}" if part[0].isdigit() else part for part in parts]
        topic, n = "/" + "/".join(parts), 1
        while topic in found.values():
            n += 1
            topic = f"/{'/'.join(parts)}_{n}"
        found[name] = topic
    return found


def _elements(data: xarray.Dataset) -> Mapping[str, Mapping[str, Any]]:
    """Return the elements of the model of a record, by path; none if it does not state them."""
    try:
        return codec.parse(data.attrs["deodar"])["document"]["elements"]
    except (KeyError, TypeError, ValueError):
        return {}


def _sensors(
    data: xarray.Dataset,
    elements: Mapping[str, Mapping[str, Any]],
    topics: Mapping[str, str],
    types: Mapping[str, str],
) -> JsonObject:
    """Return the settings by which `ROSBag` reads the bag; outputs of sensors have the names of these."""
    found: JsonObject = {}
    for name, topic in topics.items():
        element = elements.get(name.removesuffix(".output"), {})
        sensor = str(element.get("sensor", "picture")) if element.get("kind") == "Sensor" else name
        shape = [int(n) for n in data[name].shape[1:]]
        found[name if sensor in found else sensor] = {"topic": topic, "type": types[topic], "shape": shape}
    return found


def _messages(variable: xarray.DataArray, topic: str, times: np.ndarray) -> Iterator[tuple[str, int, bytes]]:
    """Yield topic, time and bytes of each sample."""
    shape = variable.shape[1:]
    size = max(1, int(np.prod(shape)))
    single = variable.dtype == np.float32
    strides = [int(np.prod(shape[k:])) for k in range(len(shape))]
    dims = [
        make("std_msgs/msg/MultiArrayDimension", label=str(d), size=int(n), stride=s)
        for d, n, s in zip(variable.dims[1:], shape, strides, strict=True)
    ]
    layout = make("std_msgs/msg/MultiArrayLayout", dim=dims, data_offset=0)
    rows = max(1, BLOCK // size)
    for start in range(0, len(times), rows):
        block = variable[start : start + rows].values.astype(np.float32 if single else np.float64)
        for time, values in zip(times[start : start + rows], block, strict=True):
            message = make(SINGLE if single else DOUBLE, layout=layout, data=np.ravel(values))
            yield topic, int(time), to_bytes(message)
