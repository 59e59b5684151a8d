"""A round vehicle with two wheels: what it is made of, and how its wheels move it, as pure functions of one
copy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp


@dataclass(frozen=True)
class Infrared:
    """Infrared distance sensors, and what they read at a distance.

    Attributes:
        forward: how far each sensor stands in front of the axle, m.
        left: how far it stands to the left of the middle, m.
        angles: where it looks, rad, counter-clockwise from straight ahead.
        distances: distances at which the reading is known, m, rising; beyond the last one it stays what it is
            there.
        readings: reading at those distances, without unit.
        noise: standard deviation there, as a share of the reading.
    """

    forward: tuple[float, ...]
    left: tuple[float, ...]
    angles: tuple[float, ...]
    distances: tuple[float, ...]
    readings: tuple[float, ...]
    noise: tuple[float, ...]

    @property
    def count(self) -> int:
        """Number of sensors."""
        return len(self.angles)


@dataclass(frozen=True)
class Vehicle:
    """A round body on two driven wheels.

    Attributes:
        name: what it is called.
        radius: of the body, m.
        wheel_radius: m.
        axle: distance between the wheels, m.
        steps_per_turn: motor steps in one turn of a wheel; wheel speeds are given in steps per second.
        fastest: largest speed of a wheel, steps per second.
        infrared: its distance sensors.
    """

    name: str
    radius: float
    wheel_radius: float
    axle: float
    steps_per_turn: float
    fastest: float
    infrared: Infrared

    @property
    def step_length(self) -> float:
        """How far a wheel rolls in one motor step, m."""
        return 2 * math.pi * self.wheel_radius / self.steps_per_turn


def drive(vehicle: Vehicle, heading: Any, steps: Any) -> tuple[Any, Any]:
    """Where the wheels take the axle: displacement (2,) in m and turn in rad, for motor steps (left, right)
    at constant speed.

    The axle runs on a circle; the displacement is its chord, exact for a turn of any size::

        turn = (right - left) / axle,
        chord = (left + right) / 2 * sin(turn / 2) / (turn / 2), at heading + turn / 2

    Reference:
        Siegwart, Nourbakhsh & Scaramuzza (2011), Introduction to autonomous mobile robots, section 5.2.4.
    """
    rolled = steps * vehicle.step_length
    turn = (rolled[1] - rolled[0]) / vehicle.axle
    chord = 0.5 * (rolled[0] + rolled[1]) * jnp.sinc(turn / (2 * math.pi))
    return chord * ahead(heading + 0.5 * turn), turn


def ahead(heading: Any) -> Any:
    """The unit vector (2,) straight ahead; heading 0 looks along x, and it grows counter-clockwise."""
    return jnp.stack([jnp.cos(heading), jnp.sin(heading)])


def wrapped(angle: Any) -> Any:
    """An angle in [-pi, pi], so that single precision loses nothing however often the vehicle turns."""
    return angle - 2 * math.pi * jnp.round(angle / (2 * math.pi))


def limited(vehicle: Vehicle, left: Any, right: Any) -> Any:
    """Wheel speeds (2,), each within what the motors can."""
    return jnp.clip(jnp.stack([left, right]), -vehicle.fastest, vehicle.fastest)
