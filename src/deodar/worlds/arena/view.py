"""The view of boxes from above, sampled over axes, as pure functions of one copy."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from deodar.errors import WorldError
from deodar.numerics.axes import Axes, Axis
from deodar.worlds.arena.layout import UNITS

FLOOR = (0.96, 0.96, 0.94)
OUTSIDE = (0.25, 0.25, 0.25)


def sides(axes: Axes, boxes: Array, scale: float) -> tuple[Array, Array]:
    """Return the share (boxes, samples) of each sample's cell that each box covers, for each of two axes.

    The share of a cell of the plane that a box covers is the product of both.

    Args:
        axes: two axes; x is the one named x, else the first.
        boxes: (n, 4), m.
        scale: metres per unit of an axis that states no unit of length.
    """
    across = 0 if axes[1].name != "x" else 1
    one, other = (
        _along(axes[d], boxes[:, k], boxes[:, k + 2], UNITS.get(axes[d].unit, scale))
        for d, k in ((0, across), (1, 1 - across))
    )
    return one, other


def _along(axis: Axis, lower: Array, upper: Array, scale: float) -> Array:
    step = axis.step * scale
    middle = jnp.asarray(axis.points * scale, lower.dtype)
    low, high = jnp.maximum(lower[:, None], middle - step / 2), jnp.minimum(upper[:, None], middle + step / 2)
    return jnp.clip((high - low) / step, 0.0, 1.0)


def coloured(cover: Array, colours: Array) -> Array:
    """Return the colour (samples, samples, 3) of objects that cover a floor, later ones over earlier ones."""
    free = 1.0 - cover
    above = jnp.cumprod(free[::-1], axis=0)[::-1]  # share that this object and all later ones leave free
    seen = cover * jnp.concatenate([above[1:], jnp.ones_like(above[:1])])
    return jnp.einsum("nij,nc->ijc", seen, colours) + above[0][..., None] * jnp.asarray(FLOOR, cover.dtype)


def require_plane(sensor: str, axes: Axes, channels: bool) -> None:
    """Raise WorldError unless the axes are two dimensions, with three channels if `channels`."""
    wanted = 3 if channels else 2
    if len(axes) != wanted or (channels and axes[2].samples != 3):
        more = " and three channels" if channels else ""
        raise WorldError(
            f"is seen over two dimensions{more}, not over {[a.samples for a in axes]} samples", where=sensor
        )
