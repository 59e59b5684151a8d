"""Periods in which a stimulus is on, as steps, against a loop over the steps."""

from __future__ import annotations

import itertools

import pytest

from deodar_interop.importers.dnf_composer.sample_values import spans


def on_in(periods: list[tuple[float, float]], step: float, steps: int) -> list[int]:
    """Return the steps whose time, the sum of the steps so far, is in a period."""
    time, out = 0.0, list[int]()
    for n in range(1, steps + 1):
        time += step
        if any(begin <= time <= end for begin, end in periods):
            out.append(n)
    return out


@pytest.mark.parametrize("step", [1.0, 0.1, 0.7])
@pytest.mark.parametrize(
    "periods",
    [
        [],
        [(2, 4)],
        [(2, 4), (6, 8)],
        [(6, 8), (2, 4)],
        [(2, 5), (4, 8)],
        [(2, 9), (4, 6)],
        [(2, 9), (2, 3), (8, 12)],
        [(2, 4), (5, 7)],
        [(4, 4), (5, 5), (9, 3)],
        [(0, 3), (-5, 1)],
    ],
)
def test_spans_hold_the_steps_of_all_periods_once_and_in_order(
    periods: list[tuple[float, float]], step: float
) -> None:
    merged = spans(periods, step)
    steps = [n for first, last in merged for n in range(max(first, 1), last + 1)]
    assert steps == on_in(periods, step, 200)
    assert all(last + 1 < first for (_, last), (first, _) in itertools.pairwise(merged))
