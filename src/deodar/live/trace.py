"""Time courses of a running model: one number over time, in a ring buffer of fixed size."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

import numpy as np

from deodar.numerics.axes import Axis
from deodar.session.port_reader import PortKey

CAPACITY = 16384
"""Number of samples in the buffer (a guess: a minute at the rate at which a page draws)."""


@dc.dataclass(frozen=True)
class TraceRequest:
    """Specification of a time course: a node's value, or an array's maximum, mean or value at a position.

    The position `at` is in axis units; axes without a value there use their middle.
    """

    place: PortKey
    reduce: str = "max"
    at: tuple[float, ...] = ()

    def value(self, array: np.ndarray, axes: Sequence[Axis]) -> float:
        """Return the number for the present array."""
        if array.ndim == 0:
            return float(array)
        if self.reduce == "max":
            return float(array.max())
        if self.reduce == "mean":
            return float(array.mean())
        places = (*self.at, *(0.5 * (a.lower + a.upper) for a in axes[len(self.at) :]))
        return float(array[tuple(_nearest(a, x) for a, x in zip(axes, places, strict=False))])


class Trace:
    """The newest samples of a time course; `count` is the number of all samples so far."""

    def __init__(self) -> None:
        self.count = 0
        self._samples = np.zeros((CAPACITY, 2))

    def add(self, time: float, value: float) -> None:
        """Add a sample."""
        self._samples[self.count % CAPACITY] = time, value
        self.count += 1

    def since(self, count: int) -> np.ndarray:
        """Return the samples after the first `count`, if in the buffer: (time, value), oldest first."""
        first = max(count, self.count - CAPACITY)
        return self._samples[np.arange(first, self.count) % CAPACITY]


def _nearest(axis: Axis, place: float) -> int:
    return int(np.argmin(np.abs(axis.points - place)))
