"""The logarithm of a signal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Logarithm(Coupling):
    r"""The logarithmic compression of a signal that ranges over orders of magnitude.

    Equation:
        y(x) = \mathrm{factor} \cdot \ln\!\left( 1 + \frac{\max(\mathrm{input}(x),
            0)}{\mathrm{scale}} \right)

    Parameters:
        factor: strength.
        scale: input above which the compression is noticeable; > 0.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), appendix A and its published simulator
        (proximity sensors).
    """

    factor: Annotated[float, Live(meaning="strength")] = 1.0
    scale: Annotated[float, Live(lower=1e-6, meaning="input at which the logarithm begins to compress")] = 1.0

    def polarity(self) -> Sign:
        return sign_of(self.factor)

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": self.factor * jnp.log1p(jnp.maximum(inputs["input"], 0.0) / self.scale)}
