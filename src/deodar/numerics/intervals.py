"""Intervals of numbers: between which values a signal must lie."""

from __future__ import annotations

import math

Interval = tuple[float, float]
"""Lowest and highest value."""

ANY: Interval = (-math.inf, math.inf)
ZERO: Interval = (0.0, 0.0)


def signed(value: float) -> Interval:
    """From 0 to a value of either sign."""
    return min(0.0, value), max(0.0, value)


def hull(*parts: Interval) -> Interval:
    """The smallest interval that holds all of them."""
    return min(p[0] for p in parts), max(p[1] for p in parts)


def total(*parts: Interval) -> Interval:
    """The interval of a sum."""
    return sum(p[0] for p in parts), sum(p[1] for p in parts)


def times(a: Interval, b: Interval) -> Interval:
    """The interval of a product; 0 times anything is 0."""
    corners = [0.0 if x == 0 or y == 0 else x * y for x in a for y in b]
    return min(corners), max(corners)
