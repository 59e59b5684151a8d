"""Events of a recording in the order of time, and how many of them each pixel has in an interval."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from deodar.errors import RunWarning, WorldError

MOST_EVENTS = 100_000_000
"""Largest number of events that are read; they take 13 bytes each."""

MOST_PIXELS = 2**22
"""Largest number of pixels of a sensor, that of 2048 x 2048."""

MOST_BACK = 100_000
"""Largest step back in time, in microseconds, after which events are sorted; after a larger one the time was
reset, and the recording is refused.
"""

LONGEST = 366 * 86_400_000_000
"""Longest recording in microseconds, a year."""


@dataclass(frozen=True, eq=False)
class RecordedEvents:
    """Events in the order of time.

    Attributes:
        size: columns and rows of the sensor.
        times: time of each event in microseconds since the first one.
        pixels: number of the pixel, column * rows + row.
        on: whether the pixel became brighter.
    """

    size: tuple[int, int]
    times: np.ndarray
    pixels: np.ndarray
    on: np.ndarray

    @property
    def duration(self) -> int:
        """Microseconds from the first event to the end of the microsecond of the last one."""
        return int(self.times[-1]) + 1

    def counts(self, start: int, stop: int, loop: bool) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers of on and off events of each pixel, (columns, rows), at start <= time < stop.

        Times are in microseconds; none is before 0. With `loop` the recording is repeated without end.
        """
        on, off = np.zeros(self.size), np.zeros(self.size)
        for low, high in self._pieces(max(start, 0), stop, loop):
            a, b = (int(k) for k in np.searchsorted(self.times, [low, high]))
            more = self._between(a, b)
            on, off = on + more[0], off + more[1]
        if loop and stop > max(start, 0):
            whole = (stop - max(start, 0)) // self.duration
            if whole:
                on, off = on + whole * self._all[0], off + whole * self._all[1]
        return on, off

    def _pieces(self, start: int, stop: int, loop: bool) -> Iterator[tuple[int, int]]:
        """Yield intervals of the recording that make up an interval, without whole repetitions."""
        length = self.duration
        if stop <= start:
            return
        if not loop:
            yield min(start, length), min(stop, length)
            return
        first = start % length
        last = first + (stop - start) % length
        yield first, min(last, length)
        if last > length:
            yield 0, last - length

    @functools.cached_property
    def _all(self) -> tuple[np.ndarray, np.ndarray]:
        return self._between(0, len(self.times))

    def _between(self, a: int, b: int) -> tuple[np.ndarray, np.ndarray]:
        pixels, on = self.pixels[a:b], self.on[a:b]
        cells = self.size[0] * self.size[1]
        bright, dark = (np.bincount(pixels[which], minlength=cells) for which in (on, ~on))
        return bright.reshape(self.size), dark.reshape(self.size)


def require_size(size: tuple[int, int], where: str) -> None:
    """Raise WorldError if a sensor cannot have this number of columns and rows."""
    columns, rows = size
    if columns < 1 or rows < 1 or columns * rows > MOST_PIXELS:
        raise WorldError(
            f"states a sensor of {columns} x {rows} pixels; expected 1 to {MOST_PIXELS}", where=where
        )


def ordered(
    times: np.ndarray,
    columns: np.ndarray,
    rows: np.ndarray,
    on: np.ndarray,
    size: tuple[int, int],
    where: str,
) -> RecordedEvents:
    """Return events in the order of time, from time 0 on.

    Events whose time goes back by 0.1 s or less are sorted, with a `RunWarning`.

    Args:
        times: int64, in microseconds, from any origin.
        columns: columns from the left, from 0 on.
        rows: rows from the top, from 0 on.
        on: whether each event is one of a brighter pixel.
        size: columns and rows of the sensor.
        where: the file, for messages.

    Raises:
        WorldError: an event lies beyond the sensor, time goes back by more than 0.1 s, or the recording is
            longer than a year.
    """
    require_size(size, where)
    beyond = (columns >= size[0]) | (rows >= size[1])
    if beyond.any():
        k = int(beyond.argmax())
        raise WorldError(
            f"event {k} of {len(times)} is at column {columns[k]}, row {rows[k]}; the sensor has"
            f" {size[0]} x {size[1]} pixels",
            where=where,
            fix="State the size of the sensor, for example size=(346, 260), or record the file again",
        )
    if int(times.max()) - int(times.min()) > LONGEST:
        raise WorldError("states times that are more than a year apart", where=where)
    pixels = columns.astype(np.uint32) * np.uint32(size[1]) + rows.astype(np.uint32)
    latest = np.maximum.accumulate(times)
    behind = latest - times
    furthest = int(behind.max())
    if furthest > MOST_BACK:
        k = int((behind > MOST_BACK).argmax())
        raise WorldError(
            f"time goes back by {behind[k] / 1e6:.3g} s at event {k} of {len(times)}: it was reset there",
            where=where,
            fix="Cut the recording at this event into two files",
        )
    if furthest:
        late = int(np.count_nonzero(behind))
        text = f"time goes back by up to {furthest / 1e3:g} ms at {late} of {len(times)} events; sorted them"
        warnings.warn(f"{where}: {text}", RunWarning, stacklevel=2)
        order = np.argsort(times, kind="stable")
        times, pixels, on = times[order], pixels[order], on[order]
    return RecordedEvents(size, times - times[0], pixels, on.astype(bool))
