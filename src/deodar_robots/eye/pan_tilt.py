"""The pan-tilt unit that moves a camera, with the optics of the camera on it."""

from __future__ import annotations

import dataclasses as dc
import math
from typing import Any

from deodar.errors import WorldError
from deodar.parameters import real, show
from deodar.worlds._settings import number
from deodar_robots.eye.optics import Optics


@dc.dataclass(frozen=True)
class PanTilt(Optics):
    """A camera on two servo motors.

    Attributes:
        gain: pixels per servo unit.
        curvature: relative growth of the gain 400 servo units from the axis.
        roll: rotation of the camera about its axis, rad.
        lag: time constant of the servo motors, ms; 0: they follow at once.
    """

    gain: float = 0.18
    curvature: float = 0.12
    roll: float = 0.06
    lag: float = 25.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "gain", number("gain", self.gain, above=0.0))
        object.__setattr__(self, "roll", finite("roll", self.roll))
        for name in ("curvature", "lag"):
            object.__setattr__(self, name, number(name, getattr(self, name)))


def finite(name: str, given: Any) -> float:
    """Return a finite number of any sign, or raise WorldError."""
    value = real(given)
    if value is None or not math.isfinite(value):
        raise WorldError(f"{name} is {show(given)}; expected a finite number")
    return float(value)
