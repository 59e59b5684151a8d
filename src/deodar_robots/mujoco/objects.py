"""Objects that a user or an experiment puts into a scene: boxes and cylinders that can be pushed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from deodar.codec import Json
from deodar.errors import WorldError
from deodar.parameters import real, show
from deodar.worlds._scene import pair
from deodar_robots.mujoco.scene_file import FreeBody

SHAPES = ("cylinder", "box")
HEIGHT = 0.01
DENSITY = 400.0
"""Density of objects, kg/m3: that of light wood."""


@dataclass(frozen=True)
class PlacedObject:
    """An object on the plane z = 0 that can be pushed.

    Attributes:
        name: name of the object.
        center: x and y of its middle, m.
        size: size along x and y, m; a cylinder has the first as its diameter.
        color: red, green and blue, 0 to 1.
        height: height, m.
        shape: `cylinder` or `box`.
    """

    name: str
    center: tuple[float, float]
    size: tuple[float, float]
    color: tuple[float, float, float]
    height: float = HEIGHT
    shape: str = "cylinder"

    @classmethod
    def checked(
        cls,
        name: str,
        center: Sequence[float],
        size: Sequence[float],
        color: Sequence[float],
        height: float | None,
        shape: str,
    ) -> PlacedObject:
        """Make an object of values that a user gave.

        Raises:
            WorldError: a value is not a number, out of range, or not a known shape.
        """
        if shape not in SHAPES:
            raise WorldError(f"has the shape {show(shape)}; expected one of {', '.join(SHAPES)}", where=name)
        wide = pair(f"{name}.size", size)
        high = real(HEIGHT if height is None else height)
        if min(wide) <= 0 or high is None or not 0 < high < math.inf:
            raise WorldError(
                f"has the size {show(size)} and the height {show(height)}; expected lengths above 0",
                where=name,
            )
        shades = [real(c) for c in color]
        if len(shades) != 3 or any(c is None or not 0 <= c <= 1 for c in shades):
            raise WorldError(
                f"has the colour {show(color)}; expected red, green and blue, each 0 to 1", where=name
            )
        red, green, blue = (float(c) for c in shades if c is not None)
        return cls(name, pair(f"{name}.center", center), wide, (red, green, blue), high, shape)

    def body(self) -> FreeBody:
        """Return the object as a body of a scene."""
        half = [self.size[0] / 2, self.size[1] / 2, self.height / 2]
        round_ = self.shape == "cylinder"
        return {
            "name": self.name,
            "position": [*self.center, self.height / 2],
            "geom": "mjGEOM_CYLINDER" if round_ else "mjGEOM_BOX",
            "size": [half[0], half[2], 0] if round_ else half,
            "color": [*self.color, 1],
            "density": DENSITY,
        }

    def to_data(self) -> dict[str, Json]:
        """Return the object as plain data."""
        return {
            "name": self.name,
            "center": list(self.center),
            "size": list(self.size),
            "color": list(self.color),
            "height": self.height,
            "shape": self.shape,
        }

    @classmethod
    def from_data(cls, data: Any) -> PlacedObject:
        """Make an object from what `to_data` returned."""
        return cls.checked(**data)
