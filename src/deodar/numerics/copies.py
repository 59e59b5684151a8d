"""Conditions over all copies of a batch, from functions that are written for one copy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import jax.numpy as jnp
from jax import Array, lax
from jax.custom_batching import custom_vmap

T = TypeVar("T")


@custom_vmap
def any_copy(condition: Array) -> Array:
    """Return whether a condition holds in any copy of a batch; without a batch, the condition itself.

    `lax.cond` computes one branch alone only if its condition is the same for all copies.
    """
    return condition


@any_copy.def_vmap
def _(size: int, batched: Sequence[bool], condition: Array) -> tuple[Array, bool]:
    return any_copy(jnp.any(condition, axis=0) if batched[0] else condition), False


def computed_once(condition: Array, compute: Callable[[], T], otherwise: T) -> T:
    """Return what `compute` returns, or `otherwise` if a condition holds in no copy.

    The compiler cannot move the computation into operations that read its result, which it otherwise does on
    the CPU, and computes it again for each of them: three times for the channels of a picture, and one number
    after the other where they are gathered.
    """
    return lax.cond(any_copy(condition), compute, lambda: otherwise)
