"""Axes: samples, steps and errors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deodar.errors import AxesError
from deodar.numerics.axes import Axis, cell, describe, shape


def test_an_axis_that_is_not_periodic_has_samples_at_both_ends():
    axis = Axis("x", -10, 30, 41)
    assert axis.step == 1 and axis.points[0] == -10 and axis.points[-1] == 30 and len(axis.points) == 41


def test_the_samples_of_a_periodic_axis_exclude_its_upper_bound():
    axis = Axis("phi", -180, 180, 36, periodic=True)
    assert axis.step == 10 and axis.points[0] == -180 and axis.points[-1] == 170
    assert Axis("one", 0, 5, 1, periodic=True).step == 5


def test_points_of_a_long_axis_are_exact():
    axis = Axis("x", 0.1, 0.7, 100_001)
    assert abs(axis.points[-1] - 0.7) < 1e-15
    assert np.all(np.diff(axis.points) > 0)


def test_shape_cell_and_description_of_axes_are_correct():
    axes = (Axis("x", 0, 4, 3, unit="mm"), Axis("phi", 0, 360, 8, periodic=True))
    assert shape(axes) == (3, 8) and shape(()) == ()
    assert cell(axes) == 2 * 45 and cell(()) == 1
    assert describe(axes) == "[x 0..4 mm, 3 samples; phi 0..360, 8 samples, periodic]"


def test_axes_fit_if_bounds_unit_and_periodicity_are_equal():
    axis = Axis("x", 0, 100, 101, unit="deg")
    assert axis.fits(Axis("y", 0, 100 + 1e-8, 7, unit="deg"))  # connections compare names and samples
    assert not axis.fits(Axis("x", 0, 100 + 1e-6, 101, unit="deg"))
    assert not axis.fits(Axis("x", 0, 100, 101))
    assert not axis.fits(Axis("x", 0, 100, 101, periodic=True, unit="deg"))


REFUSED = {
    "upside down": dict(lower=1, upper=0),
    "empty": dict(lower=1, upper=1),
    "endless": dict(upper=math.inf),
    "not a number": dict(lower=math.nan),
    "text": dict(lower="0"),
    "truth": dict(upper=True),
    "no samples": dict(samples=0),
    "one sample": dict(samples=1),
    "half a sample": dict(samples=10.5),
    "far too many": dict(samples=10**9),
    "samples as text": dict(samples="10"),
    "no name": dict(name=""),
    "name that is a number": dict(name=3),
    "periodic by text": dict(periodic="yes"),
    "unit by number": dict(unit=1),
}


@pytest.mark.parametrize("case", REFUSED)
def test_invalid_axes_are_refused(case):
    arguments = dict(name="x", lower=0, upper=10, samples=11) | REFUSED[case]
    with pytest.raises(AxesError):
        Axis(**arguments)


def test_all_problems_of_an_axis_are_listed():
    with pytest.raises(AxesError) as caught:
        Axis("x", 5, 1, samples=0, unit=3)  # type: ignore[arg-type]
    assert len(caught.value.problems) == 3
