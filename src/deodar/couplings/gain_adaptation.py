"""Gains that adapt to an error signal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, cell, shape, wrong_shape
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import ArrayLike, Live, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class GainAdaptation(Coupling):
    r"""A map from the position of a peak to a value, with gains that adapt to an error at that position.

    f is the input, lambda are the gains; without input the value is 0.

    Equation:
        y = \int \lambda(x)\, f(x)\, dx
        \mathrm{value} = \frac{y}{\int f(x)\, dx}
        \tau \frac{d\lambda(x)}{dt} = \mathrm{gate}\, \mathrm{error}\, f(x)

    Parameters:
        tau: time scale: document time times error times input, over a change of the gains; > 0, and at
            least one step.
        initial: gains at the start, equal at all samples.
        gated: whether the element has a port `gate`; without it the gate is 1.
        start: gains at the start, in place of `initial`; for example gains learned in an earlier run.

    Ports:
        input: f, any axes; usually the output of a motor field.
        error: one number with a sign: desired minus reached value, in units of the gains.
        gate: the time window of learning, one number, only if `gated`. Values below 0 count as 0.
        output: y, one number: the input of the motor variable of eq. 9.
        value: the attractor of that motor variable, one number.
        gains: lambda, over the axes of the input.

    Shapes:
        start: the samples of the input's axes, in their order.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 13, with eq. 9. Corrected: the printed epsilon is
        error times time window, here two ports, and the error is signed, so that gains can also decrease.
        With the decay of eq. 9 multiplied by the integral of f (as printed, the attractor would not vanish
        with the peak) the value changes at the rate error integral f^2 / (tau integral f): an error decays
        exponentially, at a rate that depends neither on the width of the peak nor on the sampling.
    """

    tau: Annotated[float, Live("time x input", role="time scale", lower=1e-6, meaning="time scale")] = 100.0
    initial: Annotated[float, Live(meaning="gains at the start")] = 0.0
    gated: Annotated[bool, Recompile(meaning="whether learning waits for the gate")] = False
    start: Annotated[ArrayLike | None, Rebuild(meaning="gains at the start")] = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "error", "gate")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "value": ("input",)}
    stateful: ClassVar[bool] = True

    def polarity(self) -> Sign:
        return sign_of(self.initial, self.start)

    def ports(self) -> tuple[str, ...]:
        return self.inputs if self.gated else self.inputs[:2]

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving if port == "input" else ()

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": (), "value": (), "gains": ins["input"]}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        yield from wrong_shape("start", self.start, shape(ins["input"]), "the input has")

    def init(self, at: Setting) -> Arrays:
        return {
            "gains": at.full(at.ins["input"], self.initial) if self.start is None else at.array(self.start)
        }

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        gains, f = state["gains"], inputs["input"] * cell(at.ins["input"])
        drive, whole = jnp.sum(gains * f), jnp.sum(f)
        return {
            "output": drive,
            "value": jnp.where(whole > 0, drive / jnp.where(whole > 0, whole, 1.0), 0.0),
            "gains": gains,
        }

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        speed = time.dt / self.tau * inputs["error"]
        if self.gated:
            speed = speed * jnp.maximum(inputs["gate"], 0.0)
        return {"gains": state["gains"] + speed * inputs["input"]}

    def learned_parameters(self, state: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        return {"start": state["gains"]}

    @classmethod
    def example(cls) -> GainAdaptation:
        return cls(gated=True, initial=0.5, name="example")
