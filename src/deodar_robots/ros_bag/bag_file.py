"""Bags of ROS 2 (rosbag2): what a bag holds, its messages by time, and writing one."""

from __future__ import annotations

import contextlib
from bisect import bisect_right
from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.codec import JsonObject
from deodar.errors import MissingExtra, WorldError, first_line
from deodar_robots.ros2.message_types import hash_of, store

KEY = "deodar"
"""Name of what deodar adds to the metadata of a bag."""

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


@contextlib.contextmanager
def opened(path: Path) -> Generator[Any]:
    """Open a bag for reading.

    Raises:
        WorldError: it is not a bag, or it is damaged.
    """
    try:
        # an extra
        from rosbags.rosbag2 import Reader
    except ImportError:
        raise MissingExtra("rosbags", "network", "a bag of ROS 2") from None
    if not path.exists():
        raise WorldError("there is no such bag", str(path), "Name the folder that holds metadata.yaml")
    try:
        with Reader(path) as reader:
            yield reader
    except WorldError:
        raise
    except Exception as error:  # damaged files may raise any exception
        raise WorldError(f"cannot be read as a bag: {first_line(error)}", str(path)) from None


def content(path: Path) -> BagContent:
    """Return what a bag holds.

    Raises:
        WorldError: it is not a bag, or holds no message.
    """
    with opened(path) as reader:
        if not reader.message_count:
            raise WorldError("holds no message", str(path))
        topics = {c.topic: BagTopic(c.msgtype, c.digest or "", c.msgcount) for c in reader.connections}
        custom = getattr(reader.storage.metadata, "custom", None) or {}
        start, end = int(reader.start_time), int(reader.end_time) - 1
    added = codec.read(str(custom[KEY]).encode()) if KEY in custom else {}
    return BagContent(dict(sorted(topics.items())), start, end, added if isinstance(added, dict) else {})


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
        times: list[int] = []
        raws: list[bytes] = []
        held, last = 0, True
        with opened(self._path) as reader:
            chosen = [c for c in reader.connections if c.topic == self._topic]
            for _, time, raw in reader.messages(chosen, start=self._starts[number]):
                if (len(times) >= MOST_MESSAGES or held > MOST_HELD) and times[-1] > times[0]:
                    last = False
                    break
                times.append(int(time))
                raws.append(bytes(raw))
                held += len(raw)
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
