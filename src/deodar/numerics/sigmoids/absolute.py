"""The sigmoid of cedar, built on the absolute value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.numerics.intervals import Interval
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Absolute(SigmoidFunction):
    r"""A sigmoid without an exponential; it approaches 0 and 1 slowly, so a field at rest has some output.

    Equation:
        g(u) = \frac{1}{2} \left( 1 + \frac{\beta (u - \theta)}{1 + \beta |u - \theta|} \right)

    Parameters:
        beta: steepness at the threshold, per unit of activation; > 0. The slope there is beta / 2.
        threshold: theta, activation at which the output is 1/2.

    Shapes:
        Any shape in, the same out.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 2.
    """

    beta: Annotated[
        float, Live("1/activation", lower=1e-6, upper=1e6, meaning="steepness at the threshold")
    ] = 100.0
    threshold: Annotated[float, Live("activation", meaning="activation of half output")] = 0.0

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
