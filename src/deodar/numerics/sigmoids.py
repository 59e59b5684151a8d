"""Sigmoids: the output of a field as a function of its activation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.numerics.intervals import ANY, Interval, times
from deodar.parameters import Live, Part
from deodar.registry import register

POINTS = 5


@dataclass(frozen=True)
class SigmoidFunction(Part):
    """The base class of output functions g(u), applied to each sample.

    Class attributes:
        jumps: whether g jumps, so that it has no derivative that a gradient could follow.
    """

    jumps: ClassVar[bool] = False

    def __call__(self, u: Array) -> Array:
        """Return the output for activation u; same shape."""
        raise NotImplementedError

    def ends(self, u: Array) -> tuple[Array, ...] | None:
        """Return expensive terms of `mean` at an end of a range of activation, which neighbouring ranges
        share.

        None without such terms.
        """
        return None

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return the mean of g over the activations between a and b, g(a) where they are equal; same shape.

        A sigmoid with a closed antiderivative overrides this with the exact mean; the default is
        Gauss-Legendre quadrature with five points.

        Args:
            a: one end.
            b: the other end; it may be below a, or equal.
            at_a: `ends(a)`, if known.
            at_b: `ends(b)`, if known.
        """
        places, weights = np.polynomial.legendre.leggauss(POINTS)
        middle, half = 0.5 * (a + b), 0.5 * (b - a)
        return sum(  # type: ignore[return-value] # a sum of arrays
            float(w) / 2 * self(middle + float(p) * half) for p, w in zip(places, weights, strict=True)
        )

    def bounds(self, u: Interval) -> Interval:
        """Return the smallest and largest output for activation in an interval."""
        return ANY


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
        beta: steepness at the threshold; per unit of activation, > 0.
        threshold: theta, activation at which the output is 1/2.

    Shapes:
        Any shape in, the same out.

    Reference:
        Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures,
        Front. Neurosci. 7:276, eq. 3.
    """

    beta: Annotated[float, Live("1/activation", lower=1e-6, upper=1e6)] = 4.0
    threshold: Annotated[float, Live("activation")] = 0.0

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


@register
@dataclass(frozen=True)
class Absolute(SigmoidFunction):
    r"""A sigmoid without an exponential; it approaches 0 and 1 slowly, so a field at rest has some output.

    Equation:
        g(u) = \frac{1}{2} \left( 1 + \frac{\beta (u - \theta)}{1 + \beta |u - \theta|} \right)

    Parameters:
        beta: steepness at the threshold; per unit of activation, > 0. The slope there is beta / 2.
        threshold: theta, activation at which the output is 1/2.

    Shapes:
        Any shape in, the same out.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 2.
    """

    beta: Annotated[float, Live("1/activation", lower=1e-6, upper=1e6)] = 100.0
    threshold: Annotated[float, Live("activation")] = 0.0

    def __call__(self, u: Array) -> Array:
        v = self.beta * (u - self.threshold)
        return 0.5 * (1.0 + v / (1.0 + jnp.abs(v)))

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return (1 + (F(b) - F(a)) / (v(b) - v(a))) / 2 with F = |v| - log(1 + |v|), v = beta (u - theta).

        On one side of theta it is computed with a single logarithm.
        """
        va, vb = self.beta * (a - self.threshold), self.beta * (b - self.threshold)
        wa, wb = jnp.abs(va), jnp.abs(vb)
        low, d = jnp.minimum(wa, wb), jnp.abs(wb - wa)
        share = d / (1.0 + low)
        safe = jnp.where(share > 0, share, 1.0)
        one_side = 1.0 - jnp.where(share > 0, jnp.log1p(safe) / safe, 1.0) / (1.0 + low)
        crosses = (va < 0) != (vb < 0)
        signed = (vb - jnp.sign(vb) * jnp.log1p(wb)) * jnp.sign(vb) - (
            va - jnp.sign(va) * jnp.log1p(wa)
        ) * jnp.sign(va)
        over = signed / jnp.where(crosses, vb - va, 1.0)
        return 0.5 * (1.0 + jnp.where(crosses, over, jnp.where(va + vb > 0, one_side, -one_side)))

    def bounds(self, u: Interval) -> Interval:
        low, high = (max(min(self.beta * (v - self.threshold), 1e300), -1e300) for v in u)
        return 0.5 * (1 + low / (1 + abs(low))), 0.5 * (1 + high / (1 + abs(high)))


