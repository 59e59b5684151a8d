"""Numbers from runs with their 95 % intervals, and whether groups of runs differ."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from scipy import stats

from deodar.analysis.claims import Claim
from deodar.errors import AnalysisError

Interval = tuple[float, float]
LEVEL = 0.95

ENOUGH = 20
"""Runs from which on the value alone decides; with fewer a target is missed only where the interval excludes it."""


def wilson(hits: float, n: int) -> Interval | None:
    """95 % interval of a share of n runs; None without runs.

    Args:
        hits: how many runs count; a run that is undecided may count half.
        n: how many runs there are.

    Reference:
        Wilson (1927), J. Am. Stat. Assoc. 22, 209-212.
    """
    if not 0 <= hits <= n:
        raise AnalysisError(f"{hits:g} of {n} is no share")
    if n == 0:
        return None
    z = float(stats.norm.ppf(0.5 + LEVEL / 2))
    p, w = hits / n, z * z / n
    middle, half = (p + w / 2) / (1 + w), math.sqrt(p * (1 - p) * w + w * w / 4) / (1 + w)
    return max(0.0, middle - half), min(1.0, middle + half)


def mean_interval(values: Any) -> Interval | None:
    """95 % interval of a mean by Student's distribution; None of fewer than two values."""
    v = np.asarray(values, float)
    if v.size < 2:
        return None
    half = float(stats.t.ppf(0.5 + LEVEL / 2, v.size - 1)) * float(v.std(ddof=1)) / math.sqrt(v.size)
    return float(v.mean()) - half, float(v.mean()) + half


def median_interval(values: Any) -> Interval | None:
    """95 % interval of a median, free of any distribution: between the values that hold it by the binomial law; None of fewer than six."""
    v = np.sort(np.asarray(values, float))
    k = int(stats.binom.ppf((1 - LEVEL) / 2, v.size, 0.5)) if v.size else 0
    if v.size < 6 or k < 1:
        return None
    return float(v[k - 1]), float(v[v.size - k])


def ratio_interval(above: Any, below: Any) -> Interval | None:
    """95 % interval of median(above) / median(below), by 2000 resamplings of a fixed seed; None of fewer than six values each."""
    a, b = np.asarray(above, float), np.asarray(below, float)
    if min(a.size, b.size) < 6:
        return None
    draw = np.random.default_rng(0)
    many = [np.median(draw.choice(a, a.size)) / np.median(draw.choice(b, b.size)) for _ in range(2000)]
    low, high = np.quantile(many, [(1 - LEVEL) / 2, 0.5 + LEVEL / 2])
    return float(low), float(high)


def anova(groups: Sequence[Any]) -> tuple[float, float] | None:
    """F and p of a one-way analysis of variance; None unless there are two groups of two values, not all of them equal."""
    found = [np.asarray(g, float) for g in groups if np.size(g) >= 2]
    if len(found) < 2 or not any(g.std() > 0 for g in found):
        return None
    result: Any = stats.f_oneway(*found)
    return float(result.statistic), float(result.pvalue)


def decided(value: float | None, interval: Interval | None, n: int, low: float, high: float, quick: bool = False) -> bool | None:
    """Whether a value lies between two bounds; None where so few runs cannot decide.

    Args:
        value: what the runs gave, or None.
        interval: its 95 % interval, or None.
        n: how many runs it rests on.
        low: the lower bound, which is allowed.
        high: the upper one, which is too.
        quick: a value that misses is held against it only where the interval excludes what is allowed, as with few runs.
    """
    if value is None or n == 0:
        return None
    met = low <= value <= high
    if interval is not None and (interval[1] < low or interval[0] > high):
        return False
    sure = interval is not None and low <= interval[0] and interval[1] <= high
    if sure or (n >= ENOUGH and (met or not quick)):
        return met
    return None


def share(
    name: str, hits: int, n: int, at_least: float, kind: Literal["required", "reported"] = "required", source: str = "", quick: bool = False
) -> Claim:
    """The claim that at least such a share of runs does something."""
    interval = wilson(hits, n)
    value = round(hits / n, 4) if n else None
    target = f">= {at_least:g}"
    return Claim(name, value, target, decided(value, interval, n, at_least, 1.0, quick), kind, source, n, rounded(interval))


def rounded(interval: Interval | None) -> Interval | None:
    """An interval to four digits after the point."""
    return None if interval is None else (round(interval[0], 4), round(interval[1], 4))
