"""The matrices that correlate noise, without random numbers: their covariance is F F^T."""

from __future__ import annotations

import functools

import jax
import numpy as np
import pytest

from deodar import Axis
from deodar.numerics import noise

LINE = Axis("x", 0, 99, 100)
RING = Axis("x", 0, 100, 100, periodic=True)


@functools.cache
def covariance(axis, length, dtype="float64"):
    with jax.enable_x64(dtype == "float64"):
        f = np.asarray(noise.correlation((axis,), (length,), np.dtype(dtype))[0], float)
    return f @ f.T


def correlation(axis, length):
    d = axis.points[:, None] - axis.points[None]
    if axis.periodic:
        d = d - axis.range * np.round(d / axis.range)
    return np.exp(-(d**2) / (2 * length**2))


@pytest.mark.parametrize("length", [0.1, 0.5, 1.0, 2.0, 6.0, 30.0, 500.0])
@pytest.mark.parametrize("axis", [LINE, RING], ids=["line", "ring"])
def test_the_variance_is_one_at_every_point(axis, length):
    assert abs(np.diag(covariance(axis, length)) - 1).max() < 1e-12
    assert abs(np.diag(covariance(axis, length, "float32")) - 1).max() < 1e-5


@pytest.mark.parametrize("length", [1.5, 2.0, 6.0, 12.5])
def test_the_correlation_on_a_ring_is_a_gaussian(length):
    assert abs(covariance(RING, length) - correlation(RING, length)).max() < 3e-3


@pytest.mark.parametrize("length", [0.5, 1.5, 2.0, 6.0, 12.0, 40.0])
def test_the_correlation_on_a_line_is_a_gaussian_up_to_its_ends(length):
    assert abs(covariance(LINE, length) - correlation(LINE, length)).max() < 1e-9
    assert abs(covariance(LINE, length, "float32") - correlation(LINE, length)).max() < 1e-4


def test_correlated_noise_does_not_depend_on_the_grid():
    fine = Axis("x", 0, 99, 199)
    assert abs(covariance(fine, 6.0)[::2, ::2] - covariance(LINE, 6.0)).max() < 1e-9
