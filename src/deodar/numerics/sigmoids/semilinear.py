"""The semi-linear output function."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.numerics.intervals import Interval, times
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class SemiLinear(SigmoidFunction):
    r"""An output function that is 0 below the threshold and linear above it.

    Equation:
        g(u) = \max(0, \mathrm{slope}\, (u - \theta))

    Parameters:
        slope: output per unit of activation above the threshold; >= 0.
        threshold: theta, activation below which the output is 0.

    Shapes:
        Any shape in, the same out.

    Reference:
        Rutishauser & Douglas (2009), State-dependent computation using coupled recurrent networks,
        Neural Comput. 21, 478-509 (the rectification f of its eqs. 2.1).
    """

    slope: Annotated[float, Live("1/activation", lower=0, meaning="output per unit of activation")] = 1.0
    threshold: Annotated[float, Live("activation", meaning="activation below which there is no output")] = 0.0

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
