"""Reading bags of ROS 2 in a child process."""

from __future__ import annotations

import contextlib
import importlib.util
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Any, TypedDict

from deodar.errors import MissingExtra, WorldError, first_line

KEY = "deodar"
"""Name of what deodar adds to the metadata of a bag."""

LAST = 2**63
"""Bound of the times of messages, ns: they are stored as 64 bits."""

MOST_METADATA = 1_000_000
"""Largest number of bytes of metadata.yaml, which is parsed at about 0.2 MB/s (a guess, room for two
thousand topics)."""


class BagSummary(TypedDict):
    """What a bag holds.

    Attributes:
        topics: name, type, hash ("": not stated) and number of messages of each topic.
        start: time of the first message, ns.
        end: time of the last message, ns.
        custom: what deodar added to the metadata, JSON; "" for a bag of another program.
    """

    topics: list[tuple[str, str, str, int]]
    start: int
    end: int
    custom: str


class BagPart(TypedDict):
    """Times (ns) and bytes of some messages of a topic, and whether they are its last ones."""

    times: list[int]
    raws: list[bytes]
    last: bool


def require_package() -> None:
    """Raise an error that says how to install the package that reads bags, if it is missing."""
    if importlib.util.find_spec("rosbags") is None:
        raise MissingExtra("rosbags", "network", "a bag of ROS 2")


def summary_of(path: str) -> BagSummary:
    """Return what a bag holds.

    Raises:
        WorldError: it is not a bag, is damaged, or holds no message.
    """
    with _opened(path) as reader:
        if not reader.message_count:
            raise WorldError("holds no message", path)
        if not 0 <= reader.start_time <= reader.end_time <= LAST:
            raise WorldError("its metadata.yaml states times that no clock has", path)
        custom = getattr(reader.storage.metadata, "custom", None) or {}
        return {
            "topics": [(c.topic, c.msgtype, c.digest or "", int(c.msgcount)) for c in reader.connections],
            "start": int(reader.start_time),
            "end": int(reader.end_time) - 1,
            "custom": str(custom.get(KEY, "")),
        }


def messages_of(path: str, topic: str, start: int, most: Sequence[int]) -> BagPart:
    """Return messages of a topic, of at least two times, from a time on.

    Args:
        path: the bag.
        topic: the topic.
        start: time of the first message, ns.
        most: number and bytes of the messages after which those of another time are left to the next part.

    Raises:
        WorldError: the bag is damaged.
    """
    times: list[int] = []
    raws: list[bytes] = []
    size = 0
    with _opened(path) as reader:
        chosen = [c for c in reader.connections if c.topic == topic]
        for _, time, raw in reader.messages(chosen, start=start):
            if (len(times) >= most[0] or size > most[1]) and times[-1] > times[0]:
                return {"times": times, "raws": raws, "last": False}
            times.append(int(time))
            raws.append(bytes(raw))
            size += len(raw)
    return {"times": times, "raws": raws, "last": True}


@contextlib.contextmanager
def _opened(path: str) -> Generator[Any]:
    # an extra
    from rosbags.rosbag2 import Reader

    metadata = Path(path) / "metadata.yaml"
    if metadata.is_file() and (size := metadata.stat().st_size) > MOST_METADATA:
        raise WorldError(f"its metadata.yaml has {size:,} bytes, more than {MOST_METADATA:,}", path)
    try:
        with Reader(Path(path)) as reader:
            yield reader
    except (WorldError, MemoryError):
        raise
    except Exception as error:  # damaged files may raise any exception
        raise WorldError(f"cannot be read as a bag: {first_line(error)}", path) from None
