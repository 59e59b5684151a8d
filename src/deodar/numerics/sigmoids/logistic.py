"""The logistic sigmoid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import jax

from deodar.numerics.sigmoids._base import Sigmoid
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Logistic(Sigmoid):
    r"""Smooth step between 0 and 1, the usual output function of a field.

    Equation:
        g(u) = 1 / (1 + exp(-beta (u - theta)))

    Parameters:
        beta: steepness at the threshold, per unit of activation; > 0.
        threshold: theta, activation at which the output is 1/2.

    Shapes:
        Any shape in, the same out.

    Reference:
        Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures,
        Front. Neurosci. 7:276, eq. 3.
    """

    beta: Annotated[float, Live("1/activation", lower=1e-6, upper=1e6, meaning="steepness at the threshold")] = 4.0
    threshold: Annotated[float, Live("activation", meaning="activation of half output")] = 0.0

    def __call__(self, u: Any) -> Any:
        # by tanh it would be exactly 0 in single precision where it should be 1e-8 and less
        return jax.nn.sigmoid(self.beta * (u - self.threshold))
