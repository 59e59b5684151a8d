"""The solids of a world in three dimensions: shapes, which are drawn once, and where they are now."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

SolidShape = Literal["plane", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"]

POSE = 12
"""Numbers of the pose of a solid: its position, and the rows of its rotation matrix."""


@dataclass(frozen=True)
class Mesh:
    """The surface of a solid as triangles, in the frame of the solid.

    Attributes:
        points: x, y and z of each point, as float32.
        faces: three numbers of points for each triangle, as int32.
    """

    points: bytes
    faces: bytes


@dataclass(frozen=True)
class Solid:
    """A rigid solid; x and y are those of the view from above, z points up.

    Attributes:
        body: name of the body that it is a part of.
        shape: its shape.
        size: half lengths along its own axes; sphere: the radius first; capsule, cylinder: the radius, and
            half of the length of the straight part, along its z; plane: half lengths, 0 for an endless one.
        color: red, green, blue and opacity, 0 to 1.
        thing: name of the object of the scene that it shows; empty: none.
        pushable: whether its body can be pushed.
        mesh: its surface, if the shape is a mesh.
    """

    body: str
    shape: SolidShape
    size: tuple[float, float, float]
    color: tuple[float, float, float, float]
    thing: str = ""
    pushable: bool = False
    mesh: Mesh | None = None
