"""Gain adaptation against its closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.arithmetic import Gain
from deodar.couplings.learning import GainAdaptation
from deodar.elements.stimuli import Boost, Pattern
from deodar.errors import ModelError


def model(n=40, error=0.3, gate=None, **others):
    x = dd.Axis("x", 0, 40, n, periodic=True)
    m = dd.Model("gains", dt=0.5)
    g = m.add(GainAdaptation(tau=50.0, gated=gate is not None, name="g", **others))
    m.connect(m.add(Pattern("f", [x], np.exp(-((x.points - 17) ** 2) / 18))), g["input"])
    if error is not None:
        m.connect(m.add(Boost("error", [], error)), g["error"])
    if gate is not None:
        m.connect(m.add(Boost("gate", [], 1.0, windows=gate)), g["gate"])
    return m


def end(m, duration, port):
    return dd.simulate(m, duration, record=[port], precision="float64", every=duration)[port].values[-1]


def test_gains_grow_with_the_error_where_the_peak_is():
    f = np.exp(-((np.arange(40.0) - 17) ** 2) / 18)
    np.testing.assert_allclose(end(model(initial=0.2), 30, "g.gains"), 0.2 + 30 / 50 * 0.3 * f, atol=1e-12)
    np.testing.assert_allclose(end(model(error=-0.3), 30, "g.gains"), -30 / 50 * 0.3 * f, atol=1e-12)
    assert end(model(initial=0.2), 30, "g.output") == pytest.approx(np.sum(f * (0.2 + 0.18 * f)), abs=1e-12)


def test_an_initial_error_decays_by_the_closed_form_at_any_sampling():
    target, gains = 5.0, []
    for n in (40, 80):
        m = model(n, error=None)
        m.connect(m.add(Boost("wanted", [], target)), "g.error")
        m["g"]["value"] >> m.add(Gain(-1.0, name="reached"))
        m.connect("reached", "g.error")
        error = target - dd.simulate(m, 100, record=["g.value"], precision="float64")["g.value"].values
        f = np.exp(-((np.arange(0, 40, 40 / n) - 17) ** 2) / 18)
        share = 0.5 / 50 * np.sum(f**2) / np.sum(f)
        np.testing.assert_allclose(error, target * (1 - share) ** np.arange(201), atol=1e-9)
        gains.append(error)
    np.testing.assert_allclose(*gains, atol=1e-6)
    assert abs(error[-1]) < target / 2


def test_gains_outside_of_the_window_keep_their_bits():
    start = np.random.default_rng(3).standard_normal(40)
    assert np.array_equal(end(model(start=start, gate=[(1000, 1001)]), 50, "g.gains"), start)
    assert not np.array_equal(end(model(start=start, gate=[(10, 11)]), 50, "g.gains"), start)


def test_the_value_without_input_is_zero():
    m = model()
    m.set("f.amplitude", 0.0)
    assert end(m, 1, "g.value") == 0


def test_gains_of_another_shape_are_refused():
    with pytest.raises(ModelError, match=r"start has shape \[3\], the input has \[40\] samples"):
        dd.Session(model(start=np.zeros(3)))
