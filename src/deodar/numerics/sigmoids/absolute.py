"""The sigmoid of cedar, built on the absolute value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp

from deodar.numerics.sigmoids._base import Sigmoid
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Absolute(Sigmoid):
    """A sigmoid without an exponential; it approaches 0 and 1 slowly, so that a field at rest leaves some output.

    Equation:
        g(u) = 1/2 (1 + beta (u - theta) / (1 + beta |u - theta|))

    Parameters:
        beta: steepness at the threshold, per unit of activation; > 0. The slope there is beta / 2.
        threshold: theta, activation at which the output is 1/2.

    Shapes:
        Any shape in, the same out.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 2.
    """

    beta: Annotated[float, Live("1/activation", lower=1e-6, upper=1e6, meaning="steepness at the threshold")] = 100.0
    threshold: Annotated[float, Live("activation", meaning="activation of half output")] = 0.0

    def __call__(self, u: Any) -> Any:
        v = self.beta * (u - self.threshold)
        return 0.5 * (1.0 + v / (1.0 + jnp.abs(v)))
