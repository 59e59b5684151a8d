"""What the benchmarks of grids compare is the same field on two grids."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import grid_noise
import grids

SETS = [(dimensions, name) for dimensions, sets in grids.PARAMETERS.items() for name in sets]


@pytest.mark.parametrize(("dimensions", "name"), SETS)
def test_both_grids_have_the_same_length_and_the_stated_steps(dimensions: int, name: str) -> None:
    p = grids.PARAMETERS[dimensions][name]
    for coarse in grids.COARSE[dimensions]:
        step = p.kernel / coarse
        for centred in (False, True):
            for offset in grids.PLACES[dimensions]:
                axes = [
                    grids.Task(p, width, dd.Logistic(4.0), "cell", offset, step).axes(centred=centred)
                    for width in (coarse, grids.FINE[dimensions])
                ]
                for one, two in zip(*axes, strict=True):
                    assert one.range == two.range
                    assert math.isclose(one.step, step)
                    assert math.isclose(two.step, p.kernel / grids.FINE[dimensions], rel_tol=0.02)


def test_a_peak_without_input_is_on_a_sample_or_between_two() -> None:
    p = grids.PARAMETERS[2]["first"]
    task = grids.Task(p, 2.5, dd.Logistic(4.0), "cell", (0.0, 0.5), p.kernel / 2.5)
    on, between = (float(a.points.mean()) / a.step % 1 for a in task.axes(centred=True))
    assert math.isclose(on, 0.0, abs_tol=1e-9)
    assert math.isclose(between, 0.5)


@pytest.mark.parametrize(
    ("errors", "within"), [((0.1, -0.2), True), ((0.1, -0.3), False), ((math.nan,), False)]
)
def test_a_row_keeps_its_limit_if_all_errors_do(errors: tuple[float, ...], within: bool) -> None:
    row = grids.Row(("first", "logistic 4", "detection", "2.5", "cell"), 4.0, errors, 0.2)
    assert row.within is within
    assert ("kept" in row.line()) is within


def test_noise_is_the_same_function_on_two_grids_and_has_the_stated_correlation() -> None:
    coarse, fine = (grid_noise.modes(dd.Axis("x", 0, 100, n, periodic=True), 24) for n in (50, 200))
    np.testing.assert_allclose(coarse, fine[::4], atol=1e-12)
    distance = 0.5 * np.arange(40)
    stated = np.exp(-(distance**2) / (2 * grid_noise.CORRELATION**2))
    np.testing.assert_allclose((fine @ fine[0])[:40], stated, atol=1e-4)
