"""The glyphs of boxes."""

from __future__ import annotations

import pytest

from deodar.diagrams import boxes
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
