"""The mean of a field's output over the cells of its grid, right for hills and for edges.

Point sums are exact where the output changes little from sample to sample. Where the edge of a peak is
narrower than a sample, a point sum jumps when the edge crosses a sample: peaks stick to the grid and
thresholds depend on it. A mean over cells grows continuously instead, but it blurs a hill, which a point sum
does not.

Over one axis activation is piecewise linear through v(i) and v(i + 1/2), values at the samples and halfway
between them. With q the mean of g over such a half of an interval,

    m(i) = (q(i - 3/4) + 3 q(i - 1/4) + 3 q(i + 1/4) + q(i + 3/4)) / 8

preserves the first three moments of an edge at the grid's wavelength, so that the kernels receive the correct
position of an edge between two samples. These means are blurred by the window cos^3(k / 4) sinc(k / 4), with
k the wave number times the step. The output undoes this to order k^6, where it is linear and therefore exact
for every g:

    o(i) = (2494 m(i) - 316 (m(i - 1) + m(i + 1)) + 29 (m(i - 2) + m(i + 2))) / 1920.

v is chosen such that its differences are the weights of o applied to D u, the central difference of order 6,

    c = sum over k from -4 to 4 of C(|k|) u(i + k),    57600 C = 120470, -37559, 6672, -577, 29,
    v(i) = (c(i - 1) + 2 c(i) + c(i + 1)) / 4,
    v(i + 1/2) = (c(i - 1) + 7 c(i) + 7 c(i + 1) + c(i + 2)) / 16.

Then sum_i o(i) (D u)(i) telescopes to zero for a peak away from the ends, as the integral of g(u) du/dx does:
a symmetric kernel exerts no net force on a peak, wherever it lies between samples. The rule is exact to order
k^6 for linear g.

Over more axes the output is the mean of the outputs along each of them, weighted by the fourth power of the
slope along each: an edge is averaged along the axis that it crosses, and a hill is the same along all.

The output leaves the range of g at an edge, by up to 0.05 over one axis and 0.1 over two. Where it is used
as a number between 0 and 1, the means m take its place: they stay in the range of g, and over one axis their
sum is that of the output.
"""

from __future__ import annotations

from collections.abc import Sequence

import jax
import jax.numpy as jnp
from jax import Array
from jax.lax import optimization_barrier, slice_in_dim

from deodar.numerics import native
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval
from deodar.numerics.native import Kernels
from deodar.numerics.sigmoids import Logistic, SigmoidFunction

AT_SAMPLES = tuple(c / 230400 for c in (29, -519, 5547, -24792, 52024, 165822, 52024, -24792, 5547, -519, 29))
"""v(i) from u(i - 5) to u(i + 5)."""
BETWEEN = tuple(
    c / 921600 for c in (29, -374, 2836, 5135, -96316, 549490, 549490, -96316, 5135, 2836, -374, 29)
)
"""v(i + 1/2) from u(i - 5) to u(i + 6)."""
FROM_HALVES = tuple(c / 15360 for c in (29, -229, 1546, 7166, -919, 87))
"""o(i) from q(i - 3 + 1/4) to q(i + 2 + 1/4), the first halves of intervals, and in reverse from the second
halves.
"""
BLURRED_FROM_HALVES = (0.0, 0.0, 1 / 8, 3 / 8, 0.0, 0.0)
"""m(i) from the same, all weights positive."""
BESIDE = 8
"""Samples beyond the ends that the rule reads."""
OVERSHOOT = (2 * 29 + 2 * 316 + 2494 - 1920) / 3840
"""Share of the range of g by which the output may leave it: the weights of o with its signs."""
FLAT = 1e-9
"""Fourth power of the slope, in activation per two samples, below which no direction is preferred."""


def cell_means(g: SigmoidFunction, u: Array, axes: Axes, kernels: Kernels | None = None) -> Array:
    """Return the mean of g over the cell of each sample; on a node, and along axes of one sample, g itself.

    Beyond the end of an axis that is not periodic, u continues in a straight line. A compiled kernel computes
    the rule for a logistic g over one and two axes, where there are `kernels`.
    """
    long = long_axes(axes)
    if kernels is None or type(g) is not Logistic or not native.means_of_cells(len(long), u.size):
        return _means(g, u, axes, FROM_HALVES)
    over_long = u.reshape([axes[d].samples for d in long])
    beta, threshold = (jnp.asarray(x, u.dtype) for x in (g.beta, g.threshold))
    return kernels.cells(over_long, beta, threshold, [axes[d].periodic for d in long]).reshape(u.shape)


def bounded_cell_means(g: SigmoidFunction, u: Array, axes: Axes) -> Array:
    """Return the same before the last line of the rule: blurred, and in the range of g."""
    return _means(g, u, axes, BLURRED_FROM_HALVES)


