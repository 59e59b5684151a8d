"""Events as text, a line `t x y p` for each, as data sets of event cameras are published.

Numbers are separated by spaces, tabs or commas. A time with a decimal point is in seconds, a whole number in
microseconds. The polarity is 1 for brighter, and 0 or -1 for darker. A first line of two numbers is the size
of the sensor, and one of names is left out, as lines that begin with # are.
"""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np

from deodar import regular_file
from deodar.errors import WorldError
from deodar_robots.event_file.events import MOST_EVENTS, RecordedEvents, ordered

MOST_BYTES = 2**32
"""Largest file that is read, in bytes."""

FIX = "A line is `t x y p`: seconds, column, row, and 1 or 0, such as `0.003811 96 133 1`"


def is_text(head: bytes) -> bool:
    """Return whether a file that begins so is text."""
    return bool(head) and re.fullmatch(rb"[\t\r\n -~]+", head) is not None


def read(path: Path, size: tuple[int, int] | None) -> RecordedEvents:
    """Read a file.

    Args:
        path: the file.
        size: columns and rows of the sensor; None: those of the first line, else those that the events need.

    Raises:
        WorldError: a line has something else, or there is no event; and the errors of `ordered`.
    """
    where = str(path)
    with regular_file.open_binary(path) as file:
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise WorldError(f"is larger than {MOST_BYTES >> 30} GiB", where=where, fix="Save it as AEDAT4")
    content = re.sub(rb"\A(\s*#[^\n]*(\n|\Z))+", b"", content)
    first, _, lines = content.partition(b"\n")
    words = first.replace(b",", b" ").split()
    stated = (int(words[0]), int(words[1])) if len(words) == 2 and b"".join(words).isdigit() else None
    if stated is not None or re.match(rb"\s*(?!nan|inf)[A-Za-z]", first):
        content = lines
    content = content.replace(b",", b" ")
    table = _table(content, where)
    times, columns, rows, polarity = table.T
    whole = np.all((table[:, 1:] % 1 == 0) & (table[:, 1:] < 2**31), axis=1)
    good = np.isfinite(table).all(1) & whole & (columns >= 0) & (rows >= 0) & np.isin(polarity, (-1, 0, 1))
    if not good.all():
        k = int((~good).argmax())
        numbers = " ".join(f"{v:g}" for v in table[k])
        raise WorldError(f"event {k} of {len(table)} is `{numbers}`", where=where, fix=FIX)
    in_seconds = re.match(rb"\s*\d*\.", content) is not None
    ticks = np.round(times * 1e6 if in_seconds else times)
    if np.abs(ticks).max() >= 2**62:
        raise WorldError("states times that are more than a year apart", where=where)
    sides = size or stated or (int(columns.max()) + 1, int(rows.max()) + 1)
    places = columns.astype(np.int64), rows.astype(np.int64)
    return ordered(ticks.astype(np.int64), *places, polarity > 0, sides, where)


def _table(content: bytes, where: str) -> np.ndarray:
    """Return the numbers, events x 4."""
    if not content.strip():
        raise WorldError("holds no events", where=where, fix=FIX)
    try:
        table = np.loadtxt(io.BytesIO(content), ndmin=2, max_rows=MOST_EVENTS + 1)
    except ValueError as error:
        raise WorldError(f"is text, and no recording of events: {error}", where=where, fix=FIX) from None
    if table.shape[1] != 4 or len(table) > MOST_EVENTS:
        fault = f"has {table.shape[1]} numbers in a line" if table.shape[1] != 4 else "has too many events"
        raise WorldError(fault, where=where, fix=FIX)
    return table
