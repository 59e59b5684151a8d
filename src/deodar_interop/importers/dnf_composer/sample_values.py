"""Kernels, Gaussians, resampled lines and onsets over samples, as dnf-composer computes them."""

from __future__ import annotations

import dataclasses as dc
import functools
import math
from collections.abc import Sequence

import numpy as np

from deodar_interop.importers._piece import Unfit

CUTOFF = 5.0
"""Reach of a kernel in widths."""

NOTHING = 1e-12
"""Sum of weights below which dnf-composer does not normalise."""


@dc.dataclass(frozen=True)
class Taps:
    """The offsets of one dimension, from -left to right, and their weights."""

    left: int
    right: int
    weights: np.ndarray

    def centred(self, mirrored: bool) -> np.ndarray:
        """Return the weights with offset 0 in the middle, of an odd number.

        Args:
            mirrored: whether an offset points from the source to the target; dnf-composer correlates where
                a kernel is not circular.
        """
        reach = max(self.left, self.right)
        out = np.zeros(2 * reach + 1)
        out[reach - self.left : reach + self.right + 1] = self.weights
        return out[::-1].copy() if mirrored else out


def reaches(width: float, count: int, circular: bool) -> tuple[int, int]:
    """Return the numbers of offsets on both sides."""
    wide = math.ceil(min(CUTOFF * width, 1e12))
    if circular:
        return min(wide, (count - 1) // 2), min(wide, count // 2)
    return min(wide, count - 1), min(wide, count - 1)


def gaussian(width: float, left: int, right: int, normalized: bool) -> Taps:
    """Return exp(-o^2 / (2 width^2)), divided by its sum over the offsets if normalized."""
    o = np.arange(-left, right + 1.0)
    g = np.exp(-0.5 * (o / width) ** 2)
    return Taps(left, right, _over_sum(g, g.sum()) if normalized else g)


def derivative(width: float, left: int, right: int) -> np.ndarray:
    """Return the derivative of a Gaussian of height 1, -o / width^2 exp(-o^2 / (2 width^2))."""
    o = np.arange(-left, right + 1.0)
    return -(o / width**2) * np.exp(-0.5 * (o / width) ** 2)


def oscillation(decay: float, crossings: float, count: int, circular: bool) -> Taps:
    """Return exp(-d |o|) (sin(d |z o|) + cos(z o)), of amplitude 1."""
    left, right = reaches(oscillation_width(decay, crossings), count, circular)
    o = np.arange(-left, right + 1.0)
    waves = np.sin(decay * np.abs(crossings * o)) + np.cos(crossings * o)
    return Taps(left, right, np.exp(-decay * np.abs(o)) * waves)


def oscillation_width(decay: float, crossings: float) -> float:
    """Return the width from which the reach of an oscillation follows."""
    return max(1 / decay, 5 * crossings)


def per_sum(taps: Taps) -> Taps:
    """Return weights divided by their sum; nothing if the sum is too small."""
    return dc.replace(taps, weights=_over_sum(taps.weights, taps.weights.sum()))


def shift(width: float, left: int, right: int, normalized: bool) -> np.ndarray:
    """Return the derivative of a Gaussian, divided by the sum of its absolute values if normalized."""
    d = derivative(width, left, right)
    return _over_sum(d, np.abs(d).sum()) if normalized else d


def _over_sum(weights: np.ndarray, total: float) -> np.ndarray:
    if not math.isfinite(total) or abs(total) < NOTHING:
        return np.zeros_like(weights)
    return weights / total


def line(count: int, position: float, width: float, circular: bool) -> np.ndarray:
    """Return exp(-d^2 / (2 width^2)) at the samples 1, 2, ..., count; all arguments are in samples."""
    x = np.arange(1.0, count + 1)
    if circular:
        d = np.abs(x - (np.fmod(position - 1, count) + 1))
        d = np.minimum(d, count - d)
    else:
        d = x - position
    return np.exp(-0.5 * (d / width) ** 2)


def along(points: np.ndarray, extent: float | None, position: float, width: float) -> np.ndarray:
    """Return one factor of a plane, exp(-d^2 / (2 width^2)); all arguments are in units.

    A circular distance is at most half of the extent, which need not be a whole number of steps; None: the
    axis is not circular.
    """
    d = np.abs(points - position)
    return np.exp(-0.5 * ((d if extent is None else np.minimum(d, extent - d)) / width) ** 2)


METHODS = ("linear", "nearest", "cubic")


def matrix(method: str, came: int, count: int) -> np.ndarray:
    """Return the weights of `came` input samples at `count` output samples, (count, came).

    Output sample i lies at i (came - 1) / (count - 1); a single one shows the input sample came / 2. The
    cubic method is that of Catmull and Rom, with the first and last sample repeated.
    """
    out = np.zeros((count, came))
    rows = np.arange(count)
    if came == count:
        return np.eye(count)
    if count == 1:
        out[0, came // 2] = 1.0
        return out
    at = rows * (came - 1) / (count - 1)
    low = np.minimum(np.floor(at).astype(int), came - 1)
    t = at - low
    match method:
        case "nearest":
            parts = [(np.floor(at + 0.5).astype(int), np.ones(count))]
        case "cubic":
            parts = [
                (low - 1, 0.5 * (-(t**3) + 2 * t**2 - t)),
                (low, 0.5 * (3 * t**3 - 5 * t**2 + 2)),
                (low + 1, 0.5 * (-3 * t**3 + 4 * t**2 + t)),
                (low + 2, 0.5 * (t**3 - t**2)),
            ]
        case _:
            parts = [(low, 1 - t), (low + 1, t)]
    for place, weight in parts:
        np.add.at(out, (rows, np.clip(place, 0, came - 1)), weight)
    return out


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
