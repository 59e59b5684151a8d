"""Boxes: the size, shape, picture, name and axes of each item."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from deodar.diagrams import text
from deodar.diagrams.graph import Item
from deodar.diagrams.layout import ItemSize
from deodar.diagrams.scene import PathCommand, Shape, TextLine, circle, line, polygon, rectangle
from deodar.numerics.axes import Axis
from deodar.numerics.signs import Sign

INK, SOFT, FAINT = "#1a1a1a", "#4d4d4d", "#8c8c8c"
FILLS = {
    "field": "#eaf2fa",
    "node": "#eaf2fa",
    "source": "#fdf6e3",
    "sensor": "#e9f5ee",
    "motor": "#e9f5ee",
    "coupling": "#ffffff",
    "missing": "#ffffff",
    "group": "#f6f6f6",
}
BLUE = "#0072b2"
NAME, SMALL, PORT = 7.5, 6.0, 5.5
LINE, SMALL_LINE = 8.8, 7.2
ROOM = 92.0
"""Width above which names are broken into lines."""

LOOP = 15.0
"""Height of the loops above a box."""

PICTURE = (46.0, 20.0)
NODE = 11.0
"""Radius of a node without many connections."""

CLOSEST = 4.5
"""Smallest distance of connections at one side of a box; more connections make it higher."""


@dataclass(frozen=True)
class Loop:
    """A connection of an item with itself: its sign, and the text above it."""

    sign: Sign
    captions: tuple[str, ...] = ()
    delayed: bool = False

    @property
    def width(self) -> float:
        """Space along the upper edge."""
        return max(15.0, text.widest(self.captions, SMALL) + 5)


@dataclass(frozen=True)
class SizedItem:
    """An item with its size and the data that determine it: names of connected ports, and loops."""

    item: Item
    lines: tuple[str, ...]
    small: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    loops: tuple[Loop, ...]
    box: ItemSize


def prepare(
    item: Item, inputs: Sequence[str], outputs: Sequence[str], loops: Sequence[Loop], most: int
) -> SizedItem:
    """Compute the size of an item.

    Args:
        item: the item.
        inputs: names of input ports at which wires end, other than the default one.
        outputs: names of output ports where wires begin, other than the default one.
        loops: connections of the item with itself.
        most: number of wires at the side with more wires.
    """
    room = 58.0 if item.form == "coupling" else ROOM
    lines = tuple(text.wrap(item.name, NAME, room, 3, bold=_bold(item)))
    small = tuple(_small(item))
    wide, high = text.widest(lines, NAME, _bold(item)), LINE * len(lines)
    small_wide, small_high = text.widest(small, SMALL), SMALL_LINE * len(small)
    loops_wide = sum(loop.width for loop in loops)
    above = LOOP + SMALL_LINE * max((len(loop.captions) for loop in loops), default=0) if loops else 0.0
    body = max(1, most - 1) * CLOSEST + 6
    if item.form == "node":
        radius = max(NODE, body / 2)
        width = max(2 * radius, wide, small_wide, loops_wide)
        box = ItemSize(width, above + 2 * radius + 2 + high + small_high, above, 2 * radius)
    else:
        ports = sum(max((text.width(p, PORT) + 4 for p in side), default=0.0) for side in (inputs, outputs))
        inner = high + small_high + 5
        width = max(wide, small_wide) + 12
        if item.form in ("field", "source", "sensor", "motor") and item.axes:
            inner += PICTURE[1] + 3
            width = max(width, PICTURE[0] + 14)
        if item.form in ("sensor", "motor"):
            width += 12
        body = max(body, inner)
        box = ItemSize(max(width + ports, loops_wide + 6), above + body, above, body)
    return SizedItem(item, lines, small, tuple(inputs), tuple(outputs), tuple(loops), box)


def paint(drawn: SizedItem, x: float, y: float) -> list[Shape | TextLine]:
    """Return the shapes of an item, given its upper left corner. Its loops are wires and not included."""
    item, box = drawn.item, drawn.box
    top, middle = y + box.top, x + box.width / 2
    dash = (2.0, 1.5) if item.form == "missing" else ()
    stroke = FAINT if item.form in ("coupling", "missing", "source", "group") else INK
    outline = Shape(
        _outline(item, x, top, box), stroke, FILLS[item.form], 0.6 if stroke == FAINT else 0.9, dash
    )
    out: list[Shape | TextLine] = [outline]
    if item.form == "node":
        out += _node_picture(middle, top + box.body / 2, box.body / 2)
        at = top + box.body + 2
    else:
        left = max((text.width(p, PORT) + 4 for p in drawn.inputs), default=0.0)
        right = max((text.width(p, PORT) + 4 for p in drawn.outputs), default=0.0)
        middle = x + left + (box.width - left - right) / 2
        inner = (
            LINE * len(drawn.lines)
            + SMALL_LINE * len(drawn.small)
            + (PICTURE[1] + 3 if _pictured(item) else 0.0)
        )
        at = top + (box.body - inner) / 2
    for name in drawn.lines:
        out.append(TextLine(name, middle, at + 6.8, NAME, bold=_bold(item), color=INK))
        at += LINE
    if item.form != "node" and _pictured(item):
        out += _picture(item, middle - PICTURE[0] / 2, at + 1)
        at += PICTURE[1] + 3
    for small in drawn.small:
        out.append(TextLine(small, middle, at + 5.4, SMALL, color=SOFT))
        at += SMALL_LINE
    return out


def reach(drawn: SizedItem, dy: float) -> float:
    """Return the distance of the outline from the box at a height `dy` above or below the middle of its
    body.
    """
    box, form = drawn.box, drawn.item.form
    if form == "node":
        radius = box.body / 2
        return box.width / 2 - math.sqrt(max(0.0, radius * radius - dy * dy))
    if form in ("sensor", "motor"):
        return 6.0 * abs(dy) / (box.body / 2)
    return 0.0


def height_at(drawn: SizedItem, dx: float) -> float:
    """Return the distance of the outline from the upper edge of the body at a distance `dx` from its
    middle.
    """
    if drawn.item.form != "node":
        return 0.0
    radius = drawn.box.body / 2
    return radius - math.sqrt(max(0.0, radius * radius - dx * dx))


# -------------------------------------------------------------------------------------------- text and shapes


def _bold(item: Item) -> bool:
    return item.form in ("field", "node")


def _pictured(item: Item) -> bool:
    return item.form in ("field", "source", "sensor", "motor") and bool(item.axes)


def _small(item: Item) -> list[str]:
    out = [item.kind] if item.kind else []
    if item.form in ("field", "source", "sensor", "motor"):
        out += [_axis(axis) for axis in item.axes] if item.axes_shown else []
    if item.every > 1:
        out.append(f"every {item.every} steps")
    return [line for one in out for line in text.wrap(one, SMALL, ROOM + 24, 2)]


def _axis(axis: Axis) -> str:
    unit = f" {axis.unit}" if axis.unit else ""
    return (
        f"{axis.name}: {number(axis.lower)} …"
        f" {number(axis.upper)}{unit}{', periodic' if axis.periodic else ''}"
    )


def number(value: float) -> str:
    """Return a number with at most four significant digits and a typographic minus sign."""
    return f"{value:.4g}".replace("-", "\N{MINUS SIGN}")


def _outline(item: Item, x: float, top: float, box: ItemSize) -> tuple[PathCommand, ...]:
    w, h = box.width, box.body
    if item.form == "node":
        return circle(x + w / 2, top + h / 2, h / 2)
    if item.form == "sensor":
        return polygon(
            (x, top),
            (x + w - 6, top),
            (x + w, top + h / 2),
            (x + w - 6, top + h),
            (x, top + h),
            (x + 6, top + h / 2),
        )
    if item.form == "motor":
        return polygon(
            (x + 6, top),
            (x + w - 6, top),
            (x + w, top + h / 2),
            (x + w - 6, top + h),
            (x + 6, top + h),
            (x, top + h / 2),
        )
    return rectangle(
        x, top, w, h, {"field": 2.5, "source": 8.0, "coupling": 4.0, "group": 5.0}.get(item.form, 2.5)
    )


def _node_picture(x: float, y: float, r: float) -> list[Shape | TextLine]:
    """Draw the glyph of a node, a step."""
    s = min(r, NODE) * 0.5
    return [
        Shape(
            line(
                (x - s, y + s * 0.7),
                (x - s * 0.15, y + s * 0.7),
                (x + s * 0.15, y - s * 0.7),
                (x + s, y - s * 0.7),
            ),
            BLUE,
            width=1.0,
        )
    ]


def _picture(item: Item, x: float, y: float) -> list[Shape | TextLine]:
    """Draw the glyph of a field by its number of dimensions: a line, a plane or a volume with a peak."""
    w, h = PICTURE
    dims = len(item.axes)
    if dims == 1:
        base = y + h * 0.82
        bump = _bump(x + 2, base, w - 4, h * 0.66)
        return [Shape(line((x, base), (x + w, base)), SOFT, width=0.6), Shape(bump, BLUE, width=1.1)]
    if dims == 2:
        plane = polygon(
            (x + w * 0.26, y + h * 0.3),
            (x + w * 0.98, y + h * 0.3),
            (x + w * 0.74, y + h * 0.95),
            (x + w * 0.02, y + h * 0.95),
        )
        peak = _bump(x + w * 0.28, y + h * 0.72, w * 0.44, h * 0.68)
        return [Shape(plane, SOFT, "#ffffff", 0.7), Shape(peak, BLUE, "#d3e4f3", 1.0)]
    d, a = h * 0.3, h * 0.66
    x0, y0 = x + (w - a * 1.5 - d) / 2, y + d
    b = a * 1.5
    out: list[Shape | TextLine] = [
        Shape(polygon((x0 + d, y), (x0 + d + b, y), (x0 + b, y0), (x0, y0)), SOFT, "#ffffff", 0.7),
        Shape(
            polygon((x0 + b, y0), (x0 + b + d, y), (x0 + b + d, y + a), (x0 + b, y0 + a)),
            SOFT,
            "#f2f2f2",
            0.7,
        ),
        Shape(rectangle(x0, y0, b, a), SOFT, "#ffffff", 0.7),
        Shape(circle(x0 + b * 0.5, y0 + a * 0.5, a * 0.24), BLUE, "#d3e4f3", 1.0),
    ]
    if dims > 3:
        out.append(TextLine(f"{dims}D", x + w, y + h - 1, PORT, "end", color=SOFT))
    return out


def _bump(x: float, base: float, w: float, h: float) -> tuple[PathCommand, ...]:
    """Return a bell-shaped curve on a base line."""
    m = x + w / 2
    return (
        ("M", x, base),
        ("C", m - w * 0.2, base, m - w * 0.16, base - h, m, base - h),
        ("C", m + w * 0.16, base - h, m + w * 0.2, base, x + w, base),
    )
