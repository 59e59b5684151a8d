"""Hues of pictures, and the assignment of pixels to the cells of a coarser grid."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import DTypeLike

from deodar.numerics import resampling
from deodar.numerics.axes import Axis

CHANNELS = 3
"""Red, green and blue."""


def hue_saturation_value(picture: Array) -> tuple[Array, Array, Array]:
    """Return hue (as a share of a turn, red 0), saturation and value of pixels with channels on the last
    axis.
    """
    red, green, blue = picture[..., 0], picture[..., 1], picture[..., 2]
    value = jnp.maximum(jnp.maximum(red, green), blue)
    spread = value - jnp.minimum(jnp.minimum(red, green), blue)
    safe = jnp.where(spread > 0, spread, 1.0)
    sector = jnp.where(
        value == red,
        jnp.mod((green - blue) / safe, 6.0),
        jnp.where(value == green, (blue - red) / safe + 2.0, (red - green) / safe + 4.0),
    )
    hue = jnp.where(spread > 0, sector / 6.0, 0.0)
    saturation = jnp.where(value > 0, spread / jnp.where(value > 0, value, 1.0), 0.0)
    return hue, saturation, value


def red_green_blue(hue: Array, chroma: Array, value: Array) -> Array:
    """Return the channels, as an additional last axis, of colours with a hue (in turns, red 0), a chroma
    (value minus smallest channel) and a value (largest channel).
    """
    sector = 6.0 * (hue - jnp.floor(hue))
    full = (jnp.abs(sector - 3.0) - 1.0, 2.0 - jnp.abs(sector - 2.0), 2.0 - jnp.abs(sector - 4.0))
    return jnp.stack([value - chroma * (1.0 - jnp.clip(f, 0.0, 1.0)) for f in full], axis=-1)


def from_hues(axis: Axis, turn: Array, dtype: DTypeLike) -> Array:
    """Return the distances of the samples of a hue axis from hues (as shares of a turn), as an additional
    last axis; of both distances on the circle the shorter one.
    """
    distance = jnp.asarray(axis.points, dtype) - axis.lower - turn[..., None] * axis.range
    return distance - axis.range * jnp.round(distance / axis.range)


def cells(fine: Axis, coarse: Axis, dtype: DTypeLike) -> Array:
    """Return the weights of the mean over the pixels whose middle is in a cell, shape (cells, pixels); a cell
    without a pixel uses the nearest one.
    """
    member = resampling.weights(coarse, fine.points, "nearest", dtype).T
    count = jnp.sum(member, axis=1, keepdims=True)
    nearest = resampling.weights(fine, coarse.points, "nearest", dtype)
    return jnp.where(count > 0, member / jnp.maximum(count, 1.0), nearest)


def same_side(fine: Axis, coarse: Axis) -> bool:
    """Return whether two axes are the same side of a picture: equal name and unit, ends at most a grid step
    apart.
    """
    apart = max(abs(fine.lower - coarse.lower), abs(fine.upper - coarse.upper))
    return fine.name == coarse.name and fine.unit == coarse.unit and apart <= coarse.step
