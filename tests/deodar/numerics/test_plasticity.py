"""Reading and changing weights: one copy by its active rows, whole batches and batches of batches follow
the same rule.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.numerics.axes import Axis
from deodar.numerics.patches import random_weights
from deodar.numerics.plasticity import RULES, after, change, learn, read

RNG = np.random.default_rng(5)


def active(*shape):
    """Return an activation with half of the positions silent."""
    return np.maximum(RNG.standard_normal(shape), 0).astype(np.float32)


W, PRE, POST = RNG.standard_normal((2, 3, 6, 5)).astype(np.float32), active(2, 3, 6), active(2, 3, 5)
PRE[0, 1], POST[1, 2] = 0, 0


def test_weights_are_read_in_nested_batches():
    expected = np.einsum("abi,abij->abj", PRE, W)
    np.testing.assert_allclose(jax.vmap(jax.vmap(read))(W, PRE), expected, atol=1e-5)
    np.testing.assert_allclose(jax.vmap(read)(W[0], PRE[0]), expected[0], atol=1e-5)
    np.testing.assert_allclose(read(W[0, 0], PRE[0, 0]), expected[0, 0], atol=1e-5)
    np.testing.assert_allclose(
        jax.vmap(read, in_axes=(None, 0))(W[0, 0], PRE[0]), PRE[0] @ W[0, 0], atol=1e-5
    )
    assert not np.any(read(W[0, 1], PRE[0, 1]))


@pytest.mark.parametrize("rule", RULES)
def test_weights_are_learned_in_nested_batches(rule):
    def row(w, x, y):
        return learn(rule, w, x, y, jnp.float32(0.1), jnp.float32(0.02), jnp.float32(0.6))

    # one program each: each operation alone would be compiled by itself
    rows = jax.vmap(row)
    of_rows, of_row = jax.jit(rows), jax.jit(row)
    weights = np.asarray(jax.jit(jax.vmap(rows))(W, PRE, POST))
    for a in range(2):
        np.testing.assert_allclose(of_rows(W[a], PRE[a], POST[a]), weights[a], atol=1e-6)
        for b in range(3):
            np.testing.assert_allclose(of_row(W[a, b], PRE[a, b], POST[a, b]), weights[a, b], atol=1e-6)
    for silent in ((0, 1), (1, 2)):
        assert np.array_equal(weights[silent], W[silent])
    assert not np.array_equal(weights[0, 0], W[0, 0])


@pytest.mark.parametrize("rule", ["outstar", "association", "instar"])
def test_a_step_longer_than_the_relaxation_time_ends_at_the_attractor(rule):
    assert change(rule, 5.0, 1.0, 1.0, 30.0, 0.0) == pytest.approx(1.0)


@pytest.mark.parametrize("loss", [1.0, 30.0])
def test_a_step_longer_than_the_time_of_the_loss_loses_all_weights_and_no_more(loss):
    assert change("hebb", 5.0, 1.0, 1.0, 0.5, loss) == pytest.approx(0.5)


def test_after_returns_its_first_argument():
    assert after(jnp.float32(0.3), jnp.zeros(4)) == np.float32(0.3)


def test_random_weights_are_between_0_and_1_with_the_stated_share():
    x = [Axis("x", 0, 1, 64, periodic=True)]
    drawn = np.asarray(random_weights((*x,), (*x,), 64, 0.1, 7, np.float32))
    assert drawn.shape == (64, 64) and 0.08 < (drawn > 0).mean() < 0.12 and drawn.max() < 1
    node = np.asarray(random_weights((), (*x,), 8, 1.0, 7, np.float32))
    assert node.shape == (1, 64) and len(np.unique(node)) == 8
