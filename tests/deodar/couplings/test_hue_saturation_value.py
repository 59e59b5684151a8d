"""Hue, saturation and value against Python's own conversion."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.pictures import HueSaturationValue
from deodar.elements.stimuli import Pattern
from deodar.errors import ModelError

X, Y, CHANNEL = dd.Axis("x", 0, 6, 7), dd.Axis("y", 0, 4, 5), dd.Axis("channel", 0, 2, 3)


def converted(picture, axes):
    model = dd.Model("colours", dt=1)
    model.add(Pattern("picture", axes, picture)) >> model.add(HueSaturationValue(name="hsv"))
    return dd.simulate(model, 1, record=["hsv.output"], precision="float64")["hsv.output"].values[0]


def test_each_pixel_agrees_with_colorsys():
    picture = np.random.default_rng(4).random((7, 5, 3))
    picture[0, 0] = 0.4  # grey
    picture[0, 1] = 0.0  # black
    output = converted(picture, [X, Y, CHANNEL])
    for place in np.ndindex(7, 5):
        hue, saturation, value = colorsys.rgb_to_hsv(*picture[place])
        np.testing.assert_allclose(output[place], [360 * hue, saturation, value], rtol=0, atol=1e-10)


def test_other_axes_are_refused():
    with pytest.raises(
        ModelError, match="needs a picture: two dimensions, and a last axis with the channels"
    ):
        converted(np.zeros((7, 5)), [X, Y])
