"""Binary frames that carry arrays: a fixed header and raw numbers, both little-endian.

    bytes 0 to 3    number of the stream, uint32
    bytes 4 to 7    number of the frame, uint32: frames of one number show one moment
    bytes 8 to 15   document time of that moment, float64
    from byte 16    float32 values in C order

A time course is sent as pairs (time since the time in the header, value); the time in the header is that of
the oldest sample.
"""

from __future__ import annotations

import struct

import numpy as np

HEADER = struct.Struct("<IId")


def pack(stream: int, frame: int, time: float, values: np.ndarray) -> bytes:
    """Encode a frame."""
    return HEADER.pack(stream, frame % 2**32, time) + np.ascontiguousarray(values, "<f4").tobytes()
