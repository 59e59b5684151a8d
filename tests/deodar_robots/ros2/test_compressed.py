"""Compressed pictures of messages: a child decodes them, and no picture ends the run of a model."""

from __future__ import annotations

import contextlib
import io
import os
import struct
import threading
import time
import zlib
from pathlib import Path

import numpy as np
import psutil
import pytest
from PIL import Image

import deodar as dd
from deodar.errors import WorldError
from deodar.guarded.guarded_file import GuardedFile
from deodar_robots.ros2.message_types import Unreadable, header, make, to_bytes
from deodar_robots.ros2.sensor_types import readings
from deodar_robots.ros2.topic_inbox import TopicInbox
from deodar_robots.ros_bag.bag_file import write_bag

TYPE = "sensor_msgs/msg/CompressedImage"
AXES = dd.Axis("x", 0, 3, 4), dd.Axis("y", 0, 2, 3), dd.Axis("channel", 0, 2, 3)


def encoded(color: tuple[int, int, int], kind: str = "PNG", size: tuple[int, int] = (4, 3)) -> bytes:
    file = io.BytesIO()
    Image.new("RGB", size, color).save(file, kind)
    return file.getvalue()


def stating(width: int, height: int) -> bytes:
    """Return a PNG of a few bytes that states a number of pixels."""
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = [(b"IHDR", head), (b"IDAT", zlib.compress(b"\0" * 100)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
        for kind, content in chunks
    )


def message(content: bytes):
    return make(TYPE, header=header(0.0), format="png", data=np.frombuffer(content, np.uint8))


def reading():
    ((_, _, of_topic),) = readings({"eye": {"topic": "/eye", "type": TYPE}}).values()
    return of_topic


def children() -> list[psutil.Process]:
    """Return the processes that read for this one."""
    reading: list[psutil.Process] = []
    for process in psutil.Process().children():
        with contextlib.suppress(psutil.NoSuchProcess):  # it ends, or it has ended and was not waited for
            if "deodar.guarded.child" in process.cmdline():
                reading.append(process)
    return reading


def bag(folder: Path, *contents: bytes) -> dd.ROSBag:
    messages = (("/eye", 100_000_000 * k, to_bytes(message(content))) for k, content in enumerate(contents))
    write_bag(folder, {"/eye": TYPE}, messages, {})
    return dd.ROSBag(folder, period=100.0)


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_a_child_decodes_the_picture(kind: str, monkeypatch: pytest.MonkeyPatch):
    content = encoded((200, 100, 50), kind, (16, 16))
    monkeypatch.setattr(Image, "open", lambda *args, **named: pytest.fail("decoded in this process"))
    pixels = reading().read(message(content))
    assert pixels.shape == (16, 16, 3) and np.abs(pixels.astype(int) - (200, 100, 50)).max() < 6


def test_a_picture_that_needs_gigabytes_is_refused_with_its_topic(tmp_path: Path):
    for side, size in ((9000, "9000 x 9000"), (60_000, "too many")):
        with pytest.raises(Unreadable, match=f"its picture has {size} pixels; at most 22369621 are read"):
            reading().read(message(stating(side, side)))
    world = bag(tmp_path / "bag", encoded((255, 0, 0)), stating(60_000, 60_000), encoded((0, 0, 255)))
    assert world.sense("eye", AXES, 0.0)[0, 0].tolist() == [1, 0, 0]
    with pytest.raises(WorldError, match="message of /eye at 100 ms is refused: its picture has too many"):
        world.sense("eye", AXES, 100.0)


def test_a_child_that_was_killed_is_reported_and_the_next_picture_is_read():
    pictures = reading()
    assert pictures.read(message(encoded((255, 0, 0))))[0, 0].tolist() == [255, 0, 0]
    assert children()
    for child in children():
        os.kill(child.pid, 9)
    refused = 0
    for _ in range(3):  # each of two idle children may have been killed
        try:
            pixels = pictures.read(message(encoded((0, 0, 255))))
            break
        except Unreadable as error:
            refused += 1
            assert "its picture cannot be read: its reader ended by SIGKILL" in str(error)
    assert refused and pixels[0, 0].tolist() == [0, 0, 255]


# ------------------------------------------------------------------------------ pictures among other messages

KEY = "0/eye/sensor_msgs::msg::dds_::CompressedImage_/hash"
NUMBERS = "std_msgs/msg/Float32MultiArray"


class Inbox:
    """An inbox of two sensors of one topic of pictures, and of a topic of numbers."""

    def __init__(self) -> None:
        topics = {
            "eye": {"topic": "/eye", "type": TYPE},
            "again": {"topic": "/eye", "type": TYPE},
            "numbers": {"topic": "/numbers", "type": NUMBERS, "shape": [2]},
        }
        self.inbox = TopicInbox(readings(topics), {TYPE: "hash", NUMBERS: "hash"})
        self.sent = 0

    def picture(self, content: bytes) -> None:
        self._offer("/eye", KEY, to_bytes(message(content)))

    def numbers(self) -> None:
        raw = b"\0\1\0\0" + struct.pack("<III2f", 0, 0, 2, 1.0, 2.0)
        self._offer("/numbers", "0/numbers/std_msgs::msg::dds_::Float32MultiArray_/hash", raw)

    def _offer(self, topic: str, key: str, raw: bytes) -> None:
        self.sent += 1
        self.inbox.offer(topic, key, raw, struct.pack("<qqB16s", self.sent, 0, 16, bytes(16)))

    def pixel(self, name: str = "eye") -> list[int]:
        newest = self.inbox.reading(name)
        assert newest is not None
        return newest[0][0, 0].tolist()


def test_messages_arrive_while_a_picture_is_decoded(monkeypatch: pytest.MonkeyPatch):
    topics, begun, ended = Inbox(), threading.Event(), threading.Event()
    calls: list[int] = []

    def decoded(*arguments: object) -> np.ndarray:
        calls.append(len(calls))
        begun.set()
        assert ended.wait(60)
        return np.full((3, 4, 3), len(calls), np.uint8)

    monkeypatch.setattr(GuardedFile, "call", decoded)
    for _ in range(5):
        topics.picture(encoded((255, 0, 0)))
    assert not calls, "a picture of a sensor that is not read is not decoded"
    pixels: list[list[int]] = []
    reader = threading.Thread(target=lambda: pixels.append(topics.pixel()))
    reader.start()
    assert begun.wait(60)
    topics.numbers()
    topics.picture(encoded((0, 0, 255)))
    newest = topics.inbox.reading("numbers")
    assert newest is not None and newest[0].tolist() == [1, 2]
    ended.set()
    reader.join()
    assert pixels == [[1, 1, 1]] and topics.pixel() == topics.pixel() == [2, 2, 2] and len(calls) == 2
    assert topics.inbox.state("robot").by_sensor == {"eye": 6, "again": 6, "numbers": 1}


def test_a_damaged_picture_is_refused_where_it_is_read_and_the_one_before_stays():
    topics = Inbox()
    for content in (encoded((255, 0, 0)), b"no picture"):
        topics.picture(content)
        assert topics.pixel() == topics.pixel("again") == [255, 0, 0]
    assert "is no JPEG or PNG file" in str(topics.inbox.refused("eye"))
    assert topics.inbox.counts == {"accepted": 1, "refused": 1}
    assert topics.inbox.state("robot").by_sensor == {"eye": 1, "again": 1}
    topics.picture(encoded((0, 0, 255)))
    assert topics.pixel() == [0, 0, 255] and topics.inbox.refused("eye") is None
    topics.inbox.begin()
    assert topics.inbox.reading("eye") is None


def test_a_sensor_waits_for_a_picture_that_can_be_read():
    topics = Inbox()
    topics.picture(b"no picture")
    assert not topics.inbox.wait_for(["eye"], 0.0)
    later = threading.Timer(0.2, lambda: topics.picture(encoded((0, 0, 255))))
    later.start()
    topics.picture(b"no picture")
    assert topics.inbox.wait_for(["eye"], 60.0) and topics.pixel() == [0, 0, 255]
    later.join()


def test_the_wait_for_a_sensor_ends_while_damaged_pictures_come_faster_than_they_are_decoded(
    monkeypatch: pytest.MonkeyPatch,
):
    topics = Inbox()
    calls: list[float] = []

    def slow(*_: object) -> np.ndarray:
        calls.append(time.monotonic())
        time.sleep(0.01)
        if len(calls) < 500:
            topics.picture(b"no picture")
        raise WorldError("is damaged")

    monkeypatch.setattr(GuardedFile, "call", slow)
    topics.picture(b"no picture")
    assert not topics.inbox.wait_for(["eye"], 0.1)
    assert len(calls) < 50, "each takes 0.01 s at least"
    assert "its picture is damaged" in str(topics.inbox.refused("eye"))


def test_a_picture_that_is_decoded_after_the_end_of_the_wait_is_read(monkeypatch: pytest.MonkeyPatch):
    topics = Inbox()

    def slow(*_: object) -> np.ndarray:
        time.sleep(0.05)
        return np.full((3, 4, 3), 7, np.uint8)

    monkeypatch.setattr(GuardedFile, "call", slow)
    topics.picture(encoded((255, 0, 0)))
    assert topics.inbox.wait_for(["eye", "again"], 0.01) and topics.pixel() == [7, 7, 7]
