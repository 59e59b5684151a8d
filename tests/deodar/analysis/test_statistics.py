"""Intervals against published numbers and against simulation, and decisions from few runs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from deodar.analysis import statistics
from deodar.errors import AnalysisError


def test_wilson_is_the_published_interval():
    # scipy computes it too; 81 of 263 is the example of Newcombe (1998), Stat. Med. 17, 857
    low, high = statistics.wilson(81, 263)
    assert (round(low, 4), round(high, 4)) == (0.2553, 0.3662)
    wilson = stats.binomtest(19, 20).proportion_ci(method="wilson")
    assert statistics.wilson(19, 20) == pytest.approx((wilson.low, wilson.high))


def test_the_wilson_interval_is_correct_for_shares_of_0_and_1():
    assert statistics.wilson(0, 0) is None
    assert statistics.wilson(0, 10)[0] == 0.0 and statistics.wilson(10, 10)[1] == pytest.approx(1.0)
    with pytest.raises(AnalysisError):
        statistics.wilson(11, 10)


def test_the_intervals_contain_the_true_value_as_often_as_stated():
    draw = np.random.default_rng(1)
    samples = draw.lognormal(size=(2000, 20))
    middle = [statistics.median_interval(s) for s in samples]
    assert np.mean([low <= 1.0 <= high for low, high in middle]) >= 0.94
    normal = [statistics.mean_interval(s) for s in draw.normal(size=(2000, 20))]
    assert 0.93 < np.mean([low <= 0.0 <= high for low, high in normal]) < 0.97


def test_too_few_values_have_no_interval():
    assert statistics.mean_interval([1.0]) is None
    assert statistics.median_interval([1, 2, 3, 4, 5]) is None
    assert statistics.ratio_interval([1.0] * 5, [1.0] * 9) is None


def test_the_interval_of_a_ratio_contains_the_ratio():
    draw = np.random.default_rng(2)
    low, high = statistics.ratio_interval(2 + 0.1 * draw.normal(size=60), 1 + 0.1 * draw.normal(size=60))
    assert low < 2.0 < high and high - low < 0.3


def test_anova_distinguishes_groups():
    draw = np.random.default_rng(3)
    same = [draw.normal(size=30) for _ in range(3)]
    assert statistics.anova(same)[1] > 0.05
    assert statistics.anova([same[0], same[1] + 3])[1] < 1e-6
    assert statistics.anova([[1.0, 1.0], [1.0, 1.0]]) is None and statistics.anova([[1.0, 2.0]]) is None


def test_a_claim_is_decided_only_by_enough_runs():
    decided = statistics.decided
    assert decided(None, None, 0, 0, 1) is None
    assert decided(0.97, (0.9, 0.99), 100, 0.95, 1) is True
    assert decided(0.94, (0.88, 0.97), 100, 0.95, 1) is False  # all runs: the value decides
    assert decided(0.94, (0.88, 0.97), 100, 0.95, 1, quick=True) is None
    assert decided(0.5, (0.3, 0.7), 20, 0.95, 1, quick=True) is False  # excluded
    assert decided(1.0, (0.4, 1.0), 3, 0.9, 1) is None
    assert decided(0.0, (0.0, 0.56), 3, 0.9, 1) is False
    assert decided(212, (210, 214), 12, 189, 231) is True  # the interval lies inside


def test_equality_is_shown_by_two_one_sided_tests_and_not_by_a_large_p():
    draw = np.random.default_rng(1)
    few = [draw.normal(1.1, 0.1, 6), draw.normal(1.1, 0.1, 6)]
    assert statistics.anova(few)[1] > 0.05  # no difference is found, and none is excluded
    assert statistics.equivalent(statistics.difference_interval(*few), -0.05, 0.05) is None
    many = [draw.normal(1.1, 0.1, 400), draw.normal(1.1, 0.1, 400)]
    assert statistics.equivalent(statistics.difference_interval(*many), -0.05, 0.05) is True
    apart = [draw.normal(1.1, 0.1, 400), draw.normal(1.2, 0.1, 400)]
    assert statistics.equivalent(statistics.difference_interval(*apart), -0.05, 0.05) is False
    assert statistics.equivalent(None, -0.05, 0.05) is None
    # the same decision as two one-sided t tests at 2.5 %
    for a, b in (few, many, apart):
        p = max(stats.ttest_ind(a + 0.05, b, equal_var=False, alternative="greater").pvalue,
                stats.ttest_ind(a - 0.05, b, equal_var=False, alternative="less").pvalue)  # fmt: skip
        assert (p <= 0.025) == (
            statistics.equivalent(statistics.difference_interval(a, b), -0.05, 0.05) is True
        )


def test_an_inequality_fails_if_the_difference_is_too_small():
    larger, smaller = statistics.larger, statistics.smaller
    assert larger(0.3, (0.2, 0.4), 0.0, 0.1) is True
    assert larger(0.0, (-0.02, 0.02), 0.0, 0.1) is False  # an effect of 0.1 is excluded
    assert larger(0.05, (0.01, 0.09), 0.0, 0.1) is False  # significant, and too small
    assert larger(0.3, (-0.1, 0.7), 0.0, 0.1) is None and larger(0.08, (0.01, 0.15), 0.0, 0.1) is None
    assert larger(None, None, 0.0, 0.1) is None
    assert smaller(0.7, (0.6, 0.8), 1.0, 0.05) is True and smaller(1.0, (0.97, 1.03), 1.0, 0.05) is False


def test_the_interval_of_a_difference_of_shares_is_the_published_one():
    # Newcombe (1998), table II, method 10, example (a)
    difference, (low, high) = statistics.share_difference((56, 70), (48, 80))
    assert difference == pytest.approx(0.2) and (low, high) == (
        pytest.approx(0.0524, abs=1e-4),
        pytest.approx(0.3339, abs=1e-4),
    )
    assert statistics.share_difference((0, 0), (1, 2)) == (None, None)


def test_paired_values_give_a_narrower_interval_of_a_ratio():
    draw = np.random.default_rng(2)
    base = draw.uniform(1.0, 2.0, 80)
    similar = base * draw.normal(1.0, 0.01, 80)
    loose, tight = (
        statistics.ratio_interval(similar, base),
        statistics.ratio_interval(similar, base, paired=True),
    )
    assert tight[1] - tight[0] < 0.5 * (loose[1] - loose[0]) and tight[0] < 1 < tight[1]
    with pytest.raises(AnalysisError, match="the same number on both sides"):
        statistics.ratio_interval(similar, base[:7], paired=True)
