"""Variables that follow or integrate their input."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
import numpy as np

from deodar.element import Arrays, Element, PortAxes, PortUnits, Setting
from deodar.leaves import is_neutral
from deodar.numerics.axes import Axes, Axis, one_axis, shape, wrong_shape
from deodar.numerics.positions import PositionUnit
from deodar.parameters import ArrayLike, Live, Rebuild
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
        rate: factor of the input; per unit of the document's time; the inverse of a time constant.
        initial: x at the start, at every sample.
        start: x at the start, one value for each sample; in place of `initial`.

    Ports:
        input: over `axes`.
        output: x, over `axes`.

    Shapes:
        start: the samples of `axes`, in their order.

    Reference:
        no reference
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    rate: Annotated[float, Live("1/time", role="speed")] = 0.1
    initial: Annotated[float, Live()] = 0.0
    start: Annotated[ArrayLike | None, Rebuild()] = None

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from wrong_shape("start", self.start, shape(self.axes))

    def init(self, at: Setting) -> Arrays:
        return {"x": at.full(tuple(self.axes), self.initial) if self.start is None else at.array(self.start)}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.state["x"]}

    def advance(self, at: Setting) -> Arrays:
        return {"x": at.state["x"] + at.time.dt * self.rate * at.inputs["input"]}

    def inject(
        self, state: Mapping[str, np.ndarray], amount: np.ndarray | float, dt: float
    ) -> Mapping[str, np.ndarray] | None:
        return {"x": state["x"] + dt * self.rate * amount}


@register
@dataclass(frozen=True)
class Attractor(Element):
    r"""A motor variable whose attractor is the position of a peak; it is constant without a peak.

    The integral of the input f scales the speed of phi, so phi is constant without a peak. A step
    longer than the relaxation time tau / integral f ends at the attractor. A periodic axis
    does not use `gain` and `offset`.

    Equation:
        \text{linear axis:}\quad \lambda(x) = \mathrm{gain}\, x + \mathrm{offset}
        \tau \frac{d\phi}{dt} = -\phi \int f(x)\, dx + \int \lambda(x)\, f(x)\, dx
        \text{axis of period } P\text{:}
        \tau \frac{d\phi}{dt} = \frac{P}{2 \pi} \int \sin\!\left( \frac{2 \pi (x - \phi)}{P} \right)
            f(x)\, dx

    Parameters:
        axis: the dimension over which the input is defined. By default the axis of the source, which must
            then have exactly one axis.
        tau: time scale; document time times the integral of the input, so that tau / integral f is the
            relaxation time, at least one step.
        initial: phi at the start.
        gain: motor units per axis unit.
        offset: motor value at axis value 0.
        fastest: largest speed of phi; motor units per unit of the document's time; 0: no limit.

    Ports:
        input: f, over the axis; other axes of the source are integrated out.
        output: phi, one number.

    Reference:
        Lomp et al. (2016), Front. Neurorobot. 10:14, eqs. 12-15; Sandamirskaya (2014), Front. Neurosci.
        7:276, eq. 9, with the decay multiplied by the integral (as printed the attractor would not switch off
        with the peak). The periodic form: Schöner, Dose & Engels (1995), Dynamics of behavior, Robot. Auton.
        Syst. 16, with the sine as force.
    """

    name: str = ""
    axis: Axis | None = None
    tau: Annotated[float, Live("time x input", role="time scale", lower=1e-6)] = 100.0
    initial: Annotated[float, Live("motor")] = 0.0
    gain: Annotated[float, Live("motor/axis")] = 1.0
    offset: Annotated[float, Live("motor")] = 0.0
    fastest: Annotated[float, Live("motor/time", role="speed", lower=0, neutral=0.0, off=True)] = 0.0

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving if self.axis is None else (self.axis,)

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": ()}

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        found = ins["input"]
        yield from one_axis(found)
        if len(found) == 1 and found[0].periodic and (self.gain != 1.0 or self.offset != 0.0):
            yield f"gain and offset have no meaning on the periodic axis {found[0].name!r}"

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        axes = ins["input"]
        read = PositionUnit.of(axes[0]) if len(axes) == 1 else None
        return {} if read is None else {"output": (read.scaled(self.gain),)}

    def init(self, at: Setting) -> Arrays:
        return {"phi": at.full((), self.initial)}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.state["phi"]}

    def advance(self, at: Setting) -> Arrays:
        [axis] = at.ins["input"]
        phi, f, x = at.state["phi"], at.inputs["input"] * axis.step, at.points(axis)
        whole = jnp.sum(f)
        # a step longer than the relaxation time would overshoot, so its length is limited to the attractor
        share = at.time.dt / jnp.maximum(self.tau, at.time.dt * jnp.abs(whole))
        if axis.periodic:
            turn = 2 * math.pi / axis.range
            move = jnp.sum(jnp.sin(turn * (x - phi)) * f) / turn * share
        else:
            move = (jnp.sum((self.gain * x + self.offset) * f) - phi * whole) * share
        if not is_neutral(self.fastest):
            move = jnp.clip(move, -self.fastest * at.time.dt, self.fastest * at.time.dt)
        phi = phi + move
        if axis.periodic:
            phi = axis.lower + jnp.mod(phi - axis.lower, axis.range)
        return {"phi": phi}

    @classmethod
    def example(cls) -> Attractor:
        return cls("example", Axis("x", 0, 20, samples=21))
