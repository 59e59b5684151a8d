"""Resampling between grids: interpolation, and reductions over axes."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar import Axis
from deodar.numerics import resampling

LINE = Axis("x", 0, 10, 11)
RING = Axis("x", 0, 12, 12, periodic=True)


def weights(axis, points, method="linear", dtype=jnp.float64):
    # one program: each operation alone would be compiled by itself
    compiled = jax.jit(lambda points: resampling.weights(axis, points, method, dtype))
    with jax.enable_x64(dtype == jnp.float64):
        return np.asarray(compiled(np.asarray(points, float)))


@pytest.mark.parametrize("method", resampling.INTERPOLATIONS)
@pytest.mark.parametrize("axis", [LINE, RING], ids=["line", "ring"])
def test_resampling_to_the_same_grid_keeps_the_samples(axis, method):
    assert np.array_equal(weights(axis, axis.points, method), np.eye(axis.samples))


@pytest.mark.parametrize("dtype", [jnp.float32, jnp.float64])
@pytest.mark.parametrize("samples", [3, 7, 100, 641])
def test_the_last_sample_is_within_reach_of_any_sampling(samples, dtype):
    """Rounding never moves the last sample of an axis beyond the other axis."""
    fine = Axis("x", 0.1, 0.7, samples)
    for method in resampling.INTERPOLATIONS:
        np.testing.assert_allclose(
            weights(Axis("x", 0.1, 0.7, 13), fine.points, method, dtype).sum(1), 1.0, atol=2e-5
        )


def test_linear_resampling_of_a_line_is_exact():
    points = np.linspace(0, 10, 37)
    np.testing.assert_allclose(
        weights(LINE, points) @ (3 - 2 * LINE.points), 3 - 2 * points, rtol=1e-12, atol=1e-12
    )


def test_linear_resampling_interpolates_across_the_ends_of_a_ring():
    w = weights(RING, [11.25])
    assert w[0, 11] == 0.75 and w[0, 0] == 0.25
    np.testing.assert_allclose(weights(RING, [-0.75, 35.25]), np.stack([w[0], w[0]]), atol=1e-12)


def test_nearest_takes_the_upper_of_two_equidistant_samples():
    w = weights(LINE, [2.4, 2.5, 2.6, -0.5, 10.4], "nearest")
    assert w.argmax(1).tolist() == [2, 3, 3, 0, 10] and np.array_equal(w.sum(1), np.ones(5))
    assert weights(RING, [11.5, -0.5, -0.6], "nearest").argmax(1).tolist() == [0, 0, 11]


def test_values_beyond_the_ends_are_zero():
    """Zeros follow the last sample: linear weights fall to zero within one cell, nearest weights within
    half a cell.
    """
    assert not weights(LINE, [-1, 11, 400]).any()
    assert weights(LINE, [-0.25])[0, 0] == 0.75
    assert not weights(LINE, [-0.6, 10.5], "nearest").any()


def test_a_ring_of_one_sample_is_constant():
    point = Axis("x", 0, 5, 1, periodic=True)
    for method in resampling.INTERPOLATIONS:
        assert np.array_equal(weights(point, [0, 1.3, 2.5, 4.9], method), np.ones((4, 1)))


def test_every_reduction_agrees_with_numpy():
    y = jnp.asarray(np.random.default_rng(0).random((4, 5)), jnp.float32)
    axis = Axis("y", 0, 2, 5)
    expected = {
        "integral": y.sum(1) * 0.5,
        "sum": y.sum(1),
        "mean": y.mean(1),
        "max": y.max(1),
        "min": y.min(1),
    }
    assert set(expected) == set(resampling.REDUCTIONS)
    for method, number in expected.items():
        np.testing.assert_allclose(resampling.reduce(y, 1, axis, method), number, rtol=1e-6)
