"""Kernels over samples, as dnf-composer computes them: a weight for each offset up to five widths."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

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
