"""The pointwise sum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval
from deodar.numerics.positions import PositionUnits
from deodar.registry import register


@register
@dataclass(frozen=True)
class Sum(Coupling):
    r"""The sum of several connections as one signal, for several targets or for another coupling.

    Equation:
        y(x) = \sum \mathrm{inputs}(x)

    Parameters:
        none.

    Ports:
        input: any axes: those of the connection with the most axes (then the most samples); others expand.
        output: the same axes.

    Reference:
        no reference
    """

    linear: ClassVar[bool] = True

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": inputs["input"]}

    def position_units(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, PositionUnits]
    ) -> Mapping[str, PositionUnits]:
        return {"output": inputs["input"]}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": inputs["input"]}
