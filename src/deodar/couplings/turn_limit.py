"""The limit of a vehicle's turning rate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.parameters import Live
from deodar.registry import register


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
        speed: speed of a wheel for an input of 1, in the motor's unit.
        limit: largest difference between the speeds of the wheels, in the motor's unit; > 0.

    Ports:
        left: command for the left wheel, one number.
        right: command for the right wheel, one number.
        to_left: speed of the left wheel, one number.
        to_right: speed of the right wheel, one number.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), its published simulator.
    """

    speed: Annotated[float, Live("motor", meaning="speed of a wheel for an input of 1")] = 500.0
    limit: Annotated[
        float, Live("motor", lower=1e-6, meaning="largest difference between the speeds of the wheels")
    ] = 400.0

    inputs: ClassVar[tuple[str, ...]] = ("left", "right")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "to_left": ("left", "right"),
        "to_right": ("left", "right"),
    }

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return ()

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"to_left": (), "to_right": ()}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        left, right = self.speed * inputs["left"], self.speed * inputs["right"]
        share = self.limit / jnp.maximum(jnp.abs(left - right), self.limit)
        return {"to_left": share * left, "to_right": share * right}
