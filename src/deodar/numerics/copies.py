"""Conditions over all copies of a batch, from functions that are written for one copy."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
from jax import Array
from jax.custom_batching import custom_vmap


@custom_vmap
def any_copy(condition: Array) -> Array:
    """Return whether a condition holds in any copy of a batch; without a batch, the condition itself.

    `lax.cond` computes one branch alone only if its condition is the same for all copies.
    """
    return condition


@any_copy.def_vmap
def _(size: int, batched: Sequence[bool], condition: Array) -> tuple[Array, bool]:
    return any_copy(jnp.any(condition, axis=0) if batched[0] else condition), False
