"""The position of the highest peak of an array, inside a compiled program."""

from __future__ import annotations

import math

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.numerics.axes import Axes, Axis

UNDIRECTED = 1e-9
"""Shortest mean vector on a periodic axis; a shorter one is rounding, and the region has no centre."""


def position(
    values: Array, axes: Axes, threshold: float, inside: np.ndarray | None = None
) -> tuple[Array, Array]:
    """Return the position of the highest peak, equal to `dd.peaks(values, axes, threshold)[0].position`.

    The peak is the connected region above the threshold that contains the largest sample; its position is the
    centroid, weighted by the values above the threshold.

    Args:
        values: array over the axes.
        axes: axes of the array, at least one.
        threshold: threshold in units of the values.
        inside: mask of the samples that may belong to the peak, in the shape of the values; None: all.

    Returns:
        One number for each axis, in axis units, in the precision of the values; and whether a sample is above
        the threshold. Where none is, the numbers are finite and without meaning.
    """
    above = values - threshold
    if inside is not None:
        above = jnp.where(inside, above, -jnp.inf)
    flat = above.ravel()
    # the first largest sample by two vectorised reductions; argmax takes four times as long as a step of the
    # field
    top = jnp.min(jnp.where(flat == jnp.max(flat), jnp.arange(flat.size, dtype=jnp.int32), flat.size - 1))
    tops = jnp.unravel_index(top, above.shape)
    region = _run(above > 0, axes[0], tops[0]) if len(axes) == 1 else _region(above > 0, axes, top)
    weights = jnp.where(region & (above > 0), above, 0.0)
    total = jnp.sum(weights)
    centres = [
        _centroid(
            axis,
            jnp.sum(weights, axis=tuple(k for k in range(len(axes)) if k != d))
            / jnp.where(total > 0, total, 1.0),
            tops[d],
        )
        for d, axis in enumerate(axes)
    ]
    return jnp.stack(centres), total > 0


def _run(mask: Array, axis: Axis, top: Array) -> Array:
    """Return the run of true samples along one axis that contains the sample `top`."""
    i, n = jnp.arange(axis.samples, dtype=jnp.int32), axis.samples
    if not axis.periodic:
        end = jnp.min(jnp.where(mask | (i < top), n, i))
        start = jnp.max(jnp.where(mask | (i > top), -1, i))
        return (i < end) & (i > start)
    ahead = i - top
    ahead = jnp.where(ahead < 0, ahead + n, ahead)  # integer remainders have no vector instructions
    end = jnp.min(jnp.where(mask, n, ahead))
    start = jnp.max(jnp.where(mask, -1, ahead))
    return (ahead < end) | (ahead > start)


def _region(mask: Array, axes: Axes, top: Array) -> Array:
    """Return the true samples that are connected over faces with the sample at flat index `top`.

    The region grows by one sample at a time.
    """
    start = (jnp.arange(mask.size, dtype=jnp.int32).reshape(mask.shape) == top) & mask

    def grow(grown: tuple[Array, Array]) -> tuple[Array, Array]:
        region = grown[0]
        for d, axis in enumerate(axes):
            for side in (1, -1):
                # the next direction starts from the samples that this one adds
                region = (region | _moved(region, d, axis, side)) & mask
        return region, jnp.any(region != grown[0])

    return jax.lax.while_loop(lambda grown: grown[1], grow, (start, jnp.any(start)))[0]


def _moved(region: Array, d: int, axis: Axis, side: int) -> Array:
    """Return the region shifted by one sample along axis d, wrapped on a periodic axis."""
    if axis.periodic:
        return jnp.roll(region, side, axis=d)
    width, part = [(0, 0)] * region.ndim, [slice(None)] * region.ndim
    width[d], part[d] = ((1, 0), slice(None, -1)) if side == 1 else ((0, 1), slice(1, None))
    return jnp.pad(region[tuple(part)], width)


def _centroid(axis: Axis, weights: Array, top: Array) -> Array:
    """Return the centroid of weights with sum 1; on a periodic axis that of distances from the mean
    direction.
    """
    x = jnp.asarray(axis.points, weights.dtype)
    if not axis.periodic:
        return jnp.sum(x * weights)
    turn = 2 * math.pi / axis.range
    angle = turn * (x - axis.lower)
    cosine, sine = jnp.sum(jnp.cos(angle) * weights), jnp.sum(jnp.sin(angle) * weights)
    directed = jnp.hypot(cosine, sine) > UNDIRECTED
    middle = axis.lower + jnp.arctan2(jnp.where(directed, sine, 0.0), jnp.where(directed, cosine, 1.0)) / turn
    offset = x - middle
    offset = offset - axis.range * jnp.round(offset / axis.range)
    centre = jnp.where(directed, middle + jnp.sum(offset * weights), x[top])
    wrapped = jnp.mod(centre - axis.lower, axis.range)
    return axis.lower + jnp.where(axis.range - wrapped < 1e-9 * axis.range, 0.0, wrapped)
