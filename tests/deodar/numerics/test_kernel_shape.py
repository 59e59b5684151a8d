"""The shape of kernels over the lag, against their formulas."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.numerics.kernel_shape import kernel_shape, lag_axis

X = dd.Axis("x", 0, 10, samples=11, unit="deg")
Y = dd.Axis("y", 0, 4, samples=5)
HUE = dd.Axis("hue", 0, 360, samples=36, periodic=True)


def test_lags_reach_over_the_whole_axis_in_both_directions() -> None:
    lags = lag_axis(X)
    assert (lags.name, lags.unit, lags.lower, lags.upper, lags.samples) == ("lag in x", "deg", -10, 10, 21)
    assert np.allclose(lags.points, np.arange(-10, 11))
    ring = lag_axis(HUE)
    assert (ring.lower, ring.upper, ring.samples, ring.periodic) == (-180, 180, 37, False)


def test_kernels_are_summed() -> None:
    kernels = [dd.Gaussian(3.0, 2.0), dd.Gaussian(-1.0, 5.0)]
    (lags,), weights = kernel_shape(kernels, (X,))
    d = lags.points
    expected = 3 * np.exp(-0.5 * (d / 2) ** 2) - np.exp(-0.5 * (d / 5) ** 2)
    assert np.allclose(weights, expected, atol=1e-5)
    assert np.array_equal(kernel_shape([], (X,))[1], np.zeros(21))


def test_a_kernel_over_three_axes_is_a_plane_at_lag_0_on_the_third() -> None:
    (x, y), weights = kernel_shape([dd.Gaussian(2.0, (2.0, 1.0, 30.0))], (X, Y, HUE))
    expected = 2 * np.exp(-0.5 * np.add.outer((x.points / 2) ** 2, y.points**2))
    assert weights.shape == (21, 9)
    assert np.allclose(weights, expected, atol=1e-5)


def test_a_kernel_on_a_periodic_axis_wraps() -> None:
    (lags,), weights = kernel_shape([dd.Gaussian(1.0, 150.0)], (HUE,))
    images = [np.exp(-0.5 * ((lags.points + 360 * k) / 150) ** 2) for k in range(-9, 10)]
    assert np.allclose(weights, np.sum(images, axis=0), atol=1e-4)


@pytest.mark.parametrize("count", [3, 41])
def test_an_array_of_weights_is_centred_on_lag_0(count: int) -> None:
    numbers = np.random.default_rng(0).normal(size=count)
    (lags,), weights = kernel_shape([dd.Custom(numbers, amplitude=2.0)], (X,))
    middle = count // 2
    for k, lag in enumerate(np.rint(lags.points).astype(int)):
        inside = abs(lag) <= middle
        assert weights[k] == pytest.approx(2 * numbers[middle + lag] if inside else 0.0, abs=1e-5)
