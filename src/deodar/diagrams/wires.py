"""Wires: paths with marks at their ends that show excitation or inhibition."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from deodar.diagrams.layout import Segment
from deodar.diagrams.scene import PathCommand, Point, Shape, circle, polygon
from deodar.numerics.signs import Sign

COLORS: dict[Sign, str] = {"+": "#333333", "-": "#d55e00", "±": "#6a3d9a"}
"""Colours of excitation, inhibition and both; colour-blind readers can distinguish them, and marks and dashes
show the sign in black and white.
"""

WIDTH = 0.9
STRAIGHT = 2.5
"""Length of the horizontal end before a mark, so that the mark has the direction of the curve."""

DASHES, DOTS = (4.0, 2.0), (1.0, 2.0)
ARROW, DOT = 5.0, 2.3


def dash(sign: Sign, delayed: bool = False) -> tuple[float, ...]:
    """Return the lengths of strokes and gaps of a line: inhibition is dashed, a delayed connection dotted."""
    return (DASHES if sign == "-" else ()) + (DOTS if delayed else ())


def path(runs: Sequence[Segment], backwards: bool, sign: Sign, delayed: bool = False) -> list[Shape]:
    """Return a connection along its horizontal segments, with the mark at its target."""
    points = [p for run in runs for p in ((run.x0, run.y), (run.x1, run.y))]
    points, direction = (points[::-1], -1.0) if backwards else (points, 1.0)
    x, y = points[-1]
    tip = (x - direction * _length(sign), y)
    level = tip[0] - direction * STRAIGHT
    between = [(min(px, level) if direction > 0 else max(px, level), py) for px, py in points[1:-1]]
    return [
        Shape(
            _curve([points[0], *between, (level, y), tip]),
            COLORS[sign],
            width=WIDTH,
            dash=dash(sign, delayed),
        ),
        *mark((x, y), (direction, 0.0), sign),
    ]


def loop(x: float, y: float, right: float, height: float, sign: Sign, delayed: bool = False) -> list[Shape]:
    """Return a connection that leaves upwards at (x, y) and returns at (right, y)."""
    w = right - x
    end = y - _length(sign)
    curve: tuple[PathCommand, ...] = (
        ("M", x, y), ("C", x, y - height * 0.9, x + w * 0.1, y - height, x + w / 2, y - height),
        ("C", right - w * 0.1, y - height, right, y - height * 0.9, right, end),
    )  # fmt: skip
    line = Shape(curve, COLORS[sign], width=WIDTH, dash=dash(sign, delayed))
    return [line, *mark((right, y), (0.0, 1.0), sign)]


def mark(tip: Point, direction: Point, sign: Sign) -> list[Shape]:
    """Return an arrow for excitation, a dot for inhibition, or both; the arrow points in `direction`."""
    (x, y), (dx, dy), color = tip, direction, COLORS[sign]
    if sign == "-":
        return [Shape(circle(x - dx * DOT, y - dy * DOT, DOT), color, color, 0.3)]
    arrow = Shape(_arrow(x, y, dx, dy), color, color, 0.3)
    if sign == "+":
        return [arrow]
    back = ARROW + DOT
    return [arrow, Shape(circle(x - dx * back, y - dy * back, DOT), color, color, 0.3)]


def _length(sign: Sign) -> float:
    return {"+": ARROW - 0.5, "-": DOT, "±": ARROW + DOT}[sign]


def _arrow(x: float, y: float, dx: float, dy: float) -> tuple[PathCommand, ...]:
    half = ARROW * math.tan(math.radians(24))
    return polygon(
        (x, y),
        (x - dx * ARROW - dy * half, y - dy * ARROW + dx * half),
        (x - dx * ARROW + dy * half, y - dy * ARROW - dx * half),
    )


def _curve(points: Sequence[Point]) -> tuple[PathCommand, ...]:
    """Return a line that is horizontal at every point and climbs between them."""
    moves: list[PathCommand] = [("M", *points[0])]
    for (x0, y0), (x, y) in itertools.pairwise(points):
        if abs(y - y0) >= 0.05:
            middle = (x + x0) / 2
            moves.append(("C", middle, y0, middle, y, x, y))
        elif abs(x - x0) >= 0.05:
            moves.append(("L", x, y))
    return tuple(moves)
