"""The convolution over one axis equals that of deodar up to rounding."""

from __future__ import annotations

import deodar_native
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.numerics import convolution

ROUNDING = 4e-6


@pytest.mark.parametrize("boundary", ["zero", "periodic", "reflect"])  # replicated ends have matrices only
@pytest.mark.parametrize(
    ("samples", "reach"), [(1, 0), (5, 2), (17, 8), (128, 50), (200, 57), (201, 33), (500, 249), (777, 100)]
)
def test_a_convolution_equals_that_of_deodar(samples: int, reach: int, boundary: str) -> None:
    rng = np.random.default_rng(samples)
    weights = jnp.asarray(rng.normal(size=reach + 1) / (reach + 1), jnp.float32)
    y = jnp.asarray(rng.random(samples), jnp.float32)
    found = deodar_native.line(weights, y, boundary)
    np.testing.assert_allclose(found, convolution.tapped(weights, y, boundary), rtol=0, atol=ROUNDING)


def test_rows_and_weights_may_be_mapped() -> None:
    rng = np.random.default_rng(0)
    weights = jnp.asarray(rng.normal(size=(3, 21)) / 21, jnp.float32)
    y = jnp.asarray(rng.random((4, 3, 130)), jnp.float32)
    rows = jax.vmap(lambda w, one: deodar_native.line(w, one, "reflect"))
    found = jax.jit(jax.vmap(rows, in_axes=(None, 0)))(weights, y)
    for trial in range(4):
        for row in range(3):
            alone = deodar_native.line(weights[row], y[trial, row], "reflect")
            np.testing.assert_array_equal(found[trial, row], alone)
    shared = jax.vmap(lambda one: deodar_native.line(weights[1], one, "reflect"))(y[:, 1])
    np.testing.assert_array_equal(shared, found[:, 1])
