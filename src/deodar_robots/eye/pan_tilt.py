"""The pan-tilt unit that moves a camera, and where a point of the screen appears on its retina, as pure
functions.
"""

from __future__ import annotations

import dataclasses as dc
import math

import jax.numpy as jnp
from jax import Array

from deodar.worlds._settings import From0, PositiveNumber, WorldSettings

PIXELS = 128
"""Columns and rows of the retina."""

CENTRE = (PIXELS - 1) / 2
"""Column and row of the centre of the retina."""

FAR = 400.0
"""Distance from the axis of the camera, servo units, at which the gain is larger by `curvature`."""

ROUNDS = 8
"""Iterations of the inverse; its error is below 1e-3 pixels for a curvature of 0.3 and less."""


@dc.dataclass(frozen=True)
class PanTilt(WorldSettings):
    """A camera on two servo motors, with its map from directions, relative to its axis, to the retina.

    Attributes:
        gain: pixels per servo unit at the centre.
        curvature: relative growth of the gain 400 servo units from the axis.
        roll: rotation of the camera about its axis, rad.
        lag: time constant of the servo motors, ms; 0: they follow at once.
    """

    gain: PositiveNumber = 0.18
    curvature: From0 = 0.12
    roll: float = 0.06
    lag: From0 = 25.0

    def to_retina(self, direction: Array) -> Array:
        """Return column and row, shape (..., 2), of a direction in servo units, shape (..., 2)."""
        c, s = math.cos(self.roll), math.sin(self.roll)
        a, b = direction[..., 0], direction[..., 1]
        k = self.gain * (1 + self.curvature * (a * a + b * b) / FAR**2)
        return CENTRE + jnp.stack([k * (c * a - s * b), k * (s * a + c * b)], axis=-1)

    def to_direction(self, place: Array) -> Array:
        """Return the direction, servo units, that appears at a column and row: the inverse of `to_retina`."""
        c, s = math.cos(self.roll), math.sin(self.roll)
        x, y = place[..., 0] - CENTRE, place[..., 1] - CENTRE
        flat = jnp.stack([c * x + s * y, c * y - s * x], axis=-1) / self.gain
        found = flat
        for _ in range(ROUNDS):
            found = flat / (1 + self.curvature * jnp.sum(found * found, axis=-1, keepdims=True) / FAR**2)
        return found
