"""Conditions over all copies of a batch."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.numerics.copies import any_copy, computed_once


@pytest.mark.parametrize(("given", "holds"), [([[0, 0], [0, 0]], False), ([[0, 0], [1, 0]], True)])
def test_a_condition_of_any_copy_is_that_of_all_copies(given: list[list[int]], holds: bool) -> None:
    flags = jnp.asarray(given, bool)
    assert bool(any_copy(flags[1, 0])) == bool(flags[1, 0])
    np.testing.assert_array_equal(jax.vmap(any_copy)(flags[1]), [holds] * 2)
    np.testing.assert_array_equal(jax.jit(jax.vmap(jax.vmap(any_copy)))(flags), np.full((2, 2), holds))


def test_copies_without_the_condition_are_computed_beside_one_with_it() -> None:
    def of_copy(flag: jax.Array, x: jax.Array) -> jax.Array:
        return computed_once(flag, lambda: x + 1.0, jnp.zeros(()))

    many = jax.jit(jax.vmap(of_copy))
    x = jnp.asarray([1.0, 2.0])
    np.testing.assert_array_equal(many(jnp.asarray([False, True]), x), [2.0, 3.0])
    np.testing.assert_array_equal(many(jnp.asarray([False, False]), x), [0.0, 0.0])


def test_a_batch_computes_one_branch_alone() -> None:
    counted: list[float] = []

    def of_copy(flag: jax.Array, x: jax.Array) -> jax.Array:
        def compute() -> jax.Array:
            jax.debug.callback(lambda number: counted.append(float(number)), x)
            return x + 1.0

        return computed_once(flag, compute, jnp.zeros(()))

    many = jax.jit(jax.vmap(of_copy))
    many(jnp.asarray([False, False]), jnp.ones(2)).block_until_ready()
    jax.effects_barrier()
    assert not counted
    many(jnp.asarray([True, False]), jnp.ones(2)).block_until_ready()
    jax.effects_barrier()
    assert len(counted) == 2