def _means(g: SigmoidFunction, u: Array, axes: Axes, weights: Sequence[float]) -> Array:
    long = long_axes(axes)
    if not long:
        return g(u)
    if len(long) == 1:
        return _along(g, u, axes, long[0], weights)
    shares = [_steps(u, d, periodic=axes[d].periodic) ** 4 + FLAT for d in long]
    means = [_along(g, u, axes, d, weights) for d in long]
    blended = sum((w * o for w, o in zip(shares[1:], means[1:], strict=True)), shares[0] * means[0])
    return optimization_barrier(blended / sum(shares[1:], shares[0]))


def bounds(g: Interval) -> Interval:
    """Return the smallest and largest output for values of g in an interval."""
    beyond = OVERSHOOT * (g[1] - g[0])
    return g[0] - beyond, g[1] + beyond


def _along(g: SigmoidFunction, u: Array, axes: Axes, d: int, weights: Sequence[float]) -> Array:
    """Return the rule over axis d, with weights of the first halves of intervals.

    Values at and between samples are one array, and barriers stand where an array has several readers:
    otherwise the compiler computes exponentials once for each reader, and without vectors.
    """
    n = u.shape[d]
    wide = optimization_barrier(continued(u, d, BESIDE, periodic=axes[d].periodic))
    # from sample -3, and from -3 + 1/2
    at, between = n + 6, n + 5
    v = optimization_barrier(
        jnp.concatenate([_symmetric(wide, d, at, AT_SAMPLES), _symmetric(wide, d, between, BETWEEN)], axis=d)
    )
    ends = jax.tree.map(optimization_barrier, g.ends(v))
    first, last, middle = ((cut(v, d, k, between), terms(ends, d, k, between)) for k in (0, 1, at))
    near, far = optimization_barrier(
        (g.mean(first[0], middle[0], first[1], middle[1]), g.mean(last[0], middle[0], last[1], middle[1]))
    )
    return weighted(near, d, n, weights) + weighted(far, d, n, weights[::-1])


def _steps(y: Array, d: int, *, periodic: bool) -> Array:
    """Return y(i + 1) - y(i - 1) along axis d."""
    wide, n = continued(y, d, 1, periodic=periodic), y.shape[d]
    return cut(wide, d, 2, n) - cut(wide, d, 0, n)


def _symmetric(y: Array, d: int, count: int, weights: Sequence[float]) -> Array:
    """Return weighted sums of successive samples along axis d, with weights that are equal from both ends."""
    last = len(weights) - 1
    pairs = (weights[k] * (cut(y, d, k, count) + cut(y, d, last - k, count)) for k in range((last + 1) // 2))
    total = sum(pairs, jnp.zeros((), y.dtype))
    return total if last % 2 else total + weights[last // 2] * cut(y, d, last // 2, count)


def long_axes(axes: Axes) -> list[int]:
    """Return the numbers of the axes with more than one sample."""
    return [d for d, a in enumerate(axes) if a.samples > 1]


def weighted(y: Array, d: int, count: int, weights: Sequence[float]) -> Array:
    """Return weighted sums of successive samples along axis d."""
    first, *others = (c * cut(y, d, k, count) for k, c in enumerate(weights) if c)
    return sum(others, first)


def terms(at: tuple[Array, ...] | None, d: int, start: int, count: int) -> tuple[Array, ...] | None:
    """Return a part along axis d of the terms that a sigmoid has for the ends of a range."""
    return None if at is None else tuple(cut(e, d, start, count) for e in at)


def cut(y: Array, d: int, start: int, count: int) -> Array:
    """Return a part of axis d."""
    return slice_in_dim(y, start, start + count, axis=d)


def continued(y: Array, d: int, by: int, *, periodic: bool) -> Array:
    """Continue both ends of axis d: with samples of the other end if periodic, else in a straight line."""
    n = y.shape[d]
    if periodic:
        before = [cut(y, d, k % n, 1) for k in range(-by, 0)] if n < by else [cut(y, d, n - by, by)]
        after = [cut(y, d, k % n, 1) for k in range(by)] if n < by else [cut(y, d, 0, by)]
    else:
        first, last = cut(y, d, 0, 1), cut(y, d, n - 1, 1)
        down, up = first - cut(y, d, 1, 1), last - cut(y, d, n - 2, 1)
        steps = jnp.arange(1, by + 1, dtype=y.dtype).reshape([by if e == d else 1 for e in range(y.ndim)])
        before, after = [first + jnp.flip(steps, d) * down], [last + steps * up]
    return jnp.concatenate([*before, y, *after], axis=d)
