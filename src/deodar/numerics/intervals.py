"""Intervals of numbers, for bounds of signals."""

from __future__ import annotations

import math

Interval = tuple[float, float]
"""The lowest and the highest value."""

ANY: Interval = (-math.inf, math.inf)
ZERO: Interval = (0.0, 0.0)


def signed(value: float) -> Interval:
    """Return the interval from 0 to a value of either sign."""
    return min(0.0, value), max(0.0, value)


def hull(*parts: Interval) -> Interval:
    """Return the smallest interval that contains all intervals."""
    return min(p[0] for p in parts), max(p[1] for p in parts)


def total(*parts: Interval) -> Interval:
    """Return the interval of a sum."""
    return sum(p[0] for p in parts), sum(p[1] for p in parts)


def times(a: Interval, b: Interval) -> Interval:
    """Return the interval of a product; 0 times infinity is 0."""
    corners = [0.0 if x == 0 or y == 0 else x * y for x in a for y in b]
    return min(corners), max(corners)
