"""The truncated Gaussian kernel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.leaves import is_neutral, on_axis, per_axis
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, signed
from deodar.numerics.kernels._base import Kernel, Term
from deodar.numerics.kernels.gaussian import NARROWEST
from deodar.parameters import Live, PerAxis, Rebuild, Recompile
from deodar.registry import register

ROUNDING = 1e-5
"""Tolerance for rounding in single precision of a whole number of steps, as a share of a step."""


@register
@dataclass(frozen=True)
class TruncatedGaussian(Kernel):
    r"""A Gaussian kernel of finite reach, normalised over its samples, as in many published simulations.

    The reach is rounded up to whole steps and limited to the length of the axis. If normalized, each factor
    is divided by its sum over these samples times the step. On a periodic axis d_i is the shorter distance.

    Equation:
        k(d) = \begin{cases} \mathrm{amplitude} \prod_i e^{-d_i^2 / (2 \sigma_i^2)} & |d_i| \le
            \mathrm{reach}_i \\ 0 & \text{else} \end{cases}
        \mathrm{reach}_i = \max(\mathrm{cutoff}\, \sigma_i, \mathrm{least}_i)

    Parameters:
        amplitude: weight at the centre, per unit of the axes; if normalized, the sum over all samples reached
            times the steps. On a node the self-excitation.
        sigma: width in axis units, one value or one for each axis; > 0. Far below the step the kernel acts
            within one cell.
        cutoff: reach as a multiple of the width; >= 0.
        least: smallest reach, in axis units, one value or one for each axis: for a narrow Gaussian with the
            reach of a wider one.
        normalized: whether the amplitude is the kernel's integral.
        boundary: `periodic`, `zero`, `reflect` or `replicate`, one value or one for each axis; none:
            `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 2, sampled and truncated.
    """

    amplitude: Annotated[
        float, Live("activation", neutral=0.0, meaning="weight at the centre, or the integral if normalized")
    ] = 1.0
    sigma: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST, meaning="width")] = 5.0
    cutoff: Annotated[float, Rebuild(lower=0, meaning="reach as a multiple of the width")] = 5.0
    least: Annotated[PerAxis, Rebuild("axis", lower=0, meaning="reach at the least")] = 0.0
    normalized: Annotated[bool, Recompile(meaning="whether the amplitude is the kernel's integral")] = False

    def bounds(self, axes: Axes) -> Interval:
        wide = math.prod(
            math.sqrt(2 * math.pi) * float(s) + a.step
            for s, a in zip(per_axis(self.sigma, axes), axes, strict=True)
        )
        return signed(self.amplitude * (1.0 if self.normalized else wide))

    def terms(self) -> Sequence[Term]:
        return () if is_neutral(self.amplitude) else (Term(self.amplitude, self._along),)

    def _along(self, d: int, lag: Array, period: float | None, step: float) -> Array:
        sigma, least = on_axis(self.sigma, d), on_axis(self.least, d)
        slack = ROUNDING if lag.dtype == jnp.float32 else 0.0
        reach = jnp.ceil(jnp.maximum(self.cutoff * sigma, least) / step - slack) + 0.5

        def weight(distance: Array) -> Array:
            return jnp.where(distance / step <= reach, jnp.exp(-0.5 * (distance / sigma) ** 2), 0.0)

        distance = jnp.abs(lag if period is None else lag - period * jnp.round(lag / period))
        if not self.normalized:
            return weight(distance)
        # the distances that occur: one period, or the length of the axis on either side
        count = lag.shape[0] if period is None else round(period / step)
        lags = np.arange(count)
        lags = np.minimum(lags, count - lags) if period is not None else np.concatenate([lags[:0:-1], lags])
        return weight(distance) / (jnp.sum(weight(jnp.asarray(lags * step, lag.dtype))) * step)
