"""The centre of an input along an axis."""

from __future__ import annotations

import math

import jax.numpy as jnp
from jax import Array

from deodar.numerics.axes import Axis
from deodar.numerics.scalar import Scalar

LEAST_DIRECTED = 1e-3
"""Smallest length of the mean vector on a periodic axis, as a share of the input; the direction of
homogeneous input is only rounding.
"""


def centre(axis: Axis, f: Array, least: Scalar) -> tuple[Array, Array, Array]:
    """Return the mean of an axis weighted by an input; on a periodic axis the direction of the vector sum.

    Args:
        axis: the axis.
        f: one value for each of its samples, times the grid step.
        least: sum of f up to which the input has no centre.

    Returns:
        The centre in axis units, whether it exists, and the sum of f. If it does not exist, the number is
        finite and without meaning.
    """
    x = jnp.asarray(axis.points, f.dtype)
    n = jnp.sum(f)
    exists = n > least
    if axis.periodic:
        turn = 2 * math.pi / axis.range
        angle = turn * (x - axis.lower)
        sine, cosine = jnp.sum(jnp.sin(angle) * f), jnp.sum(jnp.cos(angle) * f)
        exists = exists & (jnp.hypot(sine, cosine) > LEAST_DIRECTED * n)
        sine, cosine = jnp.where(exists, sine, 0.0), jnp.where(exists, cosine, 1.0)
        place = axis.lower + jnp.mod(jnp.arctan2(sine, cosine), 2 * math.pi) / turn
    else:
        place = jnp.sum(x * f) / jnp.where(exists, n, 1.0)
    return place, exists, n
