"""The semi-linear output function."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp

from deodar.numerics.sigmoids._base import Sigmoid
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class SemiLinear(Sigmoid):
    """Silent below the threshold, proportional above it.

    Equation:
        g(u) = max(0, slope (u - theta))

    Parameters:
        slope: output per unit of activation above the threshold; >= 0.
        threshold: theta, activation below which there is no output.

    Shapes:
        Any shape in, the same out.

    Reference:
        Rutishauser & Douglas (2009), State-dependent computation using coupled recurrent networks,
        Neural Comput. 21, 478-509 (the rectification f of its eqs. 2.1).
    """

    slope: Annotated[float, Live("1/activation", lower=0, meaning="output per unit of activation")] = 1.0
    threshold: Annotated[float, Live("activation", meaning="activation below which there is no output")] = 0.0

    def __call__(self, u: Any) -> Any:
        return jnp.maximum(0.0, self.slope * (u - self.threshold))
