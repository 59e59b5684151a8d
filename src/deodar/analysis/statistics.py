"""Statistics over runs: 95 % intervals, and tests for differences between groups."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from deodar.errors import AnalysisError
from deodar.numerics.intervals import Interval

LEVEL = 0.95

ENOUGH = 20
"""Number of runs from which the value alone decides; with fewer runs a target is missed only if the interval
excludes it.
"""


def wilson(hits: float, n: int) -> Interval | None:
    """Return the 95 % interval of a share of n runs; None without runs.

    Args:
        hits: number of successful runs; an undecided run may count half.
        n: number of runs.

    Reference:
        Wilson (1927), J. Am. Stat. Assoc. 22, 209-212.
    """
    if not 0 <= hits <= n:
        raise AnalysisError(f"{hits:g} of {n} is not a share")
    if n == 0:
        return None
    from scipy import stats  # start-up time: this takes a third of a second

    z = float(stats.norm.ppf(0.5 + LEVEL / 2))
    p, w = hits / n, z * z / n
    middle, half = (p + w / 2) / (1 + w), math.sqrt(p * (1 - p) * w + w * w / 4) / (1 + w)
    return max(0.0, middle - half), min(1.0, middle + half)


def mean_interval(values: npt.ArrayLike) -> Interval | None:
    """Return the 95 % interval of a mean by Student's distribution; None for fewer than two values."""
    v = np.asarray(values, float)
    if v.size < 2:
        return None
    from scipy import stats  # start-up time: this takes a third of a second

    half = float(stats.t.ppf(0.5 + LEVEL / 2, v.size - 1)) * float(v.std(ddof=1)) / math.sqrt(v.size)
    return float(v.mean()) - half, float(v.mean()) + half


def median_interval(values: npt.ArrayLike) -> Interval | None:
    """Return the distribution-free 95 % interval of a median, from the order statistics and the binomial
    distribution; None for fewer than six values.
    """
    from scipy import stats  # start-up time: this takes a third of a second

    v = np.sort(np.asarray(values, float))
    k = int(stats.binom.ppf((1 - LEVEL) / 2, v.size, 0.5)) if v.size else 0
    if v.size < 6 or k < 1:
        return None
    return float(v[k - 1]), float(v[v.size - k])


def ratio_interval(above: npt.ArrayLike, below: npt.ArrayLike, paired: bool = False) -> Interval | None:
    """Return the 95 % interval of median(above) / median(below), by 2000 bootstrap samples with a fixed seed.

    None for fewer than six values each.

    Args:
        above: values of the numerator.
        below: values of the denominator.
        paired: whether values with equal index are pairs, so that pairs are resampled.
    """
    a, b = np.asarray(above, float), np.asarray(below, float)
    if min(a.size, b.size) < 6:
        return None
    if paired and a.size != b.size:
        raise AnalysisError(f"paired values need the same number on both sides, not {a.size} and {b.size}")
    draw = np.random.default_rng(0)
    of_a = draw.integers(a.size, size=(2000, a.size))
    of_b = of_a if paired else draw.integers(b.size, size=(2000, b.size))
    many = np.median(a[of_a], axis=1) / np.median(b[of_b], axis=1)
    low, high = np.quantile(many, [(1 - LEVEL) / 2, 0.5 + LEVEL / 2])
    return float(low), float(high)


def difference_interval(first: npt.ArrayLike, second: npt.ArrayLike) -> Interval | None:
    """Return the 95 % interval of mean(first) - mean(second) by Welch's test; None for fewer than two values
    each, or if all are equal.
    """
    a, b = np.asarray(first, float), np.asarray(second, float)
    if min(a.size, b.size) < 2 or a.std() + b.std() == 0:
        return None
    from scipy import stats  # start-up time: this takes a third of a second

    test: Any = stats.ttest_ind(a, b, equal_var=False)
    low, high = test.confidence_interval(LEVEL)
    return float(low), float(high)


def share_difference(first: tuple[int, int], second: tuple[int, int]) -> tuple[float | None, Interval | None]:
    """Return the difference of two shares (hits, n) with its 95 % interval; None without runs.

    Reference:
        Newcombe (1998), Stat. Med. 17, 873-890, method 10.
    """
    a, b = wilson(*first), wilson(*second)
    if a is None or b is None:
        return None, None
    p, q = first[0] / first[1], second[0] / second[1]
    below, above = math.hypot(p - a[0], b[1] - q), math.hypot(a[1] - p, q - b[0])
    return p - q, (p - q - below, p - q + above)


def anova(groups: Sequence[npt.ArrayLike]) -> tuple[float, float] | None:
    """Return F and p of a one-way analysis of variance; None without two groups of at least two values, or if
    all values are equal.
    """
    samples = [np.asarray(g, float) for g in groups if np.size(g) >= 2]
    if len(samples) < 2 or not any(g.std() > 0 for g in samples):
        return None
    from scipy import stats  # start-up time: this takes a third of a second

    test: Any = stats.f_oneway(*samples)
    return float(test.statistic), float(test.pvalue)


def decided(
    value: float | None, interval: Interval | None, n: int, low: float, high: float, quick: bool = False
) -> bool | None:
    """Return whether a value is between two bounds; None if the number of runs cannot decide.

    Args:
        value: value from the runs, or None.
        interval: its 95 % interval, or None.
        n: number of runs.
        low: the lower bound, included.
        high: the upper bound, included.
        quick: whether a value outside the bounds fails only if its interval lies outside too, as with few
            runs.
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


def equivalent(interval: Interval | None, low: float, high: float) -> bool | None:
    """Return whether a number equals another within a margin, by two one-sided tests of 2.5 % each.

    True if the 95 % interval is inside the margin, False if it is outside, None if it contains a bound: then
    neither equality nor difference is shown, however large p of a test for a difference is.

    Args:
        interval: 95 % interval of the difference or ratio, or None.
        low: lower bound of the margin.
        high: upper bound of the margin.

    Reference:
        Schuirmann (1987), J. Pharmacokinet. Biopharm. 15, 657-680.
    """
    if interval is None:
        return None
    if low <= interval[0] and interval[1] <= high:
        return True
    return False if interval[1] < low or interval[0] > high else None


def larger(value: float | None, interval: Interval | None, than: float, by: float) -> bool | None:
    """Return whether a number is larger than another by a relevant amount.

    True if the 95 % interval is above `than` and the value is at least `than + by`; False if the interval
    is below `than + by`, which excludes an effect of this size; None otherwise.

    Args:
        value: the number, or None.
        interval: its 95 % interval, or None.
        than: the number to compare with.
        by: the smallest relevant amount, above 0.
    """
    if value is None or interval is None:
        return None
    if interval[1] < than + by:
        return False
    return True if interval[0] > than and value >= than + by else None


def smaller(value: float | None, interval: Interval | None, than: float, by: float) -> bool | None:
    """Return whether a number is smaller than another by a relevant amount: `larger` with all signs
    reversed.
    """
    if value is None or interval is None:
        return None
    return larger(-value, (-interval[1], -interval[0]), -than, by)


def rounded(interval: Interval | None) -> Interval | None:
    """Round an interval to four decimal places."""
    return None if interval is None else (round(interval[0], 4), round(interval[1], 4))
