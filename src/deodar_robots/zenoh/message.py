"""The messages between a robot and its commander: a header and one array."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
