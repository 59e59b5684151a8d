"""Arrays that are continued beyond the ends of an axis, against numpy."""

from __future__ import annotations

import numpy as np
import pytest

from deodar.numerics.quadrature import continued


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("by", [1, 2, 3, 4, 7])
def test_a_periodic_axis_goes_round_also_more_than_once(axis: int, by: int) -> None:
    y = np.random.default_rng(0).normal(size=(3, 4)).astype("float32")
    widths = [(by, by) if d == axis else (0, 0) for d in range(2)]
    assert np.array_equal(continued(y, axis, by, periodic=True), np.pad(y, widths, mode="wrap"))  # type: ignore[arg-type]


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("by", [1, 2, 5])
def test_another_axis_goes_on_in_a_straight_line(axis: int, by: int) -> None:
    y = np.random.default_rng(0).normal(size=(3, 4)).astype("float32")
    wide = np.moveaxis(np.asarray(continued(y, axis, by, periodic=False)), axis, 0)  # type: ignore[arg-type]
    inner = np.moveaxis(y, axis, 0)
    n = len(inner)
    assert np.array_equal(wide[by : by + n], inner)
    slopes = np.diff(wide, axis=0)
    assert np.allclose(slopes[:by], inner[1] - inner[0], atol=1e-5)
    assert np.allclose(slopes[by + n - 1 :], inner[-1] - inner[-2], atol=1e-5)
