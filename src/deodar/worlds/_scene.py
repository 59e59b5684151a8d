"""The view of a world from above, and its solids for the view in three dimensions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from deodar.errors import UnknownName, WorldError, did_you_mean
from deodar.parameters import real, show
from deodar.summary import Summarised, Summary

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


TOUCH = 1e-5
"""Largest overlap that is only a touch, as a share of the border's longer side; positions are in float32."""


@dataclass(frozen=True)
class SceneBox:
    """A solid box with sides parallel to the axes.

    Attributes:
        name: name of the box.
        center: x and y of its middle.
        size: size along x and y.
        color: red, green and blue, 0 to 1.
        fixed: whether the user cannot move it.
    """

    name: str
    center: tuple[float, float]
    size: tuple[float, float]
    color: tuple[float, float, float]
    fixed: bool = False

    def gap(self, x: float, y: float) -> float:
        """Return the distance of a position from the box; 0 inside."""
        return math.hypot(
            max(abs(x - self.center[0]) - self.size[0] / 2, 0.0),
            max(abs(y - self.center[1]) - self.size[1] / 2, 0.0),
        )


@dataclass(frozen=True)
class Mark:
    """A named position that is not solid, such as a goal; `fixed`: the user cannot move it."""

    name: str
    center: tuple[float, float]
    fixed: bool = False


@dataclass(frozen=True)
class SceneBody:
    """A round body that moves by itself.

    Attributes:
        name: name of the body.
        center: x and y of its middle.
        heading: rad; 0 along x, counter-clockwise.
        radius: radius, in the unit of the scene.
    """

    name: str
    center: tuple[float, float]
    heading: float
    radius: float


@dataclass(frozen=True)
class ScenePicture:
    """What a camera of the world sees now, drawn for people; models read its sensors instead.

    Attributes:
        name: name of the picture.
        columns, rows: its size, pixels.
        pixels: red, green and blue of each pixel, a byte each, row by row from the top.
    """

    name: str
    columns: int
    rows: int
    pixels: bytes


@dataclass(frozen=True, repr=False)
class Scene(Summarised):
    """View of a world from above, at one moment; a world with bodies in three dimensions has its solids too.

    Attributes:
        unit: unit of all lengths.
        border: lower x, lower y, upper x, upper y.
        boxes, marks, bodies: solid objects, named positions, and bodies that move by themselves.
        solids: what is drawn in three dimensions; the same object until something else is drawn.
        poses: position and rotation matrix of each solid, `POSE` numbers of float32.
        picture: what a camera of the world sees; None: it has none, or none that is drawn.
    """

    unit: str
    border: tuple[float, float, float, float]
    boxes: tuple[SceneBox, ...] = ()
    marks: tuple[Mark, ...] = ()
    bodies: tuple[SceneBody, ...] = ()
    solids: tuple[Solid, ...] = ()
    poses: bytes = b""
    picture: ScenePicture | None = None

    def entry(self, name: str) -> SceneBox | Mark:
        """Return the box or mark of a name, if the user may move it.

        Raises:
            UnknownName: the scene has no box or mark of that name.
            WorldError: it is fixed.
        """
        objects = {piece.name: piece for piece in (*self.marks, *self.boxes)}
        if name not in objects:
            raise UnknownName(f"nothing here is called {name!r}", fix=did_you_mean(name, objects))
        if objects[name].fixed:
            raise WorldError("cannot be moved by hand", where=name)
        return objects[name]

    def require_room(self, name: str, center: Sequence[float], size: Sequence[float] | None = None) -> None:
        """Raise WorldError if an object does not fit at a position.

        Its middle must lie within the border and outside all other boxes; an object with a size must not
        cover a body or a mark.
        """
        x, y = pair(f"{name}.center", center)
        left, low, right, high = self.border
        at = f"({x:.4g}, {y:.4g})"
        if not (left <= x <= right and low <= y <= high):
            span = f"{left:g} to {right:g}, {low:g} to {high:g} {self.unit}".rstrip()
            raise WorldError(f"{at} lies outside the border, {span}", where=name)
        for box in self.boxes:
            if box.name != name and box.gap(x, y) == 0:
                raise WorldError(f"{at} lies inside {box.name!r}", where=name)
        if size is None:
            return
        covered, slack = (
            SceneBox(name, (x, y), pair(f"{name}.size", size), (0, 0, 0)),
            TOUCH * max(right - left, high - low),
        )
        for piece, radius in (*((b, b.radius) for b in self.bodies), *((m, 0.0) for m in self.marks)):
            if piece.name != name and covered.gap(*piece.center) < max(radius - slack, slack):
                raise WorldError(f"at {at} it would cover {piece.name!r}", where=name)

    def _summary(self) -> Summary:
        rows = [(name, len(getattr(self, name))) for name in ("boxes", "marks", "bodies", "solids")]
        return Summary(f"Scene in {self.unit}", rows)


def pair(label: str, x_y: Sequence[float]) -> tuple[float, float]:
    """Convert a value to two finite floats, or raise WorldError."""
    numbers = [real(v) for v in x_y] if isinstance(x_y, Sequence) and not isinstance(x_y, str) else []
    finite = [n for n in numbers if n is not None and math.isfinite(n)]
    if len(numbers) != 2 or len(finite) != 2:
        raise WorldError(f"is {show(x_y)}; expected two finite numbers", where=label)
    return finite[0], finite[1]
