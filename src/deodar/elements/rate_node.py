"""The neural node with an output for its rate of change."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Element, Setting, Time
from deodar.leaves import is_neutral
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, hull, times, total
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.numerics.sigmoids.logistic import Logistic
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class RateNode(Element):
    r"""A neural node that stores its rate of change as a state, for phase plots.

    r is the rate of change at the time of u; the next Euler step uses the stored r.

    Equation:
        r = \frac{-u + h + c\, g(u) + s(t)}{\tau}
        \frac{du}{dt} = r + q\, \xi(t)

    Parameters:
        tau: time constant, in the document's time unit; > 0.
        resting_level: h, the attractor without input.
        sigmoid: g, output as a function of activation.
        self_excitation: c, strength of the node's coupling to itself; a negative value inhibits.
        noise: q, strength of the noise on u itself (not divided by tau). Euler step: q sqrt(dt).

    Ports:
        input: s, the sum of all connections, one number.
        output: g(u), one number.
        activation: u, one number.
        rate: r, one number.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 3 with self-excitation.
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    tau: Annotated[float, Live("time", role="time constant", lower=1e-6, meaning="time constant")] = 10.0
    resting_level: Annotated[
        float, Live("activation", section="time course", meaning="attractor without input")
    ] = -5.0
    sigmoid: Annotated[SigmoidFunction, Recompile(meaning="output function")] = Logistic()
    self_excitation: Annotated[
        float, Live("activation", section="interaction", meaning="coupling of the node to itself")
    ] = 0.0
    noise: Annotated[
        float, Live("activation", lower=0, neutral=0.0, section="noise", meaning="strength of the noise")
    ] = 0.0

    stateful: ClassVar[bool] = True
    levels: ClassVar[Mapping[str, Mapping[str, str]]] = {
        "activation": {"threshold": "sigmoid.threshold", "resting level": "resting_level"}
    }

    def recurrence(self) -> Mapping[str, Sign]:
        return {"self-excitation": sign_of(self.self_excitation)} if self.self_excitation else {}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return ()

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": (), "activation": (), "rate": ()}

    def noise_axes(self) -> Axes | None:
        return None if is_neutral(self.noise) else ()

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        h, u = self.resting_level, before.get("activation", (self.resting_level, self.resting_level))
        spread = 6.0 * self.noise * math.sqrt(self.tau / 2)
        own = times((self.self_excitation, self.self_excitation), self.sigmoid.bounds(u))
        u = hull(u, total((h - spread, h + spread), inputs["input"], own))
        return {"activation": u, "output": self.sigmoid.bounds(u)}

    def init(self, at: Setting) -> Arrays:
        u = at.full((), self.resting_level)
        return {"activation": u, "rate": self._rate(u, jnp.zeros_like(u))}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        u = state["activation"]
        return {"output": self.sigmoid(u), "activation": u, "rate": state["rate"]}

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        u = state["activation"] + time.dt * state["rate"]
        if noise is not None:
            u = u + jnp.sqrt(time.dt) * self.noise * noise
        return {"activation": u, "rate": self._rate(u, inputs["input"])}

    def _rate(self, u: Array, s: Array) -> Array:
        return (-u + self.resting_level + self.self_excitation * self.sigmoid(u) + s) / self.tau
