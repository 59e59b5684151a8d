"""The glyphs of boxes."""

from __future__ import annotations

import pytest

from deodar.diagrams import boxes, paint, wires
from deodar.diagrams.graph import Item
from deodar.diagrams.scene import Shape
from deodar.numerics.axes import Axis


def test_a_peak_is_symmetric_and_highest_over_the_middle_of_its_base() -> None:
    start, rise, fall = ([float(v) for v in numbers] for _, *numbers in boxes._bump(10, 50, 20, 15))
    assert (start, rise[-2:], fall[-2:]) == ([10, 50], [20, 35], [30, 50])
    mirrored = [v for x, y in ((rise[2], rise[3]), (rise[0], rise[1])) for v in (40 - x, y)]
    assert fall[:4] == pytest.approx(mirrored)


@pytest.mark.parametrize("dims", [1, 2, 3, 4])
def test_the_glyph_of_a_field_lies_inside_its_place(dims: int) -> None:
    axes = tuple(Axis(name, 0, 10, 5) for name in "xyzw"[:dims])
    width, height = boxes.PICTURE
    shapes = [s for s in boxes._picture(Item("a", "field", "a", "", axes), 100, 200) if isinstance(s, Shape)]
    assert len(shapes) >= 2
    for shape in shapes:
        for _, *numbers in shape.path:
            points = [float(v) for v in numbers]
            assert all(100 <= x <= 100 + width for x in points[::2])
            assert all(200 <= y <= 200 + height for y in points[1::2])


@pytest.mark.parametrize("form", ["node", "field"])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_loops_stand_side_by_side_over_the_middle_of_their_box(form: str, count: int) -> None:
    loops = [boxes.Loop(sign) for sign in ("+", "-", "±")[:count]]
    box = Item("a", form, "a field", "", () if form == "node" else (Axis("x", 0, 10, 5),))  # type: ignore[arg-type]
    drawn = boxes.prepare(box, [], [], loops, 1)
    curves = [
        s
        for s in paint._item(drawn, 100, 50).content
        if isinstance(s, Shape)
        and s.width == wires.WIDTH
        and not s.fill
        and s.stroke in wires.COLORS.values()
    ]
    middles = [(float(s.path[0][1]) + float(s.path[-1][-2])) / 2 for s in curves]
    assert len(middles) == count and middles == sorted(middles)
    assert (middles[0] + middles[-1]) / 2 == pytest.approx(100 + drawn.box.width / 2)
    assert all(100 < x < 100 + drawn.box.width for x in middles)
    for shape in curves:
        assert all(50 <= float(m[-1]) <= 50 + drawn.box.top + drawn.box.body / 2 for m in shape.path)
