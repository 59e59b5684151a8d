"""The convolution with a kernel that is an input."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ModelError

RANDOM = np.random.default_rng(4)
MODES = {"periodic": "wrap", "zero": "constant", "reflect": "symmetric", "replicate": "edge"}


def convolved(axes, values, places, kernel, **parameters):
    """Return the output for constant inputs."""
    model = dd.Model("convolution")
    by = model.add(dd.SteeredConvolve(name="by", **parameters))
    model.add(dd.Pattern("input", axes, values)) >> by
    model.connect(model.add(dd.Pattern("kernel", places, kernel)), by["kernel"])
    return dd.simulate(model, 1, dt=1.0, record=["by"], precision="float64")["by.output"].values[-1]


def summed(values, kernel, centres, modes, steps):
    """Return the sums written out, sample by sample."""
    reach = [k + abs(c) for k, c in zip(kernel.shape, centres, strict=True)]
    long = values
    for d, (r, mode) in enumerate(zip(reach, modes, strict=True)):
        widths = [(r, r) if k == d else (0, 0) for k in range(values.ndim)]
        long = np.pad(long, widths, mode=MODES[mode])
    out = np.zeros_like(values)
    for index in np.ndindex(*values.shape):
        for lag in np.ndindex(*kernel.shape):
            at = tuple(i + r - (j - c) for i, r, j, c in zip(index, reach, lag, centres, strict=True))
            out[index] += kernel[lag] * long[at]
    return out * np.prod(steps)


@pytest.mark.parametrize("boundary", MODES)
@pytest.mark.parametrize(("samples", "lower"), [(5, -2), (6, -2), (6, -3), (4, 0), (3, 2), (3, -6), (25, -9)])
def test_each_sample_is_the_sum_of_the_kernel_times_what_lies_at_its_lags(boundary, samples, lower):
    x = dd.Axis("x", 0, 5.5, 12)
    lags = dd.Axis("lag", 0.5 * lower, 0.5 * (lower + samples - 1), samples)
    values, kernel = RANDOM.normal(size=12), RANDOM.normal(size=samples)
    output = convolved([x], values, [lags], kernel, boundary=[boundary])
    np.testing.assert_allclose(output, summed(values, kernel, [-lower], [boundary], [0.5]), atol=1e-12)


@pytest.mark.parametrize("ends", list(itertools.combinations(MODES, 2)))
def test_two_dimensions_have_a_boundary_each(ends):
    axes = dd.Axis("x", 0, 6, 7), dd.Axis("y", 0, 4, 5)
    places = dd.Axis("right", 0, 3, 4), dd.Axis("up", 0, 2, 3)
    values, kernel = RANDOM.normal(size=(7, 5)), RANDOM.normal(size=(4, 3))
    output = convolved(axes, values, places, kernel, origin=[1.0, 2.0], boundary=ends)
    np.testing.assert_allclose(output, summed(values, kernel, [1, 2], ends, [1.0]), atol=1e-12)


def test_three_dimensions_and_a_number():
    axes = [dd.Axis(n, 0, s - 1, s) for n, s in (("x", 5), ("y", 4), ("z", 3))]
    values, kernel = RANDOM.normal(size=(5, 4, 3)), RANDOM.normal(size=(5, 4, 3))
    output = convolved(axes, values, axes, kernel, origin=1.0)
    np.testing.assert_allclose(output, summed(values, kernel, [1, 1, 1], ["zero"] * 3, [1.0]), atol=1e-12)
    model = dd.Model("numbers")
    by = model.add(dd.SteeredConvolve(name="by"))
    model.add(dd.Boost("a", [], 3.0)) >> by
    model.connect(model.add(dd.Boost("b", [], -2.0)), by["kernel"])
    assert dd.simulate(model, 1, record=["by"])["by.output"].values[-1] == -6


def test_a_peak_in_the_kernel_shifts_the_input():
    ring = dd.Axis("phi", 0, 360, 36, periodic=True)
    shifts = dd.Axis("shift", -90, 90, 19)
    seen, kernel = RANDOM.random(36), np.zeros(19)
    kernel[12] = 0.1  # 30 degrees; the integral is 1
    np.testing.assert_allclose(convolved([ring], seen, [shifts], kernel), np.roll(seen, 3), atol=1e-12)


def test_kernels_of_other_axes_are_refused():
    x, y = dd.Axis("x", 0, 9, 10), dd.Axis("y", 0, 9, 10)
    with pytest.raises(ModelError, match="not one axis for each axis of the input"):
        convolved([x], np.ones(10), [x, y], np.ones((10, 10)))
    with pytest.raises(ModelError, match="has other steps than its input"):
        convolved([x], np.ones(10), [dd.Axis("lag", 0, 2, 5)], np.ones(5))
    with pytest.raises(ModelError, match="2 boundaries for 1 axes"):
        convolved([x], np.ones(10), [x], np.ones(10), boundary=["zero", "zero"])
