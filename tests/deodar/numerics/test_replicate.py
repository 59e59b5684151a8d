"""A field that continues beyond its ends with its outermost values, against padding."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Pattern
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import Box, MexicanHat, Shifted, TruncatedGaussian

ENDS = ["replicate"]


def convolved(values, kernels, axes):
    model = dd.Model("replicate")
    model.add(Pattern("s", axes, values)) >> model.add(dd.Convolve(kernels, name="y"))
    return dd.simulate(model, 1, dt=1, record=["y.output"], precision="float64")["y.output"].values[0]


def padded(values, along, step):
    """Return the convolution along the first axis with a function of the lag, on an array padded by four
    lengths.
    """
    n = len(values)
    wide = np.concatenate([np.repeat(values[:1], 4 * n, 0), values, np.repeat(values[-1:], 4 * n, 0)])
    lags = (np.arange(n)[:, None] + 4 * n - np.arange(9 * n)[None, :]) * step
    return step * np.tensordot(along(lags), wide, axes=1)


def gaussian(sigma, shift=0.0):
    return lambda lag: np.exp(-0.5 * ((lag - shift) / sigma) ** 2)


@pytest.mark.parametrize(
    ("kernel", "along"),
    [
        (dd.Gaussian(1.5, 2.0, boundary=ENDS), lambda lag: 1.5 * gaussian(2.0)(lag)),
        (dd.Gaussian(0.2, 9.0, boundary=ENDS), lambda lag: 0.2 * gaussian(9.0)(lag)),
        (Box(0.8, 5.0, boundary=ENDS), lambda lag: 0.8 * (abs(lag) < 2.6)),
        (
            MexicanHat(2.0, 1.5, 0.6, 4.0, boundary=ENDS),
            lambda lag: 2.0 * gaussian(1.5)(lag) - 0.6 * gaussian(4.0)(lag),
        ),
        (Shifted(dd.Gaussian(1.5, 2.0), 3.0, boundary=ENDS), lambda lag: 1.5 * gaussian(2.0, 3.0)(lag)),
        (
            TruncatedGaussian(1.5, 2.0, cutoff=2.0, boundary=ENDS),
            lambda lag: 1.5 * gaussian(2.0)(lag) * (abs(lag) <= 4),
        ),
    ],
    ids=lambda v: type(v).__name__ if hasattr(v, "boundary") else "",
)
def test_a_line_continues_with_its_outermost_values(kernel, along):
    axis = dd.Axis("x", 0, 29, 30)
    values = np.random.default_rng(1).random(30)
    np.testing.assert_allclose(
        convolved(values, [kernel], [axis]), padded(values, along, axis.step), rtol=0, atol=1e-12
    )


def test_a_plane_may_replicate_along_one_axis_only():
    x, y = dd.Axis("x", 0, 6, 13), dd.Axis("y", 0, 10, 11)
    values = np.random.default_rng(2).random((13, 11))
    kernel = dd.Gaussian(0.7, [1.0, 2.0], boundary=["replicate", "zero"])
    inside = np.arange(11)[:, None] - np.arange(11)[None, :]
    expected = 0.7 * padded(values, gaussian(1.0), x.step) @ gaussian(2.0)(inside).T
    np.testing.assert_allclose(convolved(values, [kernel], [x, y]), expected, rtol=0, atol=1e-12)


def test_a_long_field_and_a_sum_with_another_boundary_agree_too():
    axis = dd.Axis("x", 0, 299, 300)  # long enough for spectral modes and taps
    values = np.random.default_rng(3).random(300)
    kernels = [dd.Gaussian(1.0, 5.0, boundary=ENDS), dd.Gaussian(-0.5, 12.0)]
    inside = np.arange(300)[:, None] - np.arange(300)[None, :]
    expected = padded(values, gaussian(5.0), 1.0) - 0.5 * gaussian(12.0)(inside) @ values
    np.testing.assert_allclose(convolved(values, kernels, [axis]), expected, rtol=0, atol=2e-3)
    narrow = padded(values, gaussian(5.0), 1.0)
    np.testing.assert_allclose(convolved(values, kernels[:1], [axis]), narrow, rtol=0, atol=1e-12)


@pytest.mark.parametrize("count", [5, 29, 91])
def test_a_kernel_given_as_an_array_continues_too(count):
    axis = dd.Axis("x", 0, 29, 30)
    random = np.random.default_rng(count)
    values, weights = random.random((30, 5)), random.random(count)
    half = count // 2

    def along(lag):
        place = np.rint(lag).astype(int) + half
        return np.where((place >= 0) & (place < count), weights[np.clip(place, 0, count - 1)], 0.0)

    output = convolved(values[:, 0].copy(), [Custom(weights, boundary=ENDS)], [axis])
    np.testing.assert_allclose(output, padded(values[:, 0], along, 1.0), rtol=0, atol=1e-10)
    kernel = Custom(weights[:, None] * [[0.2, 1.0, 0.4]], boundary=["replicate", "periodic"])
    across = sum(np.roll(values, k, axis=1) * w for k, w in zip((-1, 0, 1), (0.2, 1.0, 0.4), strict=True))
    output = convolved(values, [kernel], [axis, dd.Axis("y", 0, 5, 5, periodic=True)])
    np.testing.assert_allclose(output, padded(across, along, 1.0), rtol=0, atol=1e-10)
