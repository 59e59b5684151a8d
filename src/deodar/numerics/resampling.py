"""Matrices that interpolate between grids, shifts, and reductions over axes."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.typing import DTypeLike

from deodar.numerics.axes import Axis
from deodar.numerics.scalar import Scalar

INTERPOLATIONS = ("linear", "nearest")
REDUCTIONS = ("integral", "sum", "mean", "max", "min")


def weights(source: Axis, points: Array | np.ndarray, interpolation: str, dtype: DTypeLike) -> Array:
    """Return the weights from the samples of `source` to the values at `points`, shape (points, samples).

    `linear` uses the two neighbours, `nearest` one (the upper of two equally near). An axis that is not
    periodic is padded with 0: `linear` falls to 0 within one cell beyond the last sample, `nearest` within
    half a cell.
    """
    position = (jnp.asarray(points, dtype) - jnp.asarray(source.lower, dtype)) / jnp.asarray(
        source.step, dtype
    )
    distance = position[:, None] - jnp.arange(source.samples, dtype=dtype)[None, :]
    if source.periodic:
        n = source.samples
        distance = (distance + n / 2) % n - n / 2
    if interpolation == "nearest":
        return ((distance >= -0.5) & (distance < 0.5)).astype(dtype)
    w = jnp.maximum(0.0, 1.0 - jnp.abs(distance))
    if source.periodic and source.samples == 1:
        w = jnp.ones_like(w)
    return w


def steps(axis: Axis, amount: Scalar, dtype: DTypeLike) -> tuple[Array, Array]:
    """Return a shift along an axis as a whole number of samples and a remainder, 0 to 1."""
    samples = jnp.asarray(amount, dtype) / jnp.asarray(axis.step, dtype)
    whole = jnp.floor(samples)
    # a remainder that is only rounding counts as 0
    whole = jnp.where(
        samples - whole > 1 - jnp.finfo(dtype).eps * jnp.maximum(8.0, jnp.abs(samples)), whole + 1, whole
    )
    turns = whole % axis.samples if axis.periodic else jnp.clip(whole, -axis.samples - 1, axis.samples)
    return turns.astype(jnp.int32), jnp.maximum(samples - whole, 0.0)


def shifted(y: Array, d: int, periodic: bool, whole: Array, part: Array) -> Array:
    """Shift an array along axis d: sample i moves to i + whole + part, with linear interpolation.

    An axis that is not periodic is padded with 0. The shift is a copy of a slice, which is faster than a
    matrix.
    """
    n = y.shape[d]
    if periodic:
        wide, first = jnp.concatenate([y, y], axis=d), n - 1 - whole
    else:
        nothing = jnp.zeros((*y.shape[:d], n + 1, *y.shape[d + 1 :]), y.dtype)
        wide, first = jnp.concatenate([nothing, y, nothing], axis=d), n - whole
    stretch = lax.dynamic_slice_in_dim(wide, first, n + 1, axis=d)
    return (1 - part) * lax.slice_in_dim(stretch, 1, n + 1, axis=d) + part * lax.slice_in_dim(
        stretch, 0, n, axis=d
    )


def reduce(y: Array, d: int, axis: Axis, how: str) -> Array:
    """Contract one axis: integral (sum times grid step), sum, mean, max or min."""
    match how:
        case "integral":
            return jnp.sum(y, axis=d) * jnp.asarray(axis.step, y.dtype)
        case "sum":
            return jnp.sum(y, axis=d)
        case "mean":
            return jnp.mean(y, axis=d)
        case "max":
            return jnp.max(y, axis=d)
        case _:
            return jnp.min(y, axis=d)
