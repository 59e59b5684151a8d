"""A round vehicle with two wheels: its dimensions, and its kinematics as pure functions of one copy."""

from __future__ import annotations

import math
from dataclasses import dataclass

import jax.numpy as jnp
from jax import Array


@dataclass(frozen=True)
class Infrared:
    """Infrared distance sensors, with a table of readings over distance.

    Attributes:
        forward: position of each sensor in front of the axle, m.
        left: position of each sensor to the left of the middle, m.
        angles: direction of each sensor, rad, counter-clockwise from straight ahead.
        distances: distances at which the reading is known, m, rising; beyond the last one the reading is
            constant. The reading jumps at a distance that is listed twice.
        readings: reading at those distances, in `unit`.
        noise: standard deviation at those distances, as a share of the reading.
        meaning: what the readings are, and the order of the sensors.
        unit: unit of the readings; "" if they have none.
        reflects: whether readings depend on the reflectance of objects; False if they state distances.
    """

    forward: tuple[float, ...]
    left: tuple[float, ...]
    angles: tuple[float, ...]
    distances: tuple[float, ...]
    readings: tuple[float, ...]
    noise: tuple[float, ...]
    meaning: str = "readings of the infrared sensors"
    unit: str = ""
    reflects: bool = True

    @property
    def count(self) -> int:
        """Number of sensors."""
        return len(self.angles)


@dataclass(frozen=True)
class VehicleCamera:
    """A colour camera that looks straight ahead, parallel to the floor; a pinhole without distortion.

    Attributes:
        horizontal, vertical: field of view, rad.
        height: height above the floor, m.
        forward: position in front of the axle, m.
    """

    horizontal: float
    vertical: float
    height: float
    forward: float = 0.0


@dataclass(frozen=True)
class Vehicle:
    """A round body on two driven wheels.

    Attributes:
        name: name of the vehicle.
        radius: radius of the body, m.
        wheel_radius: radius of the wheels, m.
        axle: distance between the wheels, m.
        steps_per_turn: motor steps in one turn of a wheel; wheel speeds are given in steps per second.
        fastest: largest speed of a wheel, steps per second.
        infrared: distance sensors.
        camera: colour camera, or None.
    """

    name: str
    radius: float
    wheel_radius: float
    axle: float
    steps_per_turn: float
    fastest: float
    infrared: Infrared
    camera: VehicleCamera | None = None

    @property
    def step_length(self) -> float:
        """Distance that a wheel rolls in one motor step, m."""
        return 2 * math.pi * self.wheel_radius / self.steps_per_turn


def drive(vehicle: Vehicle, heading: Array, steps: Array) -> tuple[Array, Array]:
    """Compute the displacement (2,) of the axle in m and its turn in rad.

    The motor steps (left, right) are made at constant speed, so the axle moves on a circle; the displacement
    is the chord, exact for a turn of any size::

        turn = (right - left) / axle,
        chord = (left + right) / 2 * sin(turn / 2) / (turn / 2), at heading + turn / 2

    Reference:
        Siegwart, Nourbakhsh & Scaramuzza (2011), Introduction to autonomous mobile robots, section 5.2.4.
    """
    rolled = steps * vehicle.step_length
    turn = (rolled[1] - rolled[0]) / vehicle.axle
    chord = 0.5 * (rolled[0] + rolled[1]) * jnp.sinc(turn / (2 * math.pi))
    return chord * ahead(heading + 0.5 * turn), turn


def ahead(heading: Array) -> Array:
    """Return the unit vector (2,) of a heading; heading 0 points along x, and it grows counter-clockwise."""
    return jnp.stack([jnp.cos(heading), jnp.sin(heading)])


def wrapped(angle: Array) -> Array:
    """Wrap an angle to [-pi, pi], so that float32 keeps its precision after many turns of the vehicle."""
    return angle - 2 * math.pi * jnp.round(angle / (2 * math.pi))


def limited(vehicle: Vehicle, left: Array, right: Array) -> Array:
    """Clip the wheel speeds (2,) to the range of the motors."""
    return jnp.clip(jnp.stack([left, right]), -vehicle.fastest, vehicle.fastest)
