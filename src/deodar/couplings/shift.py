"""The fixed shift."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import per_axis
from deodar.numerics import resampling
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import ZERO, Interval, hull
from deodar.parameters import PerAxis, Rebuild
from deodar.registry import register


@register
@dataclass(frozen=True)
class Shift(Coupling):
    r"""A shift of the input by a fixed amount: a peak at x arrives at x + amount.

    Values between samples are interpolated linearly; an axis that is not periodic is padded with 0.

    Equation:
        y(x) = \mathrm{input}(x - \mathrm{amount})

    Parameters:
        amount: the shift, in axis units, one value or one for each axis.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), appendix
        A (the plain shifts between its fields).
    """

    amount: Annotated[PerAxis, Rebuild("axis", meaning="how far")] = 0.0

    linear: ClassVar[bool] = True

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        for a, amount in zip(ins["input"], per_axis(self.amount, ins["input"]), strict=True):
            if not a.periodic and abs(float(amount)) > a.range:
                what = (
                    f"its amount {float(amount):g} is longer than the axis {a.name!r} ({a.range:g}), so"
                    " everything is shifted out and it gives 0"
                )
                yield what, f"Use an amount below {a.range:g}, or a periodic axis"

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": hull(ZERO, inputs["input"])}

    def prepare(self, at: Setting) -> list[tuple[Array, Array]]:
        axes = at.ins["input"]
        return [
            resampling.steps(a, amount, at.dtype)
            for a, amount in zip(axes, per_axis(self.amount, axes), strict=True)
        ]

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: list[tuple[Array, Array]],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        y = inputs["input"]
        for d, (axis, (whole, part)) in enumerate(zip(at.ins["input"], constants, strict=True)):
            y = resampling.shifted(y, d, axis.periodic, whole, part)
        return {"output": y}
