"""The command that compares the cost model with the machine measures the stated programs."""

from __future__ import annotations

from deodar.compiler.plans import CASES, Case, measure


def test_every_strategy_is_measured_and_the_one_with_the_lowest_estimate_is_chosen() -> None:
    measured = list(measure(Case((160,), sigmas=(2.0,))))
    assert {m.method for m in measured} == {"taps", "waves", "matrices"}
    assert [m.chosen for m in measured] == [True, False, False]
    assert [m.predicted_us for m in measured] == sorted(m.predicted_us for m in measured)
    assert all(0 < m.measured_us < 1e4 for m in measured)


def test_folded_transforms_are_measured_beside_those_by_whole_bases() -> None:
    methods = {m.method: m.chosen for m in measure(Case((60, 60), sigmas=(3.0,)))}
    others = dict.fromkeys(("waves", "matrices", "fourier", "taps"), False)
    assert methods == {"waves, folded": True, **others}


def test_cases_reach_from_a_line_to_a_volume() -> None:
    assert {len(c.samples) for c in CASES} == {1, 2, 3} and len({str(c) for c in CASES}) == len(CASES)
