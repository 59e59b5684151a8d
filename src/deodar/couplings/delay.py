"""The delay by one step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

from jax import Array

from deodar.element import Arrays, Element, Setting, Time
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.intervals import Interval, hull
from deodar.numerics.positions import PositionUnits
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Delay(Element):
    r"""A delay of the input by one step.

    A connection with `reads="delayed"` is compiled to this element. `DelayLine` delays by any time.

    Equation:
        y(x, t + dt) = \mathrm{input}(x, t)

    Parameters:
        axes: axes of the input.
        initial: output in the first step.

    Ports:
        input: over `axes`.
        output: over `axes`.

    Reference:
        no reference
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the register")] = ()
    initial: Annotated[float, Live(meaning="output in the first step")] = 0.0

    stateful: ClassVar[bool] = True

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": hull((self.initial, self.initial), inputs["input"])}

    def position_units(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, PositionUnits]
    ) -> Mapping[str, PositionUnits]:
        return {"output": inputs["input"]}

    def init(self, at: Setting) -> Arrays:
        return {"held": at.full(tuple(self.axes), self.initial)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": state["held"]}

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"held": inputs["input"]}
