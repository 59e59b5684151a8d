"""Time courses of a running model: one number or one row of numbers over time, in a ring buffer."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterable, Iterator

import numpy as np

from deodar.numerics.axes import Axes
from deodar.session.port_reader import PortKey
from deodar_studio.live.section import Section, places

CAPACITY = 16384
"""Largest number of samples in the buffer (a guess: a minute at the rate at which a page draws)."""

MOST_VALUES = 2**21
"""Largest number of values in the buffer: 16 MB in double precision."""


@dc.dataclass(frozen=True)
class TraceRequest:
    """Specification of a time course: a node's value, or an array's maximum, mean or value at a position.

    The position `at` is in axis units; axes without a value there use their middle. With a `section` a sample
    is the row of values along its one axis.
    """

    place: PortKey
    reduce: str = "max"
    at: tuple[float, ...] = ()
    section: Section | None = None

    def value(self, array: np.ndarray, axes: Axes) -> float | np.ndarray:
        """Return the sample for the present array."""
        if self.section is not None:
            return self.section.take(array, axes).reshape(-1)
        if array.ndim == 0:
            return float(array)
        if self.reduce == "max":
            return float(array.max())
        if self.reduce == "mean":
            return float(array.mean())
        return float(array[places(axes, self.at)])


class Trace:
    """The newest samples of a time course; `count` is the number of all samples so far.

    One thread may add samples while another one reads. A reader that passes the `count` of its last reading
    gets every sample once.
    """

    def __init__(self) -> None:
        self.count = 0
        self._buffer = np.zeros((CAPACITY, 2)), 0  # the samples, and the number of the first one

    @property
    def width(self) -> int:
        """Number of values of a sample, without its time."""
        return self._buffer[0].shape[1] - 1

    @property
    def newest(self) -> float | None:
        """Time of the newest sample; None without one."""
        samples, begin = self._buffer
        return float(samples[(self.count - 1) % len(samples), 0]) if self.count > begin else None

    def add(self, time: float, value: float | np.ndarray) -> None:
        """Add a sample; one with another number of values than the last removes those before it."""
        width = np.size(value)
        if width != self.width:
            self._buffer = np.zeros((capacity(width), 1 + width)), self.count
        samples = self._buffer[0]
        row = samples[self.count % len(samples)]
        row[0], row[1:] = time, value
        self.count += 1

    def since(self, count: int, end: int | None = None) -> np.ndarray:
        """Return the samples after the first `count`, if in the buffer: (time, *values), oldest first.

        `end`: a former `count`; samples after it are left out. None: all samples so far.
        """
        end = self.count if end is None else end
        samples, begin = self._buffer
        first = max(count, begin, end - len(samples))
        return samples[np.arange(first, max(first, end)) % len(samples)]

    def until(self, time: float) -> Trace:
        """Return a new time course with the samples up to a time."""
        trace = Trace()
        for at, *values in self.since(0):
            if at <= time:
                trace.add(at, np.asarray(values))
        return trace


def extremes(values: np.ndarray, first: int, interval: int) -> np.ndarray:
    """Return the indices of the samples that remain of a time course: the smallest and the largest one of
    each interval, in the order of time. NaN counts only where an interval has nothing else.

    Args:
        values: consecutive samples of the course.
        first: number of the first of them in the whole course; intervals begin at multiples of their length.
        interval: number of samples of an interval; with 2 or less all samples remain.
    """
    if interval <= 2:
        return np.arange(len(values))
    low, high = (np.where(np.isnan(values), bad, values) for bad in (np.inf, -np.inf))
    begins = np.arange(-(first % interval), len(values), interval)
    places: set[int] = set()
    for begin in np.maximum(begins, 0).tolist():
        end = begin + interval - (first + begin) % interval
        places |= {begin + int(low[begin:end].argmin()), begin + int(high[begin:end].argmax())}
    return np.asarray(sorted(places), int)


def farthest(
    parts: Iterable[tuple[np.ndarray, np.ndarray]], interval: int, median: float
) -> Iterator[tuple[list[float], list[np.ndarray]]]:
    """Thin rows over time, part by part: of each interval remain the time at which it begins and, for each
    column, the value that is farthest from `median`. NaN counts only where an interval has nothing else.

    Args:
        parts: times and rows of consecutive parts of the course.
        interval: number of rows of an interval.
        median: the usual value, such as the resting level of a field.

    Yields:
        Times and rows of the intervals that end in a part, after the last part those of the last interval.
    """
    first = 0
    times: list[float] = []
    rows: list[np.ndarray] = []
    for moments, values in parts:
        begins = np.maximum(np.arange(-(first % interval), len(values), interval), 0)
        low, high = (f.reduceat(values, begins, axis=0) for f in (np.fmin, np.fmax))
        thinned = list(farther(low, high, median))
        if rows and first % interval:  # the first of them began in the part before
            parted = np.stack([rows.pop(), thinned[0]])
            thinned[0] = farther(np.fmin.reduce(parted), np.fmax.reduce(parted), median)
            begins = begins[1:]
        times += moments[begins].tolist()
        rows += thinned
        yield times[:-1], rows[:-1]
        times, rows, first = times[-1:], rows[-1:], first + len(values)
    yield times, rows


def farther(low: np.ndarray, high: np.ndarray, median: float) -> np.ndarray:
    """Return the smallest or the largest value, whichever is farther from `median`."""
    return np.where(median - low > high - median, low, high)


def capacity(width: int) -> int:
    """Return the number of samples of `width` values in a buffer."""
    return min(CAPACITY, max(2, MOST_VALUES // max(1, width)))
