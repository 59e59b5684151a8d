"""The steps at which a timed stimulus is on."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np

from deodar_interop.importers._piece import Unfit

MOST_COUNTED = 1_000_000
"""Number of steps up to which the adding of the step is repeated, with its rounding."""

MOST_SPANS = 1000
"""Largest number of separate spans (a guess: each is compared in every step)."""


def spans(periods: Sequence[tuple[float, float]], step: float) -> list[tuple[int, int]]:
    """Return the steps of closed periods, first and last, counted from 1, in order and without overlap.

    The time of a step is the step added to itself, with the rounding of each sum, as in dnf-composer.

    Raises:
        Unfit: there are too many spans.
    """
    latest = max((min(z, MOST_COUNTED * step) for _, z in periods), default=0.0)
    times = _times(step, min(max(math.ceil(latest / step), 0) + 2, MOST_COUNTED))
    closed = sorted(
        span for a, z in periods if (span := (_first(times, a, step), _last(times, z, step)))[0] <= span[1]
    )
    out: list[tuple[int, int]] = []
    for a, z in closed:
        if out and a <= out[-1][1] + 1:
            out[-1] = (out[-1][0], max(out[-1][1], z))
        else:
            out.append((a, z))
    if len(out) > MOST_SPANS:
        raise Unfit(f"it is on in {len(out)} separate periods; at most {MOST_SPANS} are read")
    return out


@functools.lru_cache(maxsize=4)
def _times(step: float, count: int) -> np.ndarray:
    """Return the times of the steps, each the sum of the one before and the step."""
    return np.add.accumulate(np.full(count, step))


def _first(times: np.ndarray, t: float, step: float) -> int:
    """Return the first step at or after a time."""
    if t <= times[-1]:
        return int(np.searchsorted(times, t, "left")) + 1
    return math.ceil(min(t / step, 1e15) - 1e-6)


def _last(times: np.ndarray, t: float, step: float) -> int:
    """Return the last step at or before a time; 0 if there is none."""
    if t < times[-1]:
        return int(np.searchsorted(times, t, "right"))
    return math.floor(min(t / step, 1e15) + 1e-6)
