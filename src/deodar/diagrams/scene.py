"""Scene: shapes and text with positions, independent of any file format."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

Point = tuple[float, float]
PathCommand = tuple[str, *tuple[float, ...]]
"""M x y, L x y, C x1 y1 x2 y2 x y, or Z; y grows downwards."""


@dataclass(frozen=True)
class Shape:
    """A path. An empty colour means no fill or no stroke."""

    path: tuple[PathCommand, ...]
    stroke: str = ""
    fill: str = ""
    width: float = 0.8
    dash: tuple[float, ...] = ()


@dataclass(frozen=True)
class TextLine:
    """One line of text; `anchor` is start, middle or end, and y the base line."""

    text: str
    x: float
    y: float
    size: float
    anchor: str = "middle"
    color: str = "#1a1a1a"
    bold: bool = False
    italic: bool = False


@dataclass
class SceneItem:
    """Shapes of one element or connection, with a title that a browser shows as a tooltip."""

    role: str
    title: str
    content: list[Shape | TextLine] = field(default_factory=list["Shape | TextLine"])


@dataclass
class Drawing:
    """A picture: its size in points, its title, and its parts from back to front."""

    width: float
    height: float
    title: str
    parts: list[SceneItem]

    def __iter__(self) -> Iterator[Shape | TextLine]:
        for part in self.parts:
            yield from part.content


def rectangle(x: float, y: float, w: float, h: float, r: float = 0.0) -> tuple[PathCommand, ...]:
    """Return a rectangle with round corners."""
    if r <= 0:
        return (("M", x, y), ("L", x + w, y), ("L", x + w, y + h), ("L", x, y + h), ("Z",))
    k = r * 0.4477
    return (
        ("M", x + r, y), ("L", x + w - r, y), ("C", x + w - k, y, x + w, y + k, x + w, y + r),
        ("L", x + w, y + h - r), ("C", x + w, y + h - k, x + w - k, y + h, x + w - r, y + h),
        ("L", x + r, y + h), ("C", x + k, y + h, x, y + h - k, x, y + h - r),
        ("L", x, y + r), ("C", x, y + k, x + k, y, x + r, y), ("Z",),
    )  # fmt: skip


def circle(x: float, y: float, r: float) -> tuple[PathCommand, ...]:
    """Return a circle, as four curves."""
    k = 0.5523 * r
    return (
        ("M", x + r, y),
        ("C", x + r, y + k, x + k, y + r, x, y + r),
        ("C", x - k, y + r, x - r, y + k, x - r, y),
        ("C", x - r, y - k, x - k, y - r, x, y - r),
        ("C", x + k, y - r, x + r, y - k, x + r, y),
        ("Z",),
    )


def polygon(*points: Point) -> tuple[PathCommand, ...]:
    """Return a closed line through points."""
    return (("M", *points[0]), *(("L", *p) for p in points[1:]), ("Z",))


def line(*points: Point) -> tuple[PathCommand, ...]:
    """Return an open line through points."""
    return (("M", *points[0]), *(("L", *p) for p in points[1:]))
