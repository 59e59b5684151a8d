"""The box kernel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.leaves import on_axis, per_axis
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, signed
from deodar.numerics.kernels._base import Kernel, Term
from deodar.numerics.kernels.gaussian import NARROWEST
from deodar.numerics.scalar import Scalar
from deodar.parameters import Live, PerAxis, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Box(Kernel):
    r"""A kernel of constant weight for distances up to half its width.

    A cell that is partly inside the box counts with the part of its width that is inside.

    Equation:
        k(d) = \begin{cases} \mathrm{amplitude} & |d_i| < \frac{\mathrm{width}_i}{2} \ \forall i \\ 0 &
            \text{else} \end{cases}

    Parameters:
        amplitude: weight inside, per unit of the axes; if normalized, the integral over all distances.
        width: full width in axis units, one value or one for each axis; > 0.
        normalized: whether the amplitude is the integral.
        boundary: `periodic`, `zero`, `reflect` or `replicate`, one value or one for each axis; none:
            `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        no reference
    """

    amplitude: Annotated[
        float, Live("activation", meaning="weight inside, or the integral if normalized")
    ] = 1.0
    width: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST, meaning="full width")] = 10.0
    normalized: Annotated[bool, Recompile(meaning="whether the amplitude is the kernel's integral")] = False

    def bounds(self, axes: Axes) -> Interval:
        return signed(
            self.amplitude
            * (1.0 if self.normalized else math.prod(float(w) for w in per_axis(self.width, axes)))
        )

    def terms(self) -> Sequence[Term]:
        def along(d: int, lag: Array, period: float | None, step: float) -> Array:
            w = on_axis(self.width, d)
            weight = _covered(lag, w, period, step)
            return weight / w if self.normalized else weight

        return (Term(self.amplitude, along),)


def _covered(lag: Array, width: float, period: float | None, step: float) -> Array:
    """Return the share of the cell around `lag` that is inside the box; on a periodic axis the box may
    overlap itself.
    """
    if period is None:
        return _overlap(lag, width, step)
    turns = jnp.floor(width / period)
    # after an odd number of turns the ends meet opposite the centre
    lag = lag - jnp.mod(turns, 2) * period / 2
    folded_lag = lag - period * jnp.round(lag / period)
    remainder = width - turns * period
    return turns + sum(_overlap(folded_lag + k * period, remainder, step) for k in (-1, 0, 1))


def _overlap(lag: Array, width: Scalar, step: float) -> Array:
    upper = jnp.minimum(lag + step / 2, width / 2)
    lower = jnp.maximum(lag - step / 2, -width / 2)
    return jnp.maximum(0.0, upper - lower) / step
