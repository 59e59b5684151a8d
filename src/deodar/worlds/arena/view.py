"""The view of boxes from above, sampled over axes, as pure functions of one copy."""

from __future__ import annotations

from collections.abc import Iterator

import jax.numpy as jnp
from jax import Array

from deodar.errors import Problem, WorldError
from deodar.numerics import units
from deodar.numerics.axes import Axes, Axis, barely_overlap

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
    along_x, along_y = (
        _along(axes[d], boxes[:, k], boxes[:, k + 2], metres(axes[d], scale))
        for d, k in ((0, across), (1, 1 - across))
    )
    return along_x, along_y


def metres(axis: Axis, scale: float) -> float:
    """Return the metres per unit of an axis; `scale` for an axis that states no unit of length."""
    unit = units.parse(axis.unit)
    return unit.size if unit is not None and unit.quantity == "length" else scale


def judge_plane(
    axes: Axes, border: tuple[float, float, float, float], scale: float, unit: str
) -> Iterator[Problem]:
    """Yield what is wrong with two axes over which an arena is seen: a unit that is no length, or values that
    barely overlap the arena.

    Args:
        axes: two axes; x is the one named x, else the first.
        border: lower x, lower y, upper x, upper y, m.
        scale: metres per unit of the arena.
        unit: unit of the arena.
    """
    across = 0 if axes[1].name != "x" else 1
    for d, k in ((0, across), (1, 1 - across)):
        axis = axes[d]
        stated = units.parse(axis.unit)
        if axis.unit and (stated is None or stated.quantity != "length"):
            yield Problem(
                "",
                f"is seen along the axis {axis.name!r} in {axis.unit!r}, which is no unit of length",
                f"Write unit={unit!r}, or no unit: values then are in the unit of the arena",
            )
            continue
        size = metres(axis, scale)
        bounds = border[k] / size, border[k + 2] / size
        for fault, fix in barely_overlap(axis, bounds, "the walls of the arena", "" if axis.unit else unit):
            yield Problem("", fault, fix, "warning")


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
    dimensions = 3 if channels else 2
    if len(axes) != dimensions or (channels and axes[2].samples != 3):
        channels_text = " and three channels" if channels else ""
        raise WorldError(
            f"is seen over two dimensions{channels_text}, not over {[a.samples for a in axes]} samples",
            where=sensor,
        )
