"""Couplings that command a moving body."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays, Coupling, PortAxes, Setting
from deodar.leaves import is_neutral
from deodar.numerics.axes import Axes, Axis, cell, one_axis, shape, wrong_shape
from deodar.parameters import ArrayLike, FrozenArray, Live, Rebuild
from deodar.registry import register


@register
@dataclass(frozen=True)
class AttractorVelocity(Coupling):
    r"""The velocity of a body whose attractor is the position of a peak; it is 0 without a peak.

    The body reports its position p, so that its own dynamics, a limit or a push do not matter: `Attractor`
    integrates the same equation where no body does. The integral N of the input f scales the velocity. With
    `fastest` the vector is shortened and keeps its direction. On a periodic axis of length L, such as a
    heading, the body turns the shorter way.

    Equation:
        N = \int f(x)\, dx
        \tau v = -\int (p - x)\, f(x)\, dx = \int x f(x)\, dx - N p
        \tau v = \frac{L}{2\pi} \int \sin\!\left( \frac{2\pi (x - p)}{L} \right) f(x)\, dx \text{ (periodic)}

    Parameters:
        axes: the dimensions of the position; other axes of the source are integrated out. By default those of
            the source.
        tau: time scale; document time times the integral of the input, so that tau / N is the relaxation
            time, at least one step.
        fastest: largest length of v; axis units per unit of the document's time; 0: no limit.

    Ports:
        input: f, over the axes.
        position: p, one number for one axis; for several axes, an axis with one sample for each of them, in
            their order.
        output: v, with the axes of `position`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 12-15. The periodic form:
        Schöner, Dose & Engels (1995), Robot. Auton. Syst. 16, 213-245.
    """

    axes: Sequence[Axis] = ()
    tau: Annotated[float, Live("time x input", role="time scale", lower=1e-9)] = 100.0
    fastest: Annotated[float, Live("axis/time", role="speed", lower=0, neutral=0.0, off=True)] = 0.0

    inputs: ClassVar[tuple[str, ...]] = ("input", "position")

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return tuple(self.axes) if port == "input" and self.axes else arriving

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": ins["position"]}

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        axes, arriving = ins["input"], shape(ins["position"])
        wanted = len(axes)
        if wanted == 0:
            yield "its input has no axes, so it has no position", "Connect a field, or state axes"
        if wanted and arriving != (wanted,) and not (wanted == 1 and arriving == ()):
            takes = "one number" if wanted == 1 else f"one axis with {wanted} samples"
            yield (
                f"takes {takes} at its port 'position', one for each axis of its input; that has"
                f" {list(arriving)} samples",
                "Connect a position of that shape",
            )

    def output(self, at: Setting) -> Arrays:
        axes = at.ins["input"]
        f, p = at.inputs["input"] * cell(axes), jnp.reshape(at.inputs["position"], (len(axes),))
        rates: list[Array] = []
        for d, axis in enumerate(axes):
            along = jnp.sum(f, axis=tuple(k for k in range(len(axes)) if k != d))
            # the distances are summed, not the positions, so that no digits are lost far from 0
            distances = at.points(axis) - p[d]
            if axis.periodic:
                turn = 2 * math.pi / axis.range
                distances = jnp.sin(turn * distances) / turn
            rates.append(jnp.sum(distances * along))
        v = jnp.stack(rates) / self.tau
        if not is_neutral(self.fastest):
            length = jnp.sqrt(jnp.sum(v**2))
            v = v * jnp.minimum(1.0, self.fastest / jnp.maximum(length, jnp.finfo(at.dtype).tiny))
        return {"output": jnp.reshape(v, jnp.shape(at.inputs["position"]))}

    @classmethod
    def example(cls) -> AttractorVelocity:
        return cls([Axis("x", 0, 20, samples=21)], name="example")


@register
@dataclass(frozen=True)
class ObstacleRepulsion(Coupling):
    r"""The force of obstacles on a vehicle's heading: a repeller in the direction of each distance sensor.

    The repeller of a sensor is strong where the measured distance is short, and wide where the obstacle fills
    the sensor's view. It turns the vehicle away: a sensor at the right (positive angle) turns it to the left
    (negative force).

    Equation:
        F = -\sum_i \operatorname{sign}(\psi_i)\, S_i \exp\!\left( -\frac{\psi_i^2}{2 R_i^2} \right)
        S_i = \mathrm{strength}\, \exp\!\left( -\frac{D_i}{\mathrm{reach}} \right)
        R_i = \arctan\!\left( \tan\frac{\mathrm{view}}{2} + \frac{\mathrm{size}}{\mathrm{size} +
            D_i} \right)

    Parameters:
        angles: psi, direction of each sensor relative to the heading; degrees, positive to the right.
        strength: force of a single obstacle at distance 0 straight ahead.
        reach: distance over which a force decreases by a factor of e; in the unit of the distances.
        size: size of the vehicle; in the unit of the distances.
        view: opening angle of a sensor, degrees.

    Ports:
        input: D, distance of the nearest obstacle at each sensor; one axis with a sample for each angle.
        output: F, one number, positive to the right.

    Shapes:
        angles: the samples of the input's axis, in their order.

    Reference:
        Sandamirskaya & Schöner (2010), Neural Netw. 23, 1164-1179, eqs. A.2 and A.3, with the exponent
        -psi^2 / (2 R^2) (the square is missing in print) and the sign of a repeller, as in Schöner, Dose &
        Engels (1995), Robot. Auton. Syst. 16, 213-245.
    """

    angles: Annotated[ArrayLike, Rebuild()] = FrozenArray(np.array([-90.0, -45.0, -9.0, 11.0, 45.0, 90.0]))
    strength: Annotated[float, Live(lower=0)] = 15.0
    reach: Annotated[float, Live(lower=1e-6)] = 30.0
    size: Annotated[float, Live(lower=1e-6)] = 100.0
    view: Annotated[float, Live(lower=0, upper=179)] = 45.0

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": ()}

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        yield from one_axis(ins["input"])
        if len(ins["input"]) == 1:
            yield from wrong_shape("angles", self.angles, shape(ins["input"]), "the input has")

    def jumps_at(self) -> Sequence[str]:
        return ("angles",)

    def prepare(self, at: Setting) -> Arrays:
        return {"angles": at.array(self.angles)}

    def output(self, at: Setting) -> Arrays:
        angles, distances = at.constants["angles"], at.inputs["input"]
        strength = self.strength * jnp.exp(-distances / self.reach)
        half = jnp.tan(jnp.deg2rad(jnp.asarray(self.view, distances.dtype)) / 2)
        wide = jnp.rad2deg(jnp.arctan(half + self.size / (self.size + distances)))
        return {"output": -jnp.sum(jnp.sign(angles) * strength * jnp.exp(-0.5 * (angles / wide) ** 2))}

    @classmethod
    def example(cls) -> ObstacleRepulsion:
        return cls(np.linspace(-90.0, 90.0, 21), name="example")  # type: ignore[arg-type]


@register
@dataclass(frozen=True)
class TurnLimit(Coupling):
    r"""A limit of a vehicle's turning rate: both wheels slow down by the same factor.

    The radius of the curve does not change.

    Equation:
        s = \min\!\left(1, \frac{\mathrm{limit}}{|\mathrm{speed}\, (\mathrm{left} -
            \mathrm{right})|}\right)
        \mathrm{to\_left} = s\, \mathrm{speed}\, \mathrm{left}
        \mathrm{to\_right} = s\, \mathrm{speed}\, \mathrm{right}

    Parameters:
        speed: speed of a wheel for an input of 1; in the motor's unit.
        limit: largest difference between the speeds of the wheels; in the motor's unit, > 0.

    Ports:
        left: command for the left wheel, one number.
        right: command for the right wheel, one number.
        to_left: speed of the left wheel, one number.
        to_right: speed of the right wheel, one number.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), its published simulator.
    """

    speed: Annotated[float, Live("motor")] = 500.0
    limit: Annotated[float, Live("motor", lower=1e-6)] = 400.0

    inputs: ClassVar[tuple[str, ...]] = ("left", "right")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "to_left": ("left", "right"),
        "to_right": ("left", "right"),
    }

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return ()

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"to_left": (), "to_right": ()}

    def output(self, at: Setting) -> Arrays:
        left, right = self.speed * at.inputs["left"], self.speed * at.inputs["right"]
        share = self.limit / jnp.maximum(jnp.abs(left - right), self.limit)
        return {"to_left": share * left, "to_right": share * right}
