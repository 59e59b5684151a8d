"""The position of the largest sample."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class MaximumPosition(Coupling):
    r"""The position of the largest sample; of several equal ones the first.

    It jumps by whole samples, and noise moves it. `PeakPosition` and `RateCode` give the mean of a peak.

    Equation:
        x_{\mathrm{max}} = \begin{cases} \arg \max_x f(x) & \max_x f(x) > \mathrm{least} \\
            \mathrm{absent} & \text{else} \end{cases}

    Parameters:
        least: value that the largest sample must exceed.
        absent: output along every axis if it does not, in axis units.

    Ports:
        input: f, any axes, at least one.
        output: one number for one axis, in axis units; for several axes, an axis with one sample for each of
            them, in their order.

    Reference:
        no reference
    """

    least: Annotated[float, Live(meaning="value that the largest sample must exceed")] = 0.1
    absent: Annotated[float, Live("axis", meaning="position while there is none")] = 0.0

    jumps: ClassVar[bool] = True
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",)}

    def jumps_at(self) -> Sequence[str]:
        return "input", "least"

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        n = len(ins["input"])
        return {"output": (Axis("component", 0, n - 1, n),) if n > 1 else ()}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        if not ins["input"]:
            yield "needs an input with an axis, not one number"

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        axes, f = at.ins["input"], inputs["input"]
        places = jnp.unravel_index(jnp.argmax(f), f.shape)
        there = jnp.max(f) > self.least
        found = [
            jnp.where(there, axis.lower + axis.step * place, self.absent).astype(at.dtype)
            for axis, place in zip(axes, places, strict=True)
        ]
        return {"output": jnp.stack(found) if len(found) > 1 else found[0]}
