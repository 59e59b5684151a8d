"""Between grids: the matrices that interpolate, shift, and the reductions over axes."""

from __future__ import annotations

from typing import Any, Literal

import jax.numpy as jnp
from jax import Array

from deodar.numerics.axes import Axis

Interpolation = Literal["linear", "nearest"]
INTERPOLATIONS = ("linear", "nearest")
REDUCTIONS = ("integral", "sum", "mean", "max", "min")


def weights(source: Axis, points: Any, interpolation: str, dtype: Any) -> Array:
    """Weights that give the values at `points` from the samples of `source`: shape (points, samples).

    Linear takes the two neighbours, nearest one (the upper of two equally near). Beyond the ends of an axis that is not
    periodic zeros follow: linear falls to zero within one cell past the last sample, nearest within half a cell.
    """
    position = (jnp.asarray(points, dtype) - jnp.asarray(source.lower, dtype)) / jnp.asarray(source.step, dtype)
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


def reduce(y: Array, d: int, axis: Axis, how: str) -> Array:
    """One axis taken out: integral (sum times grid step), sum, mean, max or min."""
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
