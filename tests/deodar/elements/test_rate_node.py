"""The node that shows its rate of change."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.elements.populations import RateNode
from deodar.elements.stimuli import Boost


def test_a_step_follows_the_rate():
    model = dd.Model("rate", dt=0.5)
    n = model.add(RateNode("n", tau=8, resting_level=-2, self_excitation=3, sigmoid=dd.Logistic(2.0)))
    model.connect(model.add(Boost("b", (), 1.5, windows=[(3, 9)])), n)
    record = dd.simulate(model, 20, record=["n.activation", "n.rate", "n.output"], precision="float64")
    u, r, g = (record[f"n.{port}"].values for port in ("activation", "rate", "output"))
    assert np.allclose(np.diff(u), 0.5 * r[:-1], rtol=0, atol=1e-14)
    s = np.where((record.time >= 3) & (record.time < 9), 1.5, 0.0)
    assert np.allclose(r[1:], (-u[1:] - 2 + 3 * g[1:] + s[:-1]) / 8, rtol=0, atol=1e-14)
    assert np.isclose(r[0], 3 / (1 + np.exp(4)) / 8) and np.ptp(u) > 0.5


def test_its_noise_is_not_divided_by_tau():
    model = dd.Model("noise", dt=0.25)
    model.add(RateNode("n", tau=1e6, resting_level=0, noise=2.0))
    steps = np.diff(dd.simulate(model, 1000, record=["n.activation"], precision="float64")["n.activation"])
    assert abs(steps.std() / (2.0 * 0.5) - 1) < 0.05
