"""The sigmoid of a signal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.numerics.sigmoids.logistic import Logistic
from deodar.parameters import Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Sigmoid(Coupling):
    r"""The sigmoid of a signal, such as a sum or a sensor's reading.

    Equation:
        y(x) = g(\mathrm{input}(x))

    Parameters:
        sigmoid: g, the sigmoid function.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 2 and the text before it.
    """

    sigmoid: Annotated[SigmoidFunction, Recompile(meaning="g")] = Logistic()

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": self.sigmoid.bounds(inputs["input"])}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": self.sigmoid(inputs["input"])}
