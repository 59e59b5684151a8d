"""AEDAT 2.0, the files of jAER: lines of text, then an address and a time for each event.

Addresses are those of the DVS128 and the eDVS: bit 0 is the polarity, bits 1 to 7 are x and bits 8 to 14 y.
Bit 15 marks events that are not of a pixel. Times are in microseconds, modulo 2^32.
"""

from __future__ import annotations

import os
import re
import warnings
from pathlib import Path
from typing import BinaryIO

import numpy as np

from deodar import regular_file
from deodar.errors import RunWarning, WorldError
from deodar_robots.event_file.events import MOST_EVENTS, RecordedEvents, ordered

VERSION = b"#!AER-DAT2"
"""Beginning of a file of this version."""

SIDE = 128
"""Columns and rows of the sensor."""

MOST_HEADER = 2**24
"""Largest header in bytes; jAER writes all its settings there."""

EVENT_BYTES = 8


def read(path: Path, size: tuple[int, int] | None, jaer: bool) -> RecordedEvents:
    """Read a file.

    A part of an event at the end, of a recording that was cut off, is left out with a `RunWarning`.

    Args:
        path: the file.
        size: columns and rows of the sensor; None: 128 x 128.
        jaer: whether the column is 127 - x, the row 127 - y, and the polarity bit 0 for brighter, as the
            DVS128 sends them and jAER stores them; else the column is x, the row y, and the bit 1. (The
            description of AEDAT 2.0 states y from the bottom and the bit 1.)

    Raises:
        WorldError: the header is cut off or names another camera, there is no event, or an address is not one
            of a DVS128; and the errors of `ordered`.
    """
    where = str(path)
    with regular_file.open_binary(path) as file:
        begin = _end_of_header(file, where)
        stop = file.seek(0, os.SEEK_END)
        count, rest = divmod(stop - begin, EVENT_BYTES)
        if count > MOST_EVENTS:
            raise WorldError(f"holds {count} events; at most {MOST_EVENTS} are read", where=where)
        if rest:
            text = f"ends within an event; its last {rest} bytes are left out"
            warnings.warn(f"{where}: {text}", RunWarning, stacklevel=2)
        file.seek(begin)
        words = np.fromfile(file, ">u4", 2 * count).reshape(-1, 2)
    address, stamps = words[:, 0].astype(np.uint32), words[:, 1].astype(np.uint32)
    strange = address >= 2**16
    if strange.any():
        k = int(strange.argmax())
        raise WorldError(
            f"event {k} of {len(address)} has the address {address[k]:#x}; those of a DVS128 are below"
            " 0x10000",
            where=where,
            fix="Save a recording of another camera as AEDAT4, with the program of its maker",
        )
    times = _unwrapped(stamps)
    of_pixel = address < 2**15
    address, times = address[of_pixel], times[of_pixel]
    if not len(address):
        raise WorldError("holds no events", where=where, fix="Name a recording with events")
    x, y, bit = (address >> 1) & 127, (address >> 8) & 127, address & 1
    if jaer:
        x, y, bit = SIDE - 1 - x, SIDE - 1 - y, 1 - bit
    return ordered(times, x, y, bit == 1, size or (SIDE, SIDE), where)


def encoded(times: np.ndarray, columns: np.ndarray, rows: np.ndarray, on: np.ndarray) -> bytes:
    """Return the content of a file, in the addresses of jAER (`read`).

    Args:
        times: in microseconds, modulo 2^32.
        columns: columns from the left, 0 to 127.
        rows: rows from the top, 0 to 127.
        on: whether each event is one of a brighter pixel.
    """
    side = SIDE - 1
    address = (side - np.asarray(rows)) << 8 | (side - np.asarray(columns)) << 1 | ~np.asarray(on, bool)
    words = np.stack([address, np.asarray(times) % 2**32], axis=1)
    return VERSION + b".0\r\n" + words.astype(">u4").tobytes()


def _unwrapped(stamps: np.ndarray) -> np.ndarray:
    """Return times without the wrap at 2^32: a step is the shorter one of the two around the circle."""
    steps = np.diff(stamps).view(np.int32).astype(np.int64)
    return np.concatenate([stamps[:1].astype(np.int64), steps]).cumsum()


def _end_of_header(file: BinaryIO, where: str) -> int:
    """Return the place of the first event, after all lines that begin with #."""
    head = file.read(MOST_HEADER + 1)
    end = 0
    while head[end : end + 1] == b"#":
        line = head.find(b"\n", end)
        if line < 0 or line >= MOST_HEADER:
            large = len(head) > MOST_HEADER
            raise WorldError(
                f"has a header of more than {MOST_HEADER >> 20} MiB" if large else "ends within its header",
                where=where,
                fix="Record the file again",
            )
        end = line + 1
    chip = re.search(rb"^# *AEChip: *([^\r\n]*)", head[:end], re.MULTILINE)
    if chip and re.search(rb"davis|seebetter|cochlea|dvs320|dvs640|atis", chip[1], re.IGNORECASE):
        name = chip[1].decode("latin-1").rsplit(".", 1)[-1][:40]
        raise WorldError(
            f"was recorded with a {name!r}, whose addresses are not those of a DVS128",
            where=where,
            fix="Save it as AEDAT4, with the program of the camera's maker",
        )
    return end
