"""Compressed pictures of messages: a child decodes them, and no picture ends the run of a model."""

from __future__ import annotations

import io
import os
import struct
import zlib
from pathlib import Path

import numpy as np
import psutil
import pytest
from PIL import Image

import deodar as dd
from deodar.errors import WorldError
from deodar_robots.ros2.message_types import Unreadable, header, make, to_bytes
from deodar_robots.ros2.sensor_types import readings
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
    processes = psutil.Process().children()
    return [p for p in processes if "deodar.guarded.child" in p.cmdline()]


def bag(folder: Path, *contents: bytes) -> dd.ROSBag:
    messages = (("/eye", 100_000_000 * k, to_bytes(message(content))) for k, content in enumerate(contents))
    write_bag(folder, {"/eye": TYPE}, messages, {})
    return dd.ROSBag(folder, period=100.0)


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_a_child_decodes_the_picture(kind: str, monkeypatch: pytest.MonkeyPatch):
    content = encoded((200, 100, 50), kind, (16, 16))
    monkeypatch.setattr(Image, "open", lambda *args, **named: pytest.fail("decoded in this process"))
    pixels = reading().take(message(content))
    assert pixels.shape == (16, 16, 3) and np.abs(pixels.astype(int) - (200, 100, 50)).max() < 6


def test_a_picture_that_needs_gigabytes_is_refused_with_its_topic(tmp_path: Path):
    for side, size in ((9000, "9000 x 9000"), (60_000, "too many")):
        with pytest.raises(Unreadable, match=f"its picture has {size} pixels; at most 22369621 are read"):
            reading().take(message(stating(side, side)))
    world = bag(tmp_path / "bag", encoded((255, 0, 0)), stating(60_000, 60_000), encoded((0, 0, 255)))
    assert world.sense("eye", AXES, 0.0)[0, 0].tolist() == [1, 0, 0]
    with pytest.raises(WorldError, match="message of /eye at 100 ms is refused: its picture has too many"):
        world.sense("eye", AXES, 100.0)


def test_a_child_that_was_killed_is_reported_and_the_next_picture_is_read():
    pictures = reading()
    assert pictures.take(message(encoded((255, 0, 0))))[0, 0].tolist() == [255, 0, 0]
    assert children()
    for child in children():
        os.kill(child.pid, 9)
    refused = 0
    for _ in range(3):  # each of two idle children may have been killed
        try:
            pixels = pictures.take(message(encoded((0, 0, 255))))
            break
        except Unreadable as error:
            refused += 1
            assert "its picture cannot be read: its reader ended by SIGKILL" in str(error)
    assert refused and pixels[0, 0].tolist() == [0, 0, 255]
