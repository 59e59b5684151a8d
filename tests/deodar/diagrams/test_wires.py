"""Connections of a diagram: they begin and end at the ends of their segments, with the mark at the target."""

from __future__ import annotations

import math

import pytest

from deodar.diagrams import paint, wires
from deodar.diagrams.layout import Segment
from deodar.diagrams.scene import Drawing, SceneItem, Shape, TextLine
from deodar.numerics.signs import Sign

RUNS = [Segment(0, 40, 5), Segment(60, 100, 25)]


def ends(shape: Shape) -> list[tuple[float, float]]:
    """Return the first and the last point of a path."""
    moves = [move for move in shape.path if move[1:]]
    return [(float(move[-2]), float(move[-1])) for move in (moves[0], moves[-1])]


@pytest.mark.parametrize("sign", ["+", "-", "±"])
def test_a_connection_runs_from_its_source_to_the_mark_at_its_target(sign: Sign) -> None:
    line, *mark = wires.path(RUNS, False, sign)
    (start, end), reach = ends(line), max(float(m[-2]) for shape in mark for m in shape.path if m[1:])
    assert start == (0, 5) and end[1] == 25
    assert reach == pytest.approx(100, abs=0.1) and 85 < end[0] < 100


def test_a_connection_to_the_left_runs_from_the_other_side() -> None:
    line, mark = wires.path(RUNS, True, "+")
    (start, end), reach = ends(line), min(float(m[-2]) for m in mark.path if m[1:])
    assert start == (100, 25) and end[1] == 5
    assert reach == pytest.approx(0, abs=0.1) and 0 < end[0] < 15


@pytest.mark.parametrize("direction", [(1, 0), (-1, 0), (0, 1), (0, -1), (0.6, 0.8), (-0.8, 0.6)])
def test_an_arrow_points_in_its_direction(direction: tuple[float, float]) -> None:
    (dx, dy), (x, y) = direction, (10, 20)
    (arrow,) = wires.mark((x, y), direction, "+")
    tip, one, other = ((float(m[-2]), float(m[-1])) for m in arrow.path if m[1:])
    assert tip == (x, y)
    for corner, side in ((one, 1), (other, -1)):
        along = (x - corner[0]) * dx + (y - corner[1]) * dy
        across = (corner[1] - y) * dx - (corner[0] - x) * dy
        assert along == pytest.approx(wires.ARROW)
        assert across == pytest.approx(side * wires.ARROW * math.tan(math.radians(24)))
    for sign in ("-", "±"):
        *_, dot = wires.mark((x, y), direction, sign)
        length = wires.DOT if sign == "-" else wires.ARROW + wires.DOT
        for point in ends(dot):
            assert math.dist(point, (x - dx * length, y - dy * length)) == pytest.approx(wires.DOT)


def test_inhibition_is_dashed_and_a_delayed_connection_dotted() -> None:
    lines: dict[tuple[Sign, bool], tuple[float, ...]] = {}
    signs: tuple[Sign, ...] = ("+", "-", "±")
    for sign in signs:
        for delayed in (False, True):
            straight, *_ = wires.path(RUNS, False, sign, delayed)
            around, *_ = wires.loop(0, 0, 10, 8, sign, delayed)
            assert straight.dash == around.dash
            lines[sign, delayed] = straight.dash
    assert lines["+", False] == lines["±", False] == ()
    assert lines["-", True] == lines["-", False] + lines["+", True]
    assert len(set(lines.values())) == 4


def test_the_margin_moves_text_and_shapes_alike() -> None:
    content = [TextLine("u", 3, 4, 10), Shape((("M", 3, 4), ("L", 5, 6)))]
    framed = paint._framed(Drawing(20, 10, "", [SceneItem("box", "", content)]))
    text, shape = framed.parts[0].content
    assert isinstance(text, TextLine) and isinstance(shape, Shape)
    assert (text.x, text.y) == shape.path[0][1:] == (3 + paint.MARGIN, 4 + paint.MARGIN)
    assert (framed.width, framed.height) == (20 + 2 * paint.MARGIN, 10 + 2 * paint.MARGIN)
