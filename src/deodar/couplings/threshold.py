"""The threshold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import ZERO, Interval, hull
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Threshold(Coupling):
    r"""A threshold: the input where it exceeds the level, 0 elsewhere.

    Equation:
        y(x) = \begin{cases} \mathrm{input}(x) & \mathrm{input}(x) > \mathrm{level} \\ 0 &
            \text{else} \end{cases}

    Parameters:
        level: the threshold, in units of the input. For an output of 0 or 1 use the coupling `Sigmoid` with
            `Step`.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 12 (the thresholded sum).
    """

    level: Annotated[float, Live(meaning="the threshold")] = 0.5

    def jumps_at(self) -> Sequence[str]:
        return "input", "level"

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        low, high = inputs["input"]
        return {"output": ZERO if high <= self.level else hull(ZERO, (max(low, self.level), high))}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        x = inputs["input"]
        return {"output": jnp.where(x > self.level, x, jnp.zeros_like(x))}
