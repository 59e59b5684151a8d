"""The mean of a field's output over the cells of its grid as version 0.1 computed it.

Documents of that version keep their bits with it. It blurs hills that the grid resolves: at 2.5 samples a
kernel width they are detected at 1.9 % less input. `quadrature` has the rule without the blur.

Over one axis activation is piecewise linear through v(i) and v(i + 1/2), values at the samples and halfway
between them. With q the mean of g over such a half of an interval, the output at sample i is

    o(i) = (q(i - 3/4) + 3 q(i - 1/4) + 3 q(i + 1/4) + q(i + 3/4)) / 8.

These weights preserve the first three moments of an edge at the grid's wavelength, so that the kernels
receive the correct position of an edge between two samples. v is chosen such that its differences are the
same weights applied to an antisymmetric difference D of u,

    v(i + 1/2) - v(i) = (3 (D u)(i) + (D u)(i + 1)) / 8,
    v(i + 1) - v(i + 1/2) = ((D u)(i) + 3 (D u)(i + 1)) / 8.

Then sum_i o(i) (D u)(i) telescopes to zero for a peak away from the ends, as the integral of g(u) du/dx does:
a symmetric kernel exerts no net force on a peak, wherever it lies between samples. D is the central
difference of u - 3/8 (second difference) + 3/16 (fourth difference). The first factor makes the rule exact
for linear g up to fourth differences. The second was chosen by measurement: with it, edges respond to noise
at single samples about as much as on a fine grid, so that memories drift about as far (without it about 40 %
less at 5 samples per kernel width).

Over more axes g is averaged over the activations u - s / 2 to u + s / 2, where s is the slope along the
steepest axis, in activation per sample. An average over one whole sample of that axis removes all variation
with the period of the grid along it, so that edges in any direction move freely. The cost does not grow with
the number of axes.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array
from jax.lax import optimization_barrier

from deodar.numerics.axes import Axes
from deodar.numerics.quadrature import continued, cut, long_axes, terms, weighted
from deodar.numerics.scalar import Scalar
from deodar.numerics.sigmoids import SigmoidFunction

AT_SAMPLES = tuple(c / 64 for c in (3, -12, 13, 56, 13, -12, 3))
"""v(i) from u(i - 3) to u(i + 3)."""
BETWEEN = tuple(c / 256 for c in (3, 3, -59, 181, 181, -59, 3, 3))
"""v(i + 1/2) from u(i - 3) to u(i + 4)."""
BESIDE = 4
"""Samples beyond the ends that the rule reads."""


def cell_means_0_1(g: SigmoidFunction, u: Array, axes: Axes) -> Array:
    """Return the mean of g over the cell of each sample; on a node, and along axes of one sample, g itself.

    Beyond the end of an axis that is not periodic, u continues in a straight line.
    """
    long = long_axes(axes)
    if not long:
        return g(u)
    # The barriers prevent the compiler from computing exponentials once for each reader, and from fusing them
    # with the concatenation of the padding, which prevents vectorisation: without them a step of 100 x 100
    # samples takes three times as long.
    return _line(g, u, axes, long[0]) if len(long) == 1 else optimization_barrier(_space(g, u, axes, long))


def _line(g: SigmoidFunction, u: Array, axes: Axes, d: int) -> Array:
    n = u.shape[d]
    wide = optimization_barrier(continued(u, d, BESIDE, periodic=axes[d].periodic))
    # from sample -1, and from -1/2
    knots, middles = weighted(wide, d, n + 2, AT_SAMPLES), weighted(wide, d, n + 1, BETWEEN)
    # one array each: an array that no operation reads is not computed
    at_knots, at_middles = jax.tree.map(optimization_barrier, (g.ends(knots), g.ends(middles)))
    (first, at_first), (last, at_last) = (
        (cut(knots, d, k, n + 1), terms(at_knots, d, k, n + 1)) for k in (0, 1)
    )
    near, far = g.mean(first, middles, at_first, at_middles), g.mean(last, middles, at_last, at_middles)
    # the contribution of an interval to either side
    left, right = optimization_barrier((0.375 * near + 0.125 * far, 0.125 * near + 0.375 * far))
    return cut(left, d, 1, n) + cut(right, d, 0, n)


def _space(g: SigmoidFunction, u: Array, axes: Axes, long: list[int]) -> Array:
    wide = u
    for d in long:
        wide = continued(wide, d, 1, periodic=axes[d].periodic)
    wide = optimization_barrier(wide)
    steepest: Scalar = 0.0
    for d in long:
        inner = wide
        for e in long:
            inner = inner if e == d else cut(inner, e, 1, u.shape[e])
        steepest = jnp.maximum(steepest, jnp.abs(cut(inner, d, 2, u.shape[d]) - cut(inner, d, 0, u.shape[d])))
    half = 0.25 * steepest
    u, half = optimization_barrier((u, half))
    low, high = u - half, u + half
    return g.mean(low, high)
