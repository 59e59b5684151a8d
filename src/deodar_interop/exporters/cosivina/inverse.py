"""The number that a function maps to a given one, to the last bit."""

from __future__ import annotations

import math
from collections.abc import Callable

NEIGHBOURS = 4
"""Number of neighbouring numbers, on both sides, among which the exact one is looked for."""


def inverse(function: Callable[[float], float], wanted: float, guess: float) -> float:
    """Return the number near a guess that a function maps exactly to `wanted`; the guess if none is."""
    up = down = guess
    for _ in range(NEIGHBOURS):
        for v in (up, down):
            if v and function(v) == wanted:
                return v
        up, down = math.nextafter(up, math.inf), math.nextafter(down, -math.inf)
    return guess
