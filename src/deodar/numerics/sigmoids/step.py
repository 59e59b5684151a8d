"""The step function."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.numerics.intervals import Interval
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.parameters import Live
from deodar.registry import register


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

    threshold: Annotated[float, Live("activation", meaning="activation above which the output is 1")] = 0.0

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
