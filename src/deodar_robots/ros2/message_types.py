"""Types of messages of ROS 2: their names, their hashes, and their form as bytes (CDR), by rosbags."""

from __future__ import annotations

import functools
import re
from typing import Any

from deodar.errors import MissingExtra, WorldError, did_you_mean, first_line

MOST_BYTES = 2**26
"""Largest message in bytes; a picture of 4000 x 4000 samples of three colours still fits."""

_NAME = re.compile(r"(\w+)/(?:msg/)?(\w+)")


class Unreadable(ValueError):
    """Raised for a message that a sensor does not read; the text says why, and `fix` what to type."""

    def __init__(self, why: str, fix: str = "") -> None:
        super().__init__(why)
        self.fix = fix


@functools.cache
def store() -> Any:
    """Return the types of ROS 2 Jazzy (extra `network`), or raise an error that says how to install them."""
    try:
        # an extra
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise MissingExtra("rosbags", "network", "messages of ROS 2") from None
    return get_typestore(Stores.ROS2_JAZZY)


def full_name(text: str, known: tuple[str, ...], where: str) -> str:
    """Return the full name of a type: `sensor_msgs/LaserScan` is `sensor_msgs/msg/LaserScan`.

    Raises:
        WorldError: it is none of the known ones.
    """
    found = _NAME.fullmatch(text)
    name = f"{found[1]}/msg/{found[2]}" if found else text
    if name not in known:
        raise WorldError(f"the type {text!r} is not read or written", where, did_you_mean(name, known))
    return name


def hash_of(name: str) -> str:
    """Return the hash of a type, RIHS01_ and 64 hexadecimal digits."""
    return store().hash_rihs01(name)


def make(name: str, **fields: Any) -> Any:
    """Return a message of a type, from values of all its fields."""
    return store().types[name](**fields)


def header(seconds: float = 0.0) -> Any:
    """Return the header of a message, with a time in s since 1970 and no frame."""
    whole = int(seconds)
    stamp = make("builtin_interfaces/msg/Time", sec=whole, nanosec=int((seconds - whole) * 1e9))
    return make("std_msgs/msg/Header", stamp=stamp, frame_id="")


def to_bytes(message: Any) -> bytes:
    """Return a message as bytes: CDR, little-endian, after four bytes that say so."""
    return bytes(store().serialize_cdr(message, message.__msgtype__, little_endian=True))


def from_bytes(raw: bytes, name: str) -> Any:
    """Read a message of a type.

    Raises:
        Unreadable: the bytes are not such a message.
    """
    if len(raw) > MOST_BYTES:
        raise Unreadable(f"it has {len(raw)} bytes; at most {MOST_BYTES} are read")
    try:
        return store().deserialize_cdr(raw, name)
    except Exception as error:  # damaged bytes may raise any exception
        raise Unreadable(f"it is not a {name}: {first_line(error)}") from None
