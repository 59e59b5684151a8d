"""A time course in the making: one number of a running model, kept in a ring of fixed size."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

import numpy as np

from deodar.numerics.axes import Axis
from deodar.session.look import PortKey

CAPACITY = 16384
"""Samples that are kept; older ones are gone (a guess: a minute at the pace at which a page draws)."""


@dc.dataclass(frozen=True)
class Wish:
    """Which number: a node's value, or of an array its value at a place (axis units), its maximum or its
    mean.
    """

    place: PortKey
    reduce: str = "max"
    at: tuple[float, ...] = ()

    def value(self, array: np.ndarray, axes: Sequence[Axis]) -> float:
        """The number, now."""
        if array.ndim == 0:
            return float(array)
        if self.reduce == "max":
            return float(array.max())
        if self.reduce == "mean":
            return float(array.mean())
        places = (*self.at, *(0.5 * (a.lower + a.upper) for a in axes[len(self.at) :]))
        return float(array[tuple(_nearest(a, x) for a, x in zip(axes, places, strict=False))])


class Trace:
    """The newest samples of a wish; `count` is how many there ever were."""

    def __init__(self) -> None:
        self.count = 0
        self._samples = np.zeros((CAPACITY, 2))

    def add(self, time: float, value: float) -> None:
        """One more sample."""
        self._samples[self.count % CAPACITY] = time, value
        self.count += 1

    def since(self, count: int) -> np.ndarray:
        """Samples after the first `count`, as far as they are kept: pairs of time and value, oldest first."""
        first = max(count, self.count - CAPACITY)
        return self._samples[np.arange(first, self.count) % CAPACITY]


def _nearest(axis: Axis, place: float) -> int:
    return int(np.argmin(np.abs(axis.points - place)))
