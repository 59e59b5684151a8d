"""Units of length and angle, and ranges in another unit than an axis."""

from __future__ import annotations

import math

import pytest

from deodar.numerics import units
from deodar.numerics.axes import Axis, barely_overlap


@pytest.mark.parametrize(
    ("text", "symbol", "size"),
    [("cm", "cm", 0.01), (" metres ", "m", 1.0), ("meter", "m", 1.0), ("°", "deg", math.pi / 180)],
)
def test_units_are_known_by_several_names(text: str, symbol: str, size: float):
    unit = units.parse(text)
    assert unit is not None
    assert (unit.symbol, unit.size) == (symbol, pytest.approx(size))


@pytest.mark.parametrize("text", ["", "Hz", "ms", "s", "step/s", "cms", "cm, cm, rad"])
def test_other_texts_are_no_units_of_length_or_angle(text: str):
    assert units.parse(text) is None


def test_a_unit_is_found_by_its_size():
    assert units.of_size("length", 0.01 * (1 + 1e-9)) == units.parse("cm")
    assert units.of_size("length", 0.02) is None
    assert units.of_size("angle", 0.01) is None


def test_an_axis_that_barely_overlaps_a_range_is_reported_with_the_unit_that_fits():
    ((problem, fix),) = barely_overlap(Axis("x", 0, 210, 211), (-1.0, 1.0), "the walls", "m")
    assert problem == "the walls run from -1 to 1 m, and the axis 'x' from 0 to 210: they barely overlap"
    assert fix == "Write unit='cm' for the axis if its values are in cm"
    ((_, fix),) = barely_overlap(Axis("x", 0, 210, 211, unit="cm"), (300.0, 400.0), "the walls")
    assert "Choose a world" in fix
    assert not list(barely_overlap(Axis("x", 0, 210, 211), (-100.0, 100.0), "the walls", "cm"))
