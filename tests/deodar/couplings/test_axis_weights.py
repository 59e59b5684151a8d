"""Weights along one axis against products of matrices."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.weights import AxisWeights
from deodar.elements.stimuli import Pattern
from deodar.errors import ModelError

X, Y, Z = dd.Axis("x", 0, 4, 5), dd.Axis("y", 0, 2, 3), dd.Axis("z", 0, 6, 7)


def through(coupling, axes, values):
    model = dd.Model("weights", dt=1)
    model.add(Pattern("s", axes, values)) >> model.add(coupling)
    record = dd.simulate(model, 1, record=[f"{coupling.name}.output"], precision="float64")
    return record[f"{coupling.name}.output"]


def test_one_axis_of_three_takes_another_place_and_length():
    random = np.random.default_rng(0)
    values, weights = random.random((5, 3, 7)), random.random((4, 3))
    axis = dd.Axis("fine", 0, 1, 4)
    output = through(AxisWeights(weights, axis, along="y", name="w"), [X, Y, Z], values)
    assert output.dims == ("time", "x", "fine", "z")
    np.testing.assert_allclose(
        output.values[0], np.einsum("fy,xyz->xfz", weights, values), rtol=0, atol=1e-12
    )


def test_the_axis_of_the_same_name_is_the_default():
    values, weights = np.arange(5.0), np.eye(5)[::-1]
    output = through(AxisWeights(weights, X, name="w"), [X], values)
    assert output.values[0].tolist() == [4, 3, 2, 1, 0]


@pytest.mark.parametrize(
    ("coupling", "why"),
    [
        (AxisWeights(np.eye(5), X, along="q", name="w"), "acts along the axis 'q', which the input does not"),
        (AxisWeights(np.ones((3, 5)), Y, along="x", name="w"), "gives an axis 'y', which the input has"),
        (AxisWeights(np.eye(4), X, name="w"), r"weights has shape \[4, 4\]"),
    ],
)
def test_what_does_not_fit_is_named(coupling, why):
    with pytest.raises(ModelError, match=why):
        through(coupling, [X, Y], np.zeros((5, 3)))
