"""The pan-tilt unit that moves a camera, with the optics of the camera on it."""

from __future__ import annotations

import dataclasses as dc

from deodar.worlds._settings import From0, PositiveNumber, WorldSettings
from deodar_robots.eye.optics import Optics


@dc.dataclass(frozen=True)
class PanTilt(WorldSettings, Optics):
    """A camera on two servo motors.

    Attributes:
        gain: pixels per servo unit.
        curvature: relative growth of the gain 400 servo units from the axis.
        roll: rotation of the camera about its axis, rad.
        lag: time constant of the servo motors, ms; 0: they follow at once.
    """

    gain: PositiveNumber = 0.18
    curvature: From0 = 0.12
    roll: float = 0.06
    lag: From0 = 25.0
