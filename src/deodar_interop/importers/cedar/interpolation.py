"""Weights by which OpenCV, and so cedar, resizes one axis.

Samples are cells of the same extent: sample i of m lies at (i + 1/2) n / m - 1/2 among the n of the input.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

WAYS = ("LINEAR", "NEAREST", "AREA", "CUBIC", "LANCZOS4")

SHARPNESS = -0.75
"""Parameter of OpenCV's cubic interpolation."""


def matrix(source: int, target: int, way: str) -> np.ndarray:
    """Return the weights from `given` samples to `wanted`, shape (wanted, given)."""
    match way:
        case "NEAREST":
            return np.eye(source)[np.minimum(np.arange(target) * source // target, source - 1)]
        case "AREA" if target < source:
            return _shares(source, target)
        case "CUBIC" | "LANCZOS4":
            return _between(source, target, _cubic, 2)
        case _:
            return _between(source, target, _linear, 1)


def _between(source: int, target: int, weight: Callable[[float], float], reach: int) -> np.ndarray:
    """Return weights of the neighbours within a reach; beyond an end its value is repeated."""
    out = np.zeros((target, source))
    for i in range(target):
        at = (i + 0.5) * source / target - 0.5
        first = int(np.floor(at)) - reach + 1
        for k in range(first, first + 2 * reach):
            out[i, min(max(k, 0), source - 1)] += weight(at - k)
    return out


def _linear(distance: float) -> float:
    return max(0.0, 1.0 - abs(distance))


def _cubic(distance: float) -> float:
    d, a = abs(distance), SHARPNESS
    if d <= 1:
        return ((a + 2) * d - (a + 3)) * d * d + 1
    return ((a * d - 5 * a) * d + 8 * a) * d - 4 * a if d < 2 else 0.0


def _shares(source: int, target: int) -> np.ndarray:
    """Return the share of each input sample in the cell of an output sample."""
    edges = np.arange(target + 1) * source / target
    out = np.zeros((target, source))
    for i in range(target):
        for k in range(int(edges[i]), min(int(np.ceil(edges[i + 1])), source)):
            out[i, k] = max(min(edges[i + 1], k + 1) - max(edges[i], k), 0.0)
    return out / out.sum(axis=1, keepdims=True)