@register
@dataclass(frozen=True)
class Step(SigmoidFunction):
    r"""A step between 0 and 1, the output function of Amari's analysis.

    Equation:
        g(u) = \begin{cases} 1 & u > \theta \\ 0 & \text{else} \end{cases}

    Parameters:
        threshold: theta, activation above which the output is 1.

    Shapes:
        Any shape in, the same out.

    Reference:
        Amari (1977), Dynamics of pattern formation in lateral-inhibition type neural fields, Biol. Cybern.
        27, 77-87.
    """

    threshold: Annotated[float, Live("activation")] = 0.0

    jumps: ClassVar[bool] = True

    def __call__(self, u: Array) -> Array:
        return (u > self.threshold).astype(u.dtype)

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return the share of the range above the threshold."""
        va, vb = a - self.threshold, b - self.threshold
        d = vb - va
        return jnp.where(d == 0, self(a), jnp.maximum(vb, 0.0) - jnp.maximum(va, 0.0)) / jnp.where(
            d == 0, 1.0, d
        )

    def bounds(self, u: Interval) -> Interval:
        return float(u[0] > self.threshold), float(u[1] > self.threshold)


@register
@dataclass(frozen=True)
class Linear(SigmoidFunction):
    r"""A linear output function, for linear stages of an architecture.

    Equation:
        g(u) = \mathrm{slope}\, (u - \theta)

    Parameters:
        slope: output per unit of activation.
        threshold: theta, activation of zero output.

    Shapes:
        Any shape in, the same out.

    Reference:
        no reference
    """

    slope: Annotated[float, Live("1/activation")] = 1.0
    threshold: Annotated[float, Live("activation")] = 0.0

    def __call__(self, u: Array) -> Array:
        return self.slope * (u - self.threshold)

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return the output in the middle of the range."""
        return self(0.5 * (a + b))

    def bounds(self, u: Interval) -> Interval:
        return times((self.slope, self.slope), (u[0] - self.threshold, u[1] - self.threshold))


@register
@dataclass(frozen=True)
class SemiLinear(SigmoidFunction):
    r"""An output function that is 0 below the threshold and linear above it.

    Equation:
        g(u) = \max(0, \mathrm{slope}\, (u - \theta))

    Parameters:
        slope: output per unit of activation; above the threshold, >= 0.
        threshold: theta, activation below which the output is 0.

    Shapes:
        Any shape in, the same out.

    Reference:
        Rutishauser & Douglas (2009), State-dependent computation using coupled recurrent networks,
        Neural Comput. 21, 478-509 (the rectification f of its eqs. 2.1).
    """

    slope: Annotated[float, Live("1/activation", lower=0)] = 1.0
    threshold: Annotated[float, Live("activation")] = 0.0

    def __call__(self, u: Array) -> Array:
        return jnp.maximum(0.0, self.slope * (u - self.threshold))

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return the output in the middle if the range does not contain the threshold; else slope (max(a, b)
        - theta)^2 / (2 |b - a|).
        """
        va, vb = a - self.threshold, b - self.threshold
        crosses = (va < 0) != (vb < 0)
        top = jnp.maximum(va, vb)
        inside = jnp.maximum(0.5 * (va + vb), 0.0)
        return (
            self.slope
            * jnp.where(crosses, 0.5 * top * top, inside)
            / jnp.where(crosses, jnp.abs(vb - va), 1.0)
        )

    def bounds(self, u: Interval) -> Interval:
        low, high = times((self.slope, self.slope), (u[0] - self.threshold, u[1] - self.threshold))
        return max(0.0, low), max(0.0, high)
