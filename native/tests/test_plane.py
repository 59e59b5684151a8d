"""The transforms of a plane filter it as those of deodar do, for every boundary and number of samples."""

from __future__ import annotations

import deodar_native
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.numerics.transforms import from_waves, to_waves
from deodar.numerics.waves import Waves

ROUNDING = 4e-6
PLANES = [
    (("periodic", 50, 50, 11), ("periodic", 50, 50, 11)),
    (("periodic", 100, 100, 22), ("periodic", 64, 64, 20)),
    (("zero", 30, 45, 9), ("reflect", 17, 34, 8)),
    (("reflect", 40, 80, 12), ("zero", 51, 75, 20)),
    (("periodic", 21, 21, 5), ("periodic", 22, 22, 11)),
    (("periodic", 22, 22, 11), ("periodic", 21, 21, 10)),
    (("zero", 13, 20, 10), ("reflect", 9, 18, 3)),
    (("periodic", 12, 12, 6), ("periodic", 3, 3, 1)),
    (("periodic", 2, 2, 1), ("periodic", 1, 1, 0)),
]


def filtered(forward, back, waves: tuple[Waves, Waves], y: jax.Array) -> jax.Array:
    """Multiply the modes by gains that differ between the frequencies of both axes."""
    gains = np.outer(np.exp(-0.01 * waves[0].turns ** 2), 1 / (1 + waves[1].turns))
    return back(waves, jnp.asarray(gains, jnp.float32) * forward(waves, y))


@pytest.mark.parametrize("plane", PLANES)
def test_a_filter_of_modes_equals_that_of_deodar(plane: tuple[tuple[str, int, int, int], ...]) -> None:
    outer, inner = (Waves(*axis) for axis in plane)
    y = jnp.asarray(np.random.default_rng(0).random((outer.samples, inner.samples)), jnp.float32)
    found = filtered(deodar_native.to_modes, deodar_native.from_modes, (outer, inner), y)
    expected = filtered(to_waves, from_waves, (outer, inner), y)
    np.testing.assert_allclose(found, expected, rtol=0, atol=ROUNDING)


def test_rows_and_trials_may_be_mapped() -> None:
    waves = Waves("periodic", 20, 20, 6), Waves("zero", 23, 36, 9)
    y = jnp.asarray(np.random.default_rng(1).random((2, 3, 20, 23)), jnp.float32)

    def one(y: jax.Array) -> jax.Array:
        return filtered(deodar_native.to_modes, deodar_native.from_modes, waves, y)

    found = jax.jit(jax.vmap(jax.vmap(one)))(y)
    for trial in range(2):
        for row in range(3):
            np.testing.assert_array_equal(found[trial, row], one(y[trial, row]))


def test_modes_without_a_counterpart_are_zero() -> None:
    """An axis may list a frequency more often than it has modes: such entries pad its classes."""

    class Padded:
        boundary, samples, length = "periodic", 10, 10
        turns = np.array([0, 1, 2, 1, 2, 0])

    plain = Waves("periodic", 8, 8, 2)
    y = jnp.asarray(np.random.default_rng(2).random((10, 8)), jnp.float32)
    found = np.asarray(deodar_native.to_modes((Padded(), plain), y))
    assert found.shape == (6, 5) and not found[5].any() and found[:5].all(axis=1).all()
    unpadded = Waves("periodic", 10, 10, 2)
    np.testing.assert_allclose(
        deodar_native.from_modes((Padded(), plain), jnp.asarray(found)),
        from_waves((unpadded, plain), to_waves((unpadded, plain), y)),
        rtol=0,
        atol=ROUNDING,
    )
