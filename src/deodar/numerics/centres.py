"""Where input along an axis has its centre."""

from __future__ import annotations

import math

import jax.numpy as jnp
from jax import Array

from deodar.numerics.axes import Axis
from deodar.numerics.scalar import Scalar

LEAST_DIRECTED = 1e-3
"""On a ring, the share of the input that must point somewhere: the direction of homogeneous input is only
rounding.
"""


def centre(axis: Axis, f: Array, least: Scalar) -> tuple[Array, Array, Array]:
    """The mean of an axis weighted by what stands on it; on a ring the direction of the sum of vectors.

    Args:
        axis: the axis.
        f: one value for each of its samples, grid step included.
        least: sum of f up to which there is nothing.

    Returns:
        The place in axis units, whether there is one, and the sum of f. Where there is none, the place is
        finite and without meaning.
    """
    x = jnp.asarray(axis.points, f.dtype)
    n = jnp.sum(f)
    there = n > least
    if axis.periodic:
        turn = 2 * math.pi / axis.range
        angle = turn * (x - axis.lower)
        sine, cosine = jnp.sum(jnp.sin(angle) * f), jnp.sum(jnp.cos(angle) * f)
        there = there & (jnp.hypot(sine, cosine) > LEAST_DIRECTED * n)
        sine, cosine = jnp.where(there, sine, 0.0), jnp.where(there, cosine, 1.0)
        place = axis.lower + jnp.mod(jnp.arctan2(sine, cosine), 2 * math.pi) / turn
    else:
        place = jnp.sum(x * f) / jnp.where(there, n, 1.0)
    return place, there, n
