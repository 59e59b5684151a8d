"""Peaks of many activation patterns over one axis, counted and measured inside a compiled function."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array, lax

from deodar.numerics.axes import Axes, Axis


def count(above: Array, axes: Axes) -> Array:
    """Return the number of peaks of each pattern; on a node 1 while it is active.

    Args:
        above: activation relative to the threshold, patterns first.
        axes: one axis, or none for nodes.
    """
    active = above > 0
    if not axes:
        return active.astype(jnp.int32)
    first = active & ~jnp.roll(active, 1, axis=-1)
    if not axes[0].periodic:
        return (first[..., 1:].sum(-1) + active[..., 0]).astype(jnp.int32)
    return jnp.where(active.all(-1), 1, first.sum(-1)).astype(jnp.int32)


def widest(above: Array, axis: Axis) -> Array:
    """Return the width of the widest peak of each pattern, between the interpolated crossings of the
    threshold; 0 without a peak.
    """
    active, length = above > 0, jnp.zeros_like(above)
    for side in (1, -1):
        beside = jnp.roll(above, -side, axis=-1)
        crossing = active & (beside <= 0)
        share = jnp.where(crossing, above, 0.0) / jnp.where(crossing, above - beside, 1.0)
        part = jnp.where(beside > 0, 0.5, share)
        if not axis.periodic:
            part = part.at[..., -1 if side == 1 else 0].set(0.0)
        length = length + part
    length = jnp.where(active, length, 0.0)
    if axis.periodic:
        # a peak may lie across the border
        active, length = (jnp.concatenate([a, a], axis=-1) for a in (active, length))
    total = jnp.cumsum(length, axis=-1)
    since = total - lax.cummax(jnp.where(active, 0.0, total), axis=length.ndim - 1)
    return jnp.minimum(since.max(-1) * axis.step, axis.range)
