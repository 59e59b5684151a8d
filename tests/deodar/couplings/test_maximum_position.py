"""The position of the largest sample."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.positions import MaximumPosition
from deodar.elements.stimuli import Boost, Pattern
from deodar.errors import ModelError


def position(values, axes, **parameters):
    model = dd.Model("maximum", dt=1)
    stimulus = Pattern("s", axes, values) if axes else Boost("s", (), values)
    model.add(stimulus) >> model.add(MaximumPosition(name="y", **parameters))
    return dd.simulate(model, 1, record=["y.output"], precision="float64")["y.output"].values[0]


def test_the_place_is_in_axis_units_and_the_first_of_equal_ones():
    axis = dd.Axis("x", -1, 1, 5)
    assert position([0.0, 0.3, 0.9, 0.9, 0.1], [axis]) == 0.0
    assert position([0.0, 0.3, 0.2, 0.1, 0.1], [axis]) == -0.5


def test_several_axes_give_one_number_each():
    values = np.zeros((4, 6))
    values[2, 5] = 3.0
    assert position(values, [dd.Axis("x", 0, 3, 4), dd.Axis("y", 10, 20, 6)]).tolist() == [2.0, 20.0]


def test_nothing_above_the_least_value_is_absent():
    axis = dd.Axis("x", 0, 4, 5)
    assert position([0.0, 0.3, 0.2, 0.1, 0.1], [axis], least=0.5, absent=-7.0) == -7.0


def test_one_number_has_no_position():
    with pytest.raises(ModelError, match="needs an input with an axis, not one number"):
        position(1.0, [])
