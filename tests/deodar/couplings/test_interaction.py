"""The interaction coupling equals the interaction of a field."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.couplings.convolutions import Interaction

X, PHI = dd.Axis("x", 0, 30, 11), dd.Axis("phi", 0, 360, 8, periodic=True)
KERNELS = [dd.Gaussian(0.01, [4.0, 60.0]), dd.Gaussian(-0.004, [8.0, 90.0])]


def test_the_coupling_gives_the_interaction_of_a_field():
    model = dd.Model("both")
    stimulus = model.add(dd.GaussianStimulus("s", [X, PHI], center=[11, 350], sigma=[5, 70], amplitude=7))
    u = model.add(dd.Field("u", [X, PHI], kernel=KERNELS, global_inhibition=0.001))
    stimulus >> u
    u >> Interaction(KERNELS, 0.001, name="same")
    record = dd.simulate(model, 60, every=20, record=["u.interaction", "same.output"], precision="float64")
    assert abs(record["u.interaction"]).max() > 0.1
    assert np.allclose(record["u.interaction"], record["same.output"], rtol=0, atol=1e-12)


def test_interaction_of_a_node_is_a_gain():
    model = dd.Model("node")
    n = model.add(dd.Field("n", [], resting_level=2.0))
    n >> Interaction([dd.Gaussian(1.5), dd.Gaussian(-0.25)], 0.25, name="k")
    record = dd.simulate(model, 1, every=1, record=["n.output", "k.output"], precision="float64")
    assert np.allclose(record["k.output"], record["n.output"])


def test_the_total_is_the_integral_of_the_input():
    model = dd.Model("total")
    u = model.add(dd.Field("u", [X, PHI], resting_level=0.5))
    u >> Interaction(KERNELS, 0.0, name="k")
    record = dd.simulate(model, 1, every=1, record=["u.output", "k.total"], precision="float64")
    assert record["k.total"].dims == ("time",)
    assert np.allclose(
        record["k.total"], record["u.output"].sum(("x", "phi")) * X.step * PHI.step, rtol=1e-12
    )
