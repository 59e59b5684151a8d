"""The repulsion of a vehicle's heading by the obstacles that its distance sensors detect."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, one_axis, shape, wrong_shape
from deodar.parameters import ArrayLike, FrozenArray, Live, Rebuild
from deodar.registry import register


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
        angles: psi, direction of each sensor relative to the heading, degrees, positive to the right.
        strength: force of a single obstacle at distance 0 straight ahead.
        reach: distance over which a force decreases by a factor of e, in the unit of the distances.
        size: size of the vehicle, in the unit of the distances.
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

    angles: Annotated[
        ArrayLike, Rebuild(meaning="direction of each sensor, degrees, positive to the right")
    ] = FrozenArray(np.array([-90.0, -45.0, -9.0, 11.0, 45.0, 90.0]))
    strength: Annotated[float, Live(lower=0, meaning="force of an obstacle at distance 0 straight ahead")] = (
        15.0
    )
    reach: Annotated[float, Live(lower=1e-6, meaning="distance over which a force decreases by e")] = 30.0
    size: Annotated[float, Live(lower=1e-6, meaning="size of the vehicle")] = 100.0
    view: Annotated[float, Live(lower=0, upper=179, meaning="opening angle of a sensor, degrees")] = 45.0

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": ()}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        yield from one_axis(ins["input"])
        if len(ins["input"]) == 1:
            yield from wrong_shape("angles", self.angles, shape(ins["input"]), "the input has")

    def jumps_at(self) -> Sequence[str]:
        return ("angles",)

    def prepare(self, at: Setting) -> Arrays:
        return {"angles": at.array(self.angles)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        angles, distances = constants["angles"], inputs["input"]
        strength = self.strength * jnp.exp(-distances / self.reach)
        half = jnp.tan(jnp.deg2rad(jnp.asarray(self.view, distances.dtype)) / 2)
        wide = jnp.rad2deg(jnp.arctan(half + self.size / (self.size + distances)))
        return {"output": -jnp.sum(jnp.sign(angles) * strength * jnp.exp(-0.5 * (angles / wide) ** 2))}

    @classmethod
    def example(cls) -> ObstacleRepulsion:
        return cls(np.linspace(-90.0, 90.0, 21), name="example")  # type: ignore[arg-type]
