"""Stimuli given as arrays."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.elements.stimuli import Pattern

X, Y = dd.Axis("x", 0, 3, 4), dd.Axis("y", 0, 1, 2)
VALUES = np.arange(8.0).reshape(4, 2)


def test_the_output_is_the_values_times_the_amplitude_in_the_windows():
    model = dd.Model("pattern")
    model.add(Pattern("s", [X, Y], VALUES, 0.5, windows=[(2, 4)]))
    output = dd.simulate(model, 5, record=["s.output"])["s.output"].values
    assert np.array_equal(output, [0.5 * VALUES * (2 <= t < 4) for t in range(6)])


def test_values_of_another_shape_are_reported():
    model = dd.Model("misfit")
    model.add(Pattern("s", [Y, X], VALUES))
    assert any("[4, 2]" in p.what and "[2, 4]" in p.what for p in model.check())
