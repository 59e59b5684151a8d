"""The integrator against plain sums."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.variables import Integrator

X = dd.Axis("x", 0, 3, 4)


@pytest.mark.parametrize("rate", [0.1, -2.0])
@pytest.mark.parametrize("start", [None, [0.0, 1.0, -1.0, 0.5]])
def test_the_integrator_sums_its_input(rate, start):
    model = dd.Model("sum", dt=0.5)
    u = model.add(dd.Field("u", [X], tau=10, resting_level=1))
    model.connect(model.add(dd.GaussianStimulus("s", [X], center=1, sigma=1, amplitude=3)), u)
    model.connect(u, model.add(Integrator("x", [X], rate, 0.25, start)))
    record = dd.simulate(model, 5, record=["u.output", "x.output"], precision="float64")
    x = np.full(4, 0.25) if start is None else np.array(start)
    for k in range(11):
        assert np.allclose(record["x.output"].values[k], x, rtol=0, atol=1e-12)
        x = x + 0.5 * rate * record["u.output"].values[k]


def test_the_value_is_constant_without_input():
    model = dd.Model("alone")
    model.add(Integrator("x", [], 3.0, 1.5))
    assert (dd.simulate(model, 5, record=["x.output"])["x.output"] == 1.5).all()


def test_an_injected_input_adds_to_the_input():
    model = dd.Model("pushed")
    model.add(Integrator("x", [], 0.2))
    s = dd.Session(model, dt=1.0)
    s.inject("x", 2.0, 5)
    s.step(5)
    assert s.read("x.output") == pytest.approx(2.0)


def test_a_start_of_another_shape_is_a_problem():
    model = dd.Model("start")
    model.add(Integrator("x", [X], start=[1.0, 2.0]))
    assert any("start has shape [2]" in p.what for p in model.check())
