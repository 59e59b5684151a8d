"""The logistic sigmoid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import jax
import jax.numpy as jnp
from jax import Array

from deodar.numerics.intervals import Interval
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.parameters import Live
from deodar.registry import register

_SERIES = (
    -0.00853880788,
    0.0440882267,
    -0.107679777,
    0.17745109,
    -0.244954163,
    0.33275472,
    -0.499974049,
    0.999999806,
)
"""log(1 + y) / y for 0 <= y <= 1, highest power first: a polynomial fitted to a relative error of 2e-7.

It vectorises; log1p does not.
"""

_NEAR, _NEAR_DOUBLE = 0.01, 1e-5
"""Range of beta u below which the mean uses its Taylor series, in single and double precision: both forms
have the same error there.
"""


@register
@dataclass(frozen=True)
class Logistic(SigmoidFunction):
    r"""A smooth step between 0 and 1, the usual output function of a field.

    Equation:
        g(u) = \frac{1}{1 + e^{-\beta (u - \theta)}}

    Parameters:
        beta: steepness at the threshold, per unit of activation; > 0.
        threshold: theta, activation at which the output is 1/2.

    Shapes:
        Any shape in, the same out.

    Reference:
        Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures,
        Front. Neurosci. 7:276, eq. 3.
    """

    beta: Annotated[
        float, Live("1/activation", lower=1e-6, upper=1e6, meaning="steepness at the threshold")
    ] = 4.0
    threshold: Annotated[float, Live("activation", meaning="activation of half output")] = 0.0

    def __call__(self, u: Array) -> Array:
        # with tanh it would be exactly 0 in single precision for values of 1e-8 and less
        return jax.nn.sigmoid(self.beta * (u - self.threshold))

    def ends(self, u: Array) -> tuple[Array, ...]:
        """Return log(1 + exp(-|v|)), the decaying part of the antiderivative, and exp(-|v|), with v = beta (u
        - theta).
        """
        v = self.beta * (u - self.threshold)
        small = jnp.exp(-jnp.abs(v))
        if small.dtype == jnp.float32:
            series = jnp.full_like(small, _SERIES[0])
            for c in _SERIES[1:]:
                series = series * small + c
            decaying = small * series
        else:
            decaying = jnp.log1p(small)
        return decaying, small

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return (log(1 + exp(beta (b - theta))) - log(1 + exp(beta (a - theta)))) / (beta (b - a)).

        Near a = b it is the Taylor series about a.
        """
        (low, s), (high, _) = at_a or self.ends(a), at_b or self.ends(b)
        va, vb = self.beta * (a - self.threshold), self.beta * (b - self.threshold)
        d = vb - va
        close = jnp.abs(d) < (_NEAR if d.dtype == jnp.float32 else _NEAR_DOUBLE)
        # near a = b: g + g (1 - g) d / 2, with the denominator q^2, so that both forms need one division
        q = 1.0 + s
        series = jnp.where(va > 0, 1.0, s) * q + 0.5 * s * d
        return jnp.where(
            close, series, jnp.maximum(vb, 0.0) - jnp.maximum(va, 0.0) + (high - low)
        ) / jnp.where(close, q * q, d)

    def bounds(self, u: Interval) -> Interval:
        low, high = (self.beta * (v - self.threshold) for v in u)
        return 1 / (1 + math.exp(min(-low, 700.0))), 1 / (1 + math.exp(min(-high, 700.0)))
