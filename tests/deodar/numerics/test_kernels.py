"""Kernels: integrals, narrow and wide kernels, and boundaries."""

from __future__ import annotations

import math

import jax
import numpy as np
import pytest

from deodar import Axis, Gaussian
from deodar.numerics import interaction
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import Box, MexicanHat, Shifted

RING = Axis("phi", 0, 12, 24, periodic=True)
LINE = Axis("x", -20, 20, 161)


def convolved(kernel, axes, y):
    with jax.enable_x64(True):
        mixture = interaction.mix([kernel], axes, interaction.prepare([kernel], axes, np.dtype("float64")))
        return np.asarray(interaction.apply(mixture, axes, jax.numpy.asarray(y, float)))


def integral(kernel, axes, boundary=None):
    """Return the integral of a kernel: its convolution with ones, far from every border."""
    n = tuple(a.samples for a in axes)
    y = np.zeros(n)
    y[tuple(k // 2 for k in n)] = 1.0
    return convolved(kernel, axes, y).sum()


WIDTHS = [2e-6, 1e-3, 0.05, 0.1, 0.24, 0.25, 0.5, 1.0, 2.0]


@pytest.mark.parametrize("width", WIDTHS)
def test_normalized_means_an_integral_of_the_amplitude_at_every_width(width):
    for kernel in (
        Gaussian(3.0, width / 2, normalized=True),
        Box(3.0, width, normalized=True),
        Shifted(Box(3.0, width, normalized=True), 0.7),
    ):
        assert integral(kernel, (LINE,)) == pytest.approx(3.0, rel=1e-9), kernel
    hat = MexicanHat(5.0, width / 2, 2.0, width, normalized=True)
    assert integral(hat, (LINE,)) == pytest.approx(3.0, rel=1e-9)


@pytest.mark.parametrize("width", [0.5, 1.0, 2.0])
def test_the_integral_of_a_gaussian_follows_from_its_amplitude_and_width(width):
    assert integral(Gaussian(3.0, width / 2), (LINE,)) == pytest.approx(
        3.0 * math.sqrt(2 * math.pi) * width / 2, rel=1e-8
    )


@pytest.mark.parametrize("axis", [LINE, RING], ids=["line", "ring"])
@pytest.mark.parametrize("steps", [1e-5, 0.01, 0.1, 0.3, 0.5, 0.7, 0.99, 1.0, 1.2, 2.0])
def test_a_gaussian_narrower_than_the_grid_has_its_true_integral(axis, steps):
    sigma = steps * axis.step
    assert integral(Gaussian(3.0, sigma), (axis,)) == pytest.approx(
        3.0 * math.sqrt(2 * math.pi) * sigma, rel=1e-8
    )
    hat = MexicanHat(5.0, sigma, 2.0, 2 * sigma)
    assert integral(hat, (axis,)) == pytest.approx((5.0 - 2 * 2.0) * math.sqrt(2 * math.pi) * sigma, rel=1e-7)


def test_a_gaussian_that_the_grid_resolves_is_its_samples_to_the_last_digit():
    y = np.zeros(161)
    y[80] = 1.0
    for sigma in (LINE.step, 1.3 * LINE.step, 2.0):
        sampled = 3.0 * np.exp(-0.5 * ((LINE.points - LINE.points[80]) / sigma) ** 2) * LINE.step
        assert np.abs(convolved(Gaussian(3.0, sigma), (LINE,), y) - sampled).max() < 1e-13


@pytest.mark.parametrize("width", [0.01, 0.1, 0.25, 0.3, 0.37, 1.0, 1.1, 7.77])
def test_the_integral_of_a_box_is_exact_at_any_width(width):
    assert integral(Box(2.0, width), (LINE,)) == pytest.approx(2.0 * width, rel=1e-12)
    assert integral(Box(2.0, width), (RING,)) == pytest.approx(2.0 * width, rel=1e-12)


@pytest.mark.parametrize("width", [11.9, 12.0, 12.1, 18.0, 23.9, 24.0, 25.0, 30.0, 1000.0])
def test_a_box_wider_than_a_ring_wraps_around_it(width):
    assert integral(Box(2.0, width), (RING,)) == pytest.approx(2.0 * width, rel=1e-12)


def test_a_very_wide_gaussian_on_a_ring_is_uniform():
    y = np.random.default_rng(0).random(24)
    for sigma in (50.0, 1e3, 1e6):
        seen = convolved(Gaussian(1.0, sigma, normalized=True), (RING,), y)
        np.testing.assert_allclose(seen, y.mean() * np.ones(24), rtol=1e-12)


@pytest.mark.parametrize("sigma", [0.1, 0.4, 1.0, 3.0, 5.99, 6.0, 6.01, 9.0, 40.0])
def test_a_normalized_gaussian_on_a_ring_keeps_the_integral(sigma):
    y = np.random.default_rng(1).random(24)
    assert convolved(Gaussian(1.0, sigma, normalized=True), (RING,), y).sum() == pytest.approx(
        y.sum(), rel=1e-12
    )


KERNELS = [
    Gaussian(1.0, 0.1, normalized=True, boundary=["reflect"]),
    Gaussian(1.0, 6.0, normalized=True, boundary=["reflect"]),
    Gaussian(1.0, 200.0, normalized=True, boundary=["reflect"]),
    Box(1.0, 3.3, normalized=True, boundary=["reflect"]),
    Box(1.0, 77.7, normalized=True, boundary=["reflect"]),
    MexicanHat(2.0, 1.0, 1.0, 5.0, normalized=True, boundary=["reflect"]),
    Custom(np.array([1, 2, 4, 2, 1]) / 10 / LINE.step, boundary=["reflect"]),
]


@pytest.mark.parametrize(
    "kernel", KERNELS, ids=lambda k: f"{type(k).__name__} {getattr(k, 'sigma', getattr(k, 'width', ''))}"
)
def test_the_boundary_reflect_keeps_integrals_and_constants(kernel):
    """A reflecting border keeps integrals, and a homogeneous field stays homogeneous."""
    y = np.random.default_rng(2).random(161)
    assert convolved(kernel, (LINE,), y).sum() == pytest.approx(y.sum(), rel=1e-12)
    np.testing.assert_allclose(convolved(kernel, (LINE,), np.ones(161)), 1.0, rtol=1e-12)


def test_zero_boundaries_drop_values_beyond_the_ends():
    y = np.zeros(161)
    y[0] = 1.0
    assert convolved(Gaussian(1.0, 2.0, normalized=True), (LINE,), y).sum() == pytest.approx(0.5, abs=0.03)


def test_a_shifted_kernel_acts_at_x_plus_shift():
    y = np.zeros(161)
    y[20] = 1.0
    assert convolved(Shifted(Gaussian(1.0, 0.5), 3.0), (LINE,), y).argmax() == 32
    lopsided = convolved(Custom([0.0, 0.0, 0.0, 0.0, 1.0]), (LINE,), y)
    assert lopsided.argmax() == 22


def test_resolution_does_not_change_a_kernel():
    """The same kernel on a grid of half the step gives the same integral at the same positions."""
    for kernel in (Gaussian(1.0, 1.5), Box(1.0, 3.0), MexicanHat(2, 1, 1, 2)):
        seen = []
        for n in (81, 161):
            axis = Axis("x", -10, 10, n)
            seen.append(convolved(kernel, (axis,), np.exp(-((axis.points - 1) ** 2)))[:: (n - 1) // 80])
        np.testing.assert_allclose(seen[0], seen[1], atol=4e-3 * abs(seen[0]).max())


def test_large_reach_of_a_custom_kernel_on_a_ring_wraps():
    kernel = Custom(np.ones(2 * 24 * 3 + 1) / (RING.step * (2 * 24 * 3 + 1)))
    y = np.zeros(24)
    y[3] = 1.0
    seen = convolved(kernel, (RING,), y)
    assert seen.sum() == pytest.approx(1.0, rel=1e-12) and np.ptp(seen) < 0.01
