"""What is seen of boxes from above, over axes: pure functions of one copy."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp

from deodar.errors import WorldError
from deodar.numerics.axes import Axes, Axis
from deodar.worlds.arena.layout import UNITS

FLOOR = (0.96, 0.96, 0.94)
OUTSIDE = (0.25, 0.25, 0.25)


def sides(axes: Axes, boxes: Any, scale: float) -> tuple[Any, Any]:
    """For each box and each of two axes, the share (boxes, samples) of the sample's cell that the box covers
    along it.

    The share of a cell of the plane that a box covers is the product of both.

    Args:
        axes: two of them; x is the one called x, else the first.
        boxes: (n, 4), m.
        scale: metres in a unit of axes that name no unit of length of their own.
    """
    across = 0 if axes[1].name != "x" else 1
    one, other = (
        _along(axes[d], boxes[:, k], boxes[:, k + 2], UNITS.get(axes[d].unit, scale))
        for d, k in ((0, across), (1, 1 - across))
    )
    return one, other


def _along(axis: Axis, lower: Any, upper: Any, scale: float) -> Any:
    step = axis.step * scale
    middle = jnp.asarray(axis.points * scale, lower.dtype)
    low, high = jnp.maximum(lower[:, None], middle - step / 2), jnp.minimum(upper[:, None], middle + step / 2)
    return jnp.clip((high - low) / step, 0.0, 1.0)


def coloured(cover: Any, colours: Any) -> Any:
    """The colour (samples, samples, 3) of things that cover a floor, later ones over earlier ones."""
    free = 1.0 - cover
    above = jnp.cumprod(free[::-1], axis=0)[::-1]  # what this thing and all later ones leave free
    seen = cover * jnp.concatenate([above[1:], jnp.ones_like(above[:1])])
    return jnp.einsum("nij,nc->ijc", seen, colours) + above[0][..., None] * jnp.asarray(FLOOR, cover.dtype)


def require_plane(sensor: str, axes: Axes, channels: bool) -> None:
    """Refuse axes that are no view from above."""
    wanted = 3 if channels else 2
    if len(axes) != wanted or (channels and axes[2].samples != 3):
        more = " and three channels" if channels else ""
        raise WorldError(
            f"is seen over two dimensions{more}, not over {[a.samples for a in axes]} samples", where=sensor
        )
