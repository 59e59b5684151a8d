"""The transient detector."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Element, Setting, Time
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.integrators import euler
from deodar.numerics.signs import Sign
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class TransientDetector(Element):
    r"""A detector of changes: the difference between the input and a slow copy of it.

    A step of height A gives a pulse A exp(-t / tau); an input of constant slope gives slope times tau.

    Equation:
        \tau \frac{dz}{dt} = -z + s(x, t)
        \mathrm{output} = \max(0, s - z)
        \mathrm{off} = \max(0, z - s)

    Parameters:
        axes: axes of the input; none: one number.
        tau: time constant of the slow copy, in the document's time unit; > 0. A pulse has decayed to 5 %
            after 3 tau.
        initial: z at the start; the difference of the input from it counts as a change.

    Ports:
        input: s, over `axes`.
        output: increases of the input, over `axes`; in the same step as the input.
        off: decreases of the input, over `axes`.

    Reference:
        Berger, Faubel, Norman, Hock & Schöner (2012), The counter-change model of motion perception: an
        account based on dynamic field theory, ICANN 2012, LNCS 7552 (motion perception from detectors of
        increments and of decrements).
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="where it is defined")] = ()
    tau: Annotated[
        float, Live("time", role="time constant", lower=1e-6, meaning="time constant of the slow copy")
    ] = 100.0
    initial: Annotated[float, Live(meaning="slow copy at the start")] = 0.0

    stateful: ClassVar[bool] = True
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "off": ("input",)}

    def polarity(self) -> Sign:
        return "±"

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes), "off": tuple(self.axes)}

    def init(self, at: Setting) -> Arrays:
        return {"slow": at.full(tuple(self.axes), self.initial)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        change = inputs["input"] - state["slow"]
        return {"output": jnp.maximum(0.0, change), "off": jnp.maximum(0.0, -change)}

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        z = state["slow"]
        return {"slow": euler(z, -z + inputs["input"], self.tau, time.dt)}
