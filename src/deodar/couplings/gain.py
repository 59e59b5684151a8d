"""The gain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Gain(Coupling):
    """A coupling strength: positive excites, negative inhibits.

    Equation:
        y(x) = factor * input(x)

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

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        return {"output": self.factor * inputs["input"]}
