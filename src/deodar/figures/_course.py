"""Long courses at the resolution of a figure, read in blocks: the extreme values of each interval."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

MOST_SAMPLES = 4000
"""Most samples of a drawn line: two for each of 2000 intervals, which are narrower than the dots of a printer
across two columns of a journal (183 mm at 300 dots per inch: 2161).
"""

BLOCK = 2**26
"""Number of bytes that are read at a time."""

ReadPart = Callable[[slice], np.ndarray]
"""Returns a part of the samples, which are the last axis."""


def reduced(
    read: ReadPart, x: np.ndarray, bytes_each: float, trials: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Return positions, values, and the mean over trials; of at most `MOST_SAMPLES` samples.

    A longer course is divided into intervals. Each is drawn by its smallest and its largest value, in the
    order in which its first and its last value suggest, so no extreme value is left out.

    Args:
        read: reads a part of the samples.
        x: the position of each sample.
        bytes_each: number of bytes that are read for one sample.
        trials: whether the last axis but one is that of trials, whose mean is also returned.
    """
    n = len(x)
    if n <= MOST_SAMPLES:
        values = read(slice(0, n))
        return x, values, _mean(values) if trials else None
    edges = np.linspace(0, n, MOST_SAMPLES // 2 + 1).astype(np.int64)
    at_once = max(1, int(BLOCK / max(bytes_each, 1e-9) / (n / (len(edges) - 1))))
    rows: list[np.ndarray] = []
    means: list[np.ndarray] = []
    for first in range(0, len(edges) - 1, at_once):
        own = edges[first : first + at_once + 1]
        values = read(slice(int(own[0]), int(own[-1])))
        rows.append(_extremes(values, own - own[0]))
        if trials:
            means.append(_extremes(_mean(values), own - own[0]))
    middle = (edges[:-1] + edges[1:]) // 2
    where = np.stack([x[edges[:-1]], x[middle]], -1).reshape(-1)
    return where, np.concatenate(rows, -1), np.concatenate(means, -1) if trials else None


def _extremes(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return two values for each interval: the smallest and the largest one; NaN counts only where alone."""
    low = np.fmin.reduceat(values, edges[:-1], axis=-1)
    high = np.fmax.reduceat(values, edges[:-1], axis=-1)
    falls = values[..., edges[:-1]] > values[..., edges[1:] - 1]
    pair = np.stack([np.where(falls, high, low), np.where(falls, low, high)], -1)
    return pair.reshape(*pair.shape[:-2], -1)


def _mean(values: np.ndarray) -> np.ndarray:
    return values.mean(-2, keepdims=True, dtype=float)
