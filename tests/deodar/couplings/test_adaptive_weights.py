"""Adaptive weights against a plain loop of their rule."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.learning import AdaptiveWeights
from deodar.elements.stimuli import Boost, Pattern

X, Z = dd.Axis("x", 0, 6, 4), dd.Axis("z", 0, 1, 3)
PRE, POST, OTHER = np.array([0.0, 1.0, 0.5, 0.0]), np.array([1.0, -0.5, 0.25]), np.array([1.0, 0.0, 0.0, 0.2])


def learned(gated=False, apart=False, dt=0.5):
    model = dd.Model("learning", dt=dt)
    out = model.add(AdaptiveWeights([Z], rate=0.1, initial=0.2, gated=gated, apart=apart, name="w"))
    model.connect(model.add(Pattern("pre", [X], PRE)), out["input"])
    model.connect(model.add(Pattern("post", [Z], POST)), out["post"])
    if gated:
        model.connect(model.add(Boost("gate", (), 1.0, windows=[(2, 3)])), out["gate"])
    if apart:
        model.connect(model.add(Pattern("other", [X], OTHER)), out["pre"])
    return dd.simulate(model, 5, record=["w.output"], precision="float64")["w.output"].values


@pytest.mark.parametrize(("gated", "apart"), [(False, False), (True, False), (False, True), (True, True)])
def test_weights_follow_the_learning_rule(gated, apart):
    w, out = np.full((4, 3), 0.2), []
    for step in range(11):
        out.append(X.step * PRE @ w)
        gate = 1.0 if not gated or 2 <= step * 0.5 < 3 else 0.0
        w = w + 0.5 * 0.1 * gate * (POST - w) * (OTHER if apart else PRE)[:, None]
    assert np.allclose(learned(gated, apart), out, rtol=0, atol=1e-14)


def test_a_negative_gate_counts_as_zero():
    model = dd.Model("learning")
    out = model.add(AdaptiveWeights([Z], rate=0.1, initial=0.2, gated=True, name="w"))
    model.connect(model.add(Pattern("pre", [X], PRE)), out["input"])
    model.connect(model.add(Pattern("post", [Z], POST)), out["post"])
    model.connect(model.add(Boost("gate", (), -1.0)), out["gate"])
    y = dd.simulate(model, 5, record=["w.output"], precision="float64")["w.output"].values
    assert np.allclose(y, X.step * PRE.sum() * 0.2, rtol=0, atol=1e-14)


@pytest.mark.parametrize(("source", "shape"), [([X], (3, 4)), ([], (3,))])
def test_the_port_weights_shows_them_target_samples_first(source, shape):
    model = dd.Model("learning", dt=0.5)
    out = model.add(AdaptiveWeights([Z], rate=0.1, initial=0.2, name="w"))
    model.connect(model.add(Pattern("pre", source, PRE) if source else Boost("pre", ())), out["input"])
    model.connect(model.add(Pattern("post", [Z], POST)), out["post"])
    session = dd.Session(model, precision="float64")
    session.run(5)
    weights = session.read("w.weights")
    session.keep()
    assert weights.shape == shape
    assert np.array_equal(weights, np.moveaxis(model.get("w.start").data, -1, 0))
    assert abs(weights - 0.2).max() > 0.1
