"""A variable that integrates its input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from jax import Array

from deodar.element import Arrays, Element, Setting, Time
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.parameters import ArrayLike, Live, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Integrator(Element):
    r"""A variable whose rate of change is its input, such as a heading, a count or a position.

    It has no attractor: without input it is constant, and under constant input it grows without bound.

    Equation:
        \frac{dx}{dt} = \mathrm{rate}\, \mathrm{input}(t),\quad x(0) = \mathrm{initial}
        x(t + dt) = x(t) + dt\, \mathrm{rate}\, \mathrm{input}(t)

    Parameters:
        axes: axes of the variable; none: one number.
        rate: factor of the input, per unit of the document's time; the inverse of a time constant.
        initial: x at the start, at every sample.
        start: x at the start, one value for each sample, in place of `initial`.

    Ports:
        input: over `axes`.
        output: x, over `axes`.

    Shapes:
        start: the samples of `axes`, in their order.

    Reference:
        no reference
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the variable")] = ()
    rate: Annotated[float, Live("1/time", role="speed", meaning="factor of the input")] = 0.1
    initial: Annotated[float, Live(meaning="value at the start")] = 0.0
    start: Annotated[ArrayLike | None, Rebuild(meaning="value at the start, for each sample")] = None

    stateful: ClassVar[bool] = True

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        yield from wrong_shape("start", self.start, shape(self.axes))

    def init(self, at: Setting) -> Arrays:
        return {"x": at.full(tuple(self.axes), self.initial) if self.start is None else at.array(self.start)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": state["x"]}

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"x": state["x"] + time.dt * self.rate * inputs["input"]}

    def inject(
        self, state: Mapping[str, np.ndarray], amount: np.ndarray | float, dt: float
    ) -> Mapping[str, np.ndarray] | None:
        return {"x": state["x"] + dt * self.rate * amount}
