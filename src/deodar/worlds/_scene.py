"""A world as it is seen from above: what a picture of it needs, and where something fits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from deodar.errors import UnknownName, WorldError, did_you_mean
from deodar.parameters import real, show

TOUCH = 1e-5
"""A share of the longer side: what overlaps by less only touches. Places come in single precision."""


@dataclass(frozen=True)
class SceneBox:
    """Something solid that stands parallel to both axes: its middle, its size, its colour (red, green, blue,
    0 to 1); `fixed`: no hand moves it.
    """

    name: str
    center: tuple[float, float]
    size: tuple[float, float]
    color: tuple[float, float, float]
    fixed: bool = False

    def gap(self, x: float, y: float) -> float:
        """How far a place lies from it; 0 inside."""
        return math.hypot(
            max(abs(x - self.center[0]) - self.size[0] / 2, 0.0),
            max(abs(y - self.center[1]) - self.size[1] / 2, 0.0),
        )


@dataclass(frozen=True)
class Mark:
    """A place that has a name and is not solid, such as a goal; `fixed`: no hand moves it."""

    name: str
    center: tuple[float, float]
    fixed: bool = False


@dataclass(frozen=True)
class SceneBody:
    """Something round that moves by itself: its middle, where it looks (rad; 0 along x, counter-clockwise),
    its radius.
    """

    name: str
    center: tuple[float, float]
    heading: float
    radius: float


@dataclass(frozen=True)
class Scene:
    """What there is to see of a world from above, at one moment.

    Attributes:
        unit: of all lengths.
        border: lower x, lower y, upper x, upper y.
        boxes, marks, bodies: what stands in it, what is marked, what moves by itself.
    """

    unit: str
    border: tuple[float, float, float, float]
    boxes: tuple[SceneBox, ...] = ()
    marks: tuple[Mark, ...] = ()
    bodies: tuple[SceneBody, ...] = ()

    def thing(self, name: str) -> SceneBox | Mark:
        """What a hand may move, by its name."""
        things = {thing.name: thing for thing in (*self.marks, *self.boxes)}
        if name not in things:
            raise UnknownName(f"nothing here is called {name!r}", fix=did_you_mean(name, things))
        if things[name].fixed:
            raise WorldError("cannot be moved by hand", where=name)
        return things[name]

    def require_room(self, name: str, center: Sequence[float], size: Sequence[float] | None = None) -> None:
        """Refuse a place where something of that name does not fit: with its middle beyond the border or
        inside a box, or (with a size) on a body or a mark.
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
        here, slack = (
            SceneBox(name, (x, y), pair(f"{name}.size", size), (0, 0, 0)),
            TOUCH * max(right - left, high - low),
        )
        for other, radius in (*((b, b.radius) for b in self.bodies), *((m, 0.0) for m in self.marks)):
            if other.name != name and here.gap(*other.center) < max(radius - slack, slack):
                raise WorldError(f"at {at} it would stand on {other.name!r}", where=name)


def pair(what: str, given: Any) -> tuple[float, float]:
    """Two finite numbers."""
    numbers = [real(v) for v in given] if isinstance(given, Sequence) and not isinstance(given, str) else []
    found = [n for n in numbers if n is not None and math.isfinite(n)]
    if len(numbers) != 2 or len(found) != 2:
        raise WorldError(f"is {show(given)}; it is two finite numbers", where=what)
    return found[0], found[1]
