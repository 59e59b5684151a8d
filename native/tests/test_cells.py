"""The means over cells equal those of deodar up to rounding."""

from __future__ import annotations

import deodar_native
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.numerics import quadrature
from deodar.numerics.axes import Axis
from deodar.numerics.sigmoids import Absolute, Logistic

ROUNDING = 4e-5
"""The mean between two close values is a quotient of small differences."""


def hill(*samples: int) -> jax.Array:
    """Return a peak of a few samples on a resting level, with noise."""
    rng = np.random.default_rng(sum(samples))
    squared = sum(
        ((at - 0.45 * n) / 2.5) ** 2
        for at, n in zip(np.meshgrid(*map(np.arange, samples), indexing="ij"), samples, strict=True)
    )
    return jnp.asarray(12 * np.exp(-squared / 2) - 5 + 0.1 * rng.normal(size=samples), jnp.float32)


def axes(samples: tuple[int, ...], periodic: tuple[bool, ...]) -> tuple[Axis, ...]:
    return tuple(Axis(name, 0, n, n, periodic=p) for name, n, p in zip("xy", samples, periodic, strict=False))


@pytest.mark.parametrize("beta", [0.5, 4.0, 100.0])
@pytest.mark.parametrize("samples", [(3,), (17,), (48,), (201,), (2, 30), (17, 5), (48, 33), (50, 64)])
@pytest.mark.parametrize("periodic", [(False, True), (True, False)])
def test_means_equal_those_of_deodar(
    samples: tuple[int, ...], periodic: tuple[bool, bool], beta: float
) -> None:
    u, g = hill(*samples), Logistic(beta, 0.5)
    over = axes(samples, periodic)
    means = quadrature.cell_means(g, u, over, deodar_native)
    np.testing.assert_allclose(means, quadrature.cell_means(g, u, over), rtol=0, atol=ROUNDING)


def test_a_far_and_a_flat_activation_have_the_output_of_every_sample() -> None:
    over = axes((40, 30), (True, True))
    for value in (-1e6, -3.0, 0.0, 0.2, 1e6):
        u = jnp.full((40, 30), value, jnp.float32)
        means = quadrature.cell_means(Logistic(), u, over, deodar_native)
        np.testing.assert_allclose(means, Logistic()(u), rtol=0, atol=ROUNDING)


def test_what_is_not_a_number_stays_one() -> None:
    u = jnp.full((40,), jnp.nan, jnp.float32)
    assert np.isnan(quadrature.cell_means(Logistic(), u, axes((40,), (True,)), deodar_native)).all()


def test_rows_and_parameters_may_be_mapped() -> None:
    u = jnp.stack([jnp.roll(hill(40, 20), k, 0) for k in range(6)]).reshape(2, 3, 40, 20)
    betas = jnp.asarray([1.0, 4.0, 40.0], jnp.float32)

    def means(beta: jax.Array, u: jax.Array) -> jax.Array:
        return deodar_native.cells(u, beta, jnp.float32(0.5), (True, False))

    mapped = jax.jit(jax.vmap(jax.vmap(means), in_axes=(None, 0)))(betas, u)
    for trial in range(2):
        for row in range(3):
            alone = means(betas[row], u[trial, row])
            np.testing.assert_array_equal(mapped[trial, row], alone)
    shared = jax.vmap(means, in_axes=(0, None))(betas, u[1, 1])
    np.testing.assert_array_equal(shared[1], mapped[1, 1])


def test_another_sigmoid_is_computed_by_jax() -> None:
    u, over = hill(40), axes((40,), (True,))
    means = quadrature.cell_means(Absolute(), u, over, deodar_native)
    np.testing.assert_array_equal(means, quadrature.cell_means(Absolute(), u, over))
