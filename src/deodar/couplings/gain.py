"""The gain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, times
from deodar.numerics.positions import PositionUnits
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Gain(Coupling):
    r"""A coupling strength: a positive factor excites, a negative factor inhibits.

    Equation:
        y(x) = \mathrm{factor} \cdot \mathrm{input}(x)

    Parameters:
        factor: strength.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 4, with a factor.
    """

    factor: Annotated[float, Live(meaning="strength")] = 1.0

    linear: ClassVar[bool] = True
    scaled_by: ClassVar[str] = "factor"

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {} if self.factor == 0 else {"output": times((self.factor, self.factor), inputs["input"])}

    def position_units(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, PositionUnits]
    ) -> Mapping[str, PositionUnits]:
        return {"output": tuple(p and p.scaled(self.factor) for p in inputs["input"])}

    def polarity(self) -> Sign:
        return sign_of(self.factor)

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": self.factor * inputs["input"]}
