"""Resampling of a line, as dnf-composer computes it: both ends stay where they are."""

from __future__ import annotations

import numpy as np

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
