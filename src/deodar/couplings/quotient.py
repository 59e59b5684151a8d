"""The pointwise quotient."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Quotient(Coupling):
    r"""The pointwise quotient of two signals, for normalisation.

    Each port sums all connections into it.

    Equation:
        y(x) = \begin{cases} \frac{\mathrm{input}(x)}{\mathrm{divisor}(x)} & |\mathrm{divisor}(x)| \ge
            \mathrm{least} \\ \frac{\mathrm{input}(x)}{\mathrm{least}} & \text{else} \end{cases}

    Parameters:
        least: the divisor where the port's magnitude is smaller; > 0.

    Ports:
        input: any axes.
        divisor: the axes of `input`; one number divides all samples.
        output: the axes of `input`.

    Reference:
        no reference
    """

    least: Annotated[float, Live(lower=1e-30, meaning="divisor in place of smaller ones")] = 1e-6

    inputs: ClassVar[tuple[str, ...]] = ("input", "divisor")
    follows: ClassVar[Mapping[str, str]] = {"divisor": "input"}
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "divisor")}

    def jumps_at(self) -> Sequence[str]:
        return ("least",)

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        d = inputs["divisor"]
        return {"output": inputs["input"] / jnp.where(jnp.abs(d) >= self.least, d, self.least)}
