"""Shapes and text of a picture are values."""

from __future__ import annotations

import dataclasses as dc

import pytest

from deodar.diagrams.scene import Shape, TextLine, circle, line, rectangle


@pytest.mark.parametrize(
    "make",
    [
        lambda: Shape(rectangle(1, 2, 30, 40, 3.0), "#333333", width=0.9),
        lambda: Shape(circle(5, 5, 3), fill="#ffffff", dash=(2.0, 1.5)),
        lambda: Shape(line((0, 0), (1, 2))),
        lambda: TextLine("u", 3, 4, 10, bold=True),
    ],
)
def test_equal_shapes_are_one_value_that_cannot_be_changed(make) -> None:
    one, other = make(), make()
    assert one == other and len({one, other}) == 1
    for field in dc.fields(one):
        with pytest.raises(dc.FrozenInstanceError):
            setattr(one, field.name, None)


@pytest.mark.parametrize("radius", [0.0, 2.5, 5.0])
def test_a_rectangle_reaches_its_four_sides(radius: float) -> None:
    path = rectangle(10, 20, 30, 40, radius)
    points = [tuple(float(v) for v in move[-2:]) for move in path if move[1:]]
    assert {min(x for x, _ in points), max(x for x, _ in points)} == {10, 40}
    assert {min(y for _, y in points), max(y for _, y in points)} == {20, 60}
    assert path[-1] == ("Z",)
