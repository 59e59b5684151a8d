"""A mathematical function of each sample."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.parameters import Recompile
from deodar.registry import register

LEAST = 1e-30
"""Smallest argument of the logarithm; smaller ones, and negative ones, give its logarithm, -69.1."""

FUNCTIONS: Mapping[str, Callable[[Array], Array]] = {
    "abs": jnp.abs,
    "square": jnp.square,
    "root": lambda x: jnp.sqrt(jnp.maximum(x, 0.0)),
    "exp": jnp.exp,
    "log": lambda x: jnp.log(jnp.maximum(x, LEAST)),
    "sin": jnp.sin,
    "cos": jnp.cos,
}


@register
@dataclass(frozen=True)
class Pointwise(Coupling):
    r"""A mathematical function of each sample, for conversions between what sensors, fields and motors use.

    The root of a negative number is 0, and the logarithm of a number below 1e-30 that of 1e-30, so that the
    output is finite for every input but large arguments of `exp`. Saturating functions are sigmoids: the
    coupling `Sigmoid`.

    Equation:
        y(x) = \mathrm{function}(\mathrm{input}(x))

    Parameters:
        function: `abs`, `square`, `root`, `exp`, `log` (natural), `sin` or `cos` (of radians).

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        no reference
    """

    function: Annotated[str, Recompile(choices=tuple(FUNCTIONS), meaning="the function")] = "abs"

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": FUNCTIONS[self.function](inputs["input"])}
