"""Placeholders."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.elements.placeholder import Placeholder
from deodar.model.check import problems

X = dd.Axis("x", 0, 3, 4)


def test_a_placeholder_in_a_loop_outputs_zero():
    model = dd.Model("placeholder")
    u = model.add(dd.Field("u", [X], resting_level=2.0))
    p = model.add(Placeholder("p", [X], "Camera: reads a camera"))
    u >> p >> u
    assert not problems(model.document)
    record = dd.simulate(model, 5, record=["p.output", "u.activation"])
    assert not np.any(record["p.output"]) and np.allclose(record["u.activation"], 2.0)
