"""The mean of a field's output over the cells of its grid.

Point sums are exact where the output changes little from sample to sample. Where the edge of a peak is narrower than a sample, a point sum
jumps when the edge crosses a sample: peaks stick to the grid and thresholds belong to it. The mean over a cell grows continuously instead.

Over one axis activation runs in straight lines from the sample to the middles between neighbours: g is averaged over both halves of the cell.
A straight line would lie above a curve that bends upwards, hence w = u - (second difference) / 8, which makes the rule exact for linear g.

Over more axes g is averaged over the activations u - s / 2 to u + s / 2, where s is the slope along the steepest axis, in activation per sample. An
average over one whole sample of that axis removes everything that repeats from sample to sample along it, so that edges in any
direction move freely. The cost does not grow with the number of axes.
"""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array
from jax.lax import optimization_barrier, slice_in_dim

from deodar.numerics.axes import Axes
from deodar.numerics.sigmoids._base import Sigmoid


def cell_means(g: Sigmoid, u: Array, axes: Axes) -> Array:
    """The mean of g over the cell of each sample; on a node, and along axes of one sample, g itself.

    Beyond the end of an axis that is not periodic, u continues in a straight line.
    """
    long = [d for d, a in enumerate(axes) if a.samples > 1]
    if not long:
        return g(u)
    # The barriers keep the compiler from computing exponentials once for each reader, and from mixing them with the joins of the padding,
    # which stops it from using vectors: without them a step of 100 x 100 samples takes three times as long.
    return _line(g, u, axes, long[0]) if len(long) == 1 else optimization_barrier(_space(g, u, axes, long))


def _line(g: Sigmoid, u: Array, axes: Axes, d: int) -> Array:
    n = u.shape[d]
    wide = _padded(u, d, 2, axes[d].periodic)
    w = _cut(wide, d, 1, n + 2)
    w = w - 0.125 * (_cut(wide, d, 0, n + 2) - 2.0 * w + _cut(wide, d, 2, n + 2))
    between = 0.5 * (_cut(w, d, 0, n + 1) + _cut(w, d, 1, n + 1))
    w = _cut(w, d, 1, n)
    at_w, at_between = jax.tree.map(optimization_barrier, (g.ends(w), g.ends(between)))  # one each: what nobody reads is not computed
    left, right = (_cut(between, d, k, n) for k in (0, 1))
    at_left, at_right = (None if at_between is None else tuple(_cut(e, d, k, n) for e in at_between) for k in (0, 1))
    (p, q), (r, s) = g.fraction(w, left, at_w, at_left), g.fraction(w, right, at_w, at_right)
    return 0.5 * (p * s + r * q) / (q * s)


def _space(g: Sigmoid, u: Array, axes: Axes, long: list[int]) -> Array:
    wide = u
    for d in long:
        wide = _padded(wide, d, 1, axes[d].periodic)
    wide = optimization_barrier(wide)
    steepest: Any = 0.0
    for d in long:
        inner = wide
        for e in long:
            inner = inner if e == d else _cut(inner, e, 1, u.shape[e])
        steepest = jnp.maximum(steepest, jnp.abs(_cut(inner, d, 2, u.shape[d]) - _cut(inner, d, 0, u.shape[d])))
    half = 0.25 * steepest
    u, half = optimization_barrier((u, half))
    low, high = u - half, u + half
    return g.mean(low, high)


def _cut(y: Array, d: int, start: int, count: int) -> Array:
    return slice_in_dim(y, start, start + count, axis=d)


def _padded(y: Array, d: int, by: int, periodic: bool) -> Array:
    """Samples added at both ends of axis d: those of the other end, or a straight line."""
    n = y.shape[d]
    if periodic:
        before = [_cut(y, d, k % n, 1) for k in range(-by, 0)] if n < by else [_cut(y, d, n - by, by)]
        after = [_cut(y, d, k % n, 1) for k in range(by)] if n < by else [_cut(y, d, 0, by)]
    else:
        first, last = _cut(y, d, 0, 1), _cut(y, d, n - 1, 1)
        down, up = first - _cut(y, d, 1, 1), last - _cut(y, d, n - 2, 1)
        before = [first + k * down for k in range(by, 0, -1)]
        after = [last + k * up for k in range(1, by + 1)]
    return jnp.concatenate([*before, y, *after], axis=d)
