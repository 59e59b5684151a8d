"""The pointwise product."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, times
from deodar.registry import register


@register
@dataclass(frozen=True)
class Product(Coupling):
    r"""The pointwise product of two signals, for gating.

    Each port sums all connections into it.

    Equation:
        y(x) = \mathrm{input}(x) \cdot \mathrm{factor}(x)

    Parameters:
        none.

    Ports:
        input: any axes.
        factor: the axes of `input`; one number multiplies all samples.
        output: the axes of `input`.

    Reference:
        no reference
    """

    inputs: ClassVar[tuple[str, ...]] = ("input", "factor")
    follows: ClassVar[Mapping[str, str]] = {"factor": "input"}
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "factor")}

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": times(inputs["input"], inputs["factor"])}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": inputs["input"] * inputs["factor"]}
