"""The memory trace against its equation."""

from __future__ import annotations

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.element import Setting, Time
from deodar.elements.memories import MemoryTrace
from deodar.elements.stimuli import Boost, Pattern
from deodar.errors import ModelError, ParameterError

X = dd.Axis("x", 0, 30, 31)


def test_a_trace_grows_at_peaks_decays_elsewhere_and_is_constant_without_peaks():
    model = dd.Model("trace")
    for name, center, on in (("a", 8, (0, 20)), ("b", 22, (30, 60))):
        model.add(dd.GaussianStimulus(name, [X], center=center, sigma=2, amplitude=2, windows=[on]))
    p = model.add(MemoryTrace("p", [X], tau_build=10, tau_decay=50, threshold=0.5))
    model["a"] >> p
    model["b"] >> p
    record = dd.simulate(model, 80, dt=0.5, record=["p.output", "p.active", "p.input"], precision="float64")
    output, active, s = (record[name].values for name in ("p.output", "p.active", "p.input"))
    expected = np.zeros(31)
    for k in range(len(output)):
        assert np.allclose(output[k], expected, rtol=0, atol=1e-13)
        if (s[k] > 0.5).any():
            expected = expected + 0.5 * np.where(s[k] > 0.5, (s[k] - expected) / 10, -expected / 50)
    assert np.array_equal(active[1:], s[:-1] > 0.5)
    assert np.array_equal(output[40], output[60]) and output[40].max() > 1  # nothing is active from 20 to 30
    assert output[-1, 8] < output[40, 8]


# ----------------------------------------------------------------------- closed forms, and what can be chosen


def course(f, steps, dt=0.5, gate=None, others=None, **parameters):
    """Return the trace of one constant input (at two positions if `others` is given) after a number of
    steps.
    """
    axis = dd.Axis("x", 0, 1, 2)
    model = dd.Model("trace", dt=dt)
    p = model.add(MemoryTrace("p", [axis], tau_build=10, tau_decay=50, gated=gate is not None, **parameters))
    model.connect(model.add(Pattern("f", [axis], [f, f if others is None else others])), p["input"])
    if gate is not None:
        model.connect(model.add(Boost("gate", [], 1.0, windows=gate)), p["gate"])
    return dd.simulate(model, steps * dt, record=["p.output"], precision="float64", every=steps * dt)[
        "p.output"
    ].values[-1]


def test_growth_and_decay_follow_their_closed_form():
    n = np.arange(0, 400, 57)[1:]
    for steps in n:
        built, decayed = course(0.9, steps, others=0.1, start=[0.0, 0.7])
        assert built == pytest.approx(0.9 * (1 - (1 - 0.5 / 10) ** steps), abs=1e-12)
        assert decayed == pytest.approx(0.7 * (1 - 0.5 / 50) ** steps, abs=1e-12)


@pytest.mark.parametrize("f", [0.55, 0.8, 1.0])
def test_the_graded_form_is_equation_11(f):
    speed = f / 10 + (1 - f) / 50
    fixed = f * f / 10 / speed
    for steps in (1, 30, 400):
        assert course(f, steps, graded=True)[0] == pytest.approx(
            fixed * (1 - (1 - 0.5 * speed) ** steps), abs=1e-12
        )
    assert course(f, 4000, graded=True)[0] == pytest.approx(fixed, abs=1e-9)


def test_a_trace_without_a_peak_is_constant_unless_it_fades():
    assert np.array_equal(course(0.3, 100, start=[0.7, 0.2]), [0.7, 0.2])
    np.testing.assert_allclose(
        course(0.3, 100, start=[0.7, 0.2], fades=True), np.array([0.7, 0.2]) * 0.99**100, atol=1e-12
    )
    faded = course(0.0, 100, start=[0.7, 0.2], fades=True, graded=True)
    np.testing.assert_allclose(faded, np.array([0.7, 0.2]) * 0.99**100, atol=1e-12)
    assert np.array_equal(course(0.3, 100, start=[0.7, 0.2], graded=True), [0.7, 0.2])


def test_a_trace_with_a_closed_gate_keeps_its_bits():
    start = np.random.default_rng(1).random(2)
    assert np.array_equal(course(0.9, 100, gate=[(1000, 1001)], start=start, fades=True), start)
    assert course(0.9, 100, gate=[(10, 20)])[0] == pytest.approx(0.9 * (1 - 0.95**20), abs=1e-12)


def test_a_trace_of_another_shape_is_refused():
    model = dd.Model("trace")
    model.add(MemoryTrace("p", [X], start=np.zeros(30)))
    with pytest.raises(ModelError, match=r"start has shape \[30\], its axes have \[31\] samples"):
        dd.Session(model)


def test_a_sigmoid_in_place_of_the_threshold_weights_growth_and_decay():
    expected = np.array([0.0, 0.7])
    a = 1 / (1 + np.exp(-4 * (np.array([0.9, 0.2]) - 0.5)))
    for _ in range(50):
        expected = expected + 0.5 * (a * ([0.9, 0.2] - expected) / 10 - (1 - a) * expected / 50)
    output = course(0.9, 50, others=0.2, start=[0.0, 0.7], activity=dd.Logistic(4.0, 0.5))
    np.testing.assert_allclose(output, expected, rtol=0, atol=1e-12)
    with pytest.raises(ParameterError, match="activity: is a sigmoid, and graded takes the input itself"):
        course(0.9, 1, graded=True, activity=dd.Logistic(4.0, 0.5))


@pytest.mark.parametrize("fades", [False, True])
@pytest.mark.parametrize(("graded", "activity"), [(False, None), (True, None), (False, dd.Logistic(4))])
def test_a_trace_says_whether_its_rate_jumps_at_the_threshold(graded, activity, fades):
    trace = MemoryTrace("p", [], threshold=0.5, graded=graded, fades=fades, activity=activity)
    time = Time.at(0.0, 1.0, np.dtype("float64"))
    start = {"trace": np.float64(0.7), "active": np.float64(0.0)}

    def rate(x):
        inputs = {"input": np.float64(x), "gate": np.float64(1.0)}
        at = Setting({"input": (), "gate": ()}, {"output": ()}, np.dtype("float64"), start, inputs, time=time)
        return float(trace.advance(at)["trace"])

    with jax.enable_x64(True):
        jump = abs(rate(0.5 + 1e-9) - rate(0.5 - 1e-9))
    assert ("input" in trace.jumps_at()) == (jump > 1e-6)
