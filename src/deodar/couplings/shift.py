"""The fixed shift."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import per_axis
from deodar.numerics import resampling
from deodar.numerics.convolution import along
from deodar.parameters import PerAxis, Rebuild
from deodar.registry import register


@register
@dataclass(frozen=True)
class Shift(Coupling):
    """Moves a pattern: a peak at x arrives at x + amount.

    Equation:
        y(x) = input(x - amount), interpolated linearly; zero comes in at the ends of an axis that is not periodic

    Parameters:
        amount: how far, in axis units, one or one for each axis.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), appendix A (the
        plain shifts between its fields).
    """

    amount: Annotated[PerAxis, Rebuild("axis", meaning="how far")] = 0.0

    linear: ClassVar[bool] = True

    def prepare(self, at: Setting) -> Any:
        axes = at.ins["input"]
        amounts = per_axis(self.amount, axes)
        return [resampling.weights(a, at.points(a) - s, "linear", at.dtype) for a, s in zip(axes, amounts, strict=True)]

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        y = inputs["input"]
        for d, weights in enumerate(constants):
            y = along(weights, y, d)
        return {"output": y}
