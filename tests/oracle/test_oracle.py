"""The reference against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

import deodar as dd
from deodar.numerics.kernels.separable import Box
from tests.oracle import couplings, fields, kernels, noise

RING = dd.Axis("x", 0, 20, 40, periodic=True)


def test_a_field_without_interaction_relaxes_exponentially():
    u = fields.run(dd.Field("u", [RING], tau=10, resting_level=-5), lambda k: 3.0, 50, 0.1)
    np.testing.assert_allclose(u[:, 0], -2 - 3 * (1 - 0.1 / 10) ** np.arange(51), rtol=1e-12)


def test_a_wave_is_an_eigenvector_of_a_convolution_on_a_ring():
    x = kernels.grid(RING)[0]
    turn, sigma = 2 * math.pi / 20, 1.7
    wave = np.cos(3 * turn * x)
    found = kernels.dense([dd.Gaussian(2.0, sigma, normalized=True)], (RING,)) @ wave
    np.testing.assert_allclose(found, 2.0 * math.exp(-((3 * turn * sigma) ** 2) / 2) * wave, atol=1e-12)


@pytest.mark.parametrize("boundary", ["periodic", "reflect"])
def test_the_weights_of_a_normalized_kernel_sum_to_1(boundary):
    axis = dd.Axis("x", -1, 6, 15)
    w = kernels.dense([Box(1.0, 3.3, normalized=True, boundary=[boundary])], (axis,))
    np.testing.assert_allclose(w.sum(axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(w.sum(axis=0), 1.0, rtol=1e-12)


def test_two_shifts_equal_the_shift_by_their_sum():
    y = np.random.default_rng(0).random(40)
    twice = couplings.shift(couplings.shift(y, [RING], 7.5), [RING], 12.5)
    np.testing.assert_allclose(twice, y)


def test_normal_deviates_are_normal():
    z = np.array([noise.normals(1, 2, 3, (50,), tick) for tick in range(40)])
    assert abs(z.mean()) < 0.1 and abs(z.std() - 1) < 0.1 and len(set(z.ravel())) == z.size
