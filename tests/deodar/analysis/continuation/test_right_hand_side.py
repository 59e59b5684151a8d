"""The right-hand side as a pure function: its values, derivatives and states."""

from __future__ import annotations

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.errors import AnalysisError, ParameterError, UnknownName
from tests.deodar.analysis.continuation.models import line, node


def test_it_is_the_equation_of_the_field():
    d = dd.right_hand_side(node(), ["s.amplitude", "u.resting_level"])
    for u, s, h in ((-1.0, 2.0, -5.0), (0.3, 4.0, -6.0)):
        expected = -u + h + s + 6.0 / (1 + np.exp(-4.0 * u))
        assert d.rates(np.array([u]), np.array([s, h])) == pytest.approx(expected, abs=1e-12)
    assert d.values.tolist() == [0.0, -5.0] and d.start.tolist() == [-5.0]
    assert d.time_constants.tolist() == [20.0]


def test_it_does_not_depend_on_the_step_or_the_noise():
    x = np.linspace(-3, 3, 101)
    found = []
    for dt, noise in ((1.0, 0.0), (0.25, 1.0)):
        model = line()
        model.set("u.noise", noise)
        model.dt = dt
        d = dd.right_hand_side(model, ["s.amplitude"])
        found.append(d.rates(x, np.array([3.0])))
    np.testing.assert_allclose(*found, atol=1e-11)


def test_its_derivatives_are_those_of_central_differences():
    d = dd.right_hand_side(line(31), ["s.amplitude", "u.kernel.0.sigma", "u.global_inhibition"])
    rng = np.random.default_rng(1)
    x, p = rng.normal(0, 1, d.size), d.values + np.array([2.0, 0, 0])
    _, by_state, by_parameter = d.linear(x, p)
    dx, dp, h = rng.normal(0, 1, d.size), rng.normal(0, 1, 3), 1e-5
    along = (d.rates(x + h * dx, p + h * dp) - d.rates(x - h * dx, p - h * dp)) / (2 * h)
    np.testing.assert_allclose(by_state @ dx + by_parameter @ dp, along, atol=1e-6)
    np.testing.assert_allclose(d.along(x, p, dx, dp), along, atol=1e-6)
    np.testing.assert_allclose(d.back(x, p, dx), dx @ by_state, atol=1e-9)
    np.testing.assert_allclose(d.gradient(x, p, dx), dx @ by_parameter, atol=1e-9)


def test_other_libraries_may_transform_its_function():
    d = dd.right_hand_side(node(), ["s.amplitude"])
    with jax.enable_x64(True):
        slope = jax.grad(lambda s: d.function(np.array([0.0]), np.array([1.0]) * s)[0])(2.0)
    assert float(slope) == 1.0


def test_a_state_has_names_and_comes_back_from_them():
    model = line(31)
    model.add(dd.Field("v", tau=50))
    d = dd.right_hand_side(model)
    state = d.state(d.start)
    assert {name: a.shape for name, a in state.items()} == {"u.activation": (31,), "v.activation": ()}
    np.testing.assert_array_equal(d.vector(state), d.start)
    assert sorted(set(d.time_constants)) == [20.0, 50.0]
    np.testing.assert_allclose(d.read("u.input", d.start, d.values), np.zeros(31))


def test_even_states_settle_where_all_states_do():
    whole = dd.right_hand_side(line(), ["s.amplitude"])
    even = dd.right_hand_side(line(), ["s.amplitude"], even=["x"])
    assert even.size == 51
    p = np.array([6.0])
    np.testing.assert_allclose(
        even.full(even.settle(even.start, p, 100)), whole.settle(whole.start, p, 100), atol=1e-9
    )


def test_time_stands_at_one_moment():
    model = line(31)
    model.set("s.amplitude", 3.0)
    model.set("s.windows", [(100.0, 200.0)])
    inside, outside = (dd.right_hand_side(model, at=at) for at in (150.0, 250.0))
    assert inside.read("u.input", inside.start, inside.values).max() == pytest.approx(3.0)
    assert outside.read("u.input", outside.start, outside.values).max() == 0.0


def test_what_has_no_steady_state_is_refused_by_name_or_held():
    model = line(31)
    x = dd.Axis("x", 0, 100, 31)
    trace = model.add(dd.MemoryTrace("trace", [x]))
    model["u"] >> trace
    with pytest.raises(AnalysisError, match=r"trace: learns \(MemoryTrace\).*hold=\['trace'\]"):
        dd.right_hand_side(model)
    without_trace = dd.right_hand_side(model, hold=["trace"])
    assert list(without_trace.state(without_trace.start)) == ["u.activation"]
    model.add(dd.Sensor("eye", [x], sensor="picture"))
    with pytest.raises(AnalysisError, match="eye: reads a world"):
        dd.right_hand_side(model, hold=["trace"])


def test_wrong_names_are_answered_with_the_nearest():
    with pytest.raises(UnknownName, match=r"Did you mean 'amplitude'"):
        dd.right_hand_side(line(31), ["s.amplitud"])
    with pytest.raises(ParameterError, match="makes another program"):
        dd.right_hand_side(line(31), ["u.quadrature"])
    with pytest.raises(AnalysisError, match="no state has an axis 'y'"):
        dd.right_hand_side(line(31), even=["y"])


def test_the_strength_of_noise_is_no_parameter():
    model = line(31)
    model.set("u.noise", 1.0)
    with pytest.raises(ParameterError, match="strength of noise"):
        dd.right_hand_side(model, ["s.amplitude", "u.noise"])
    model.parameter("both", 1.0)
    model.link("u.noise", "both")
    model.link("s.amplitude", "both")
    assert dd.right_hand_side(model, ["both"]).values.tolist() == [1.0]


def test_a_source_of_noise_is_off() -> None:
    model = line(31)
    model.add(dd.Noise("n", list(model["u"].axes), amplitude=2.0)) >> model["u"]
    d, without = dd.right_hand_side(model), dd.right_hand_side(line(31))
    assert np.array_equal(d.rates(d.start, d.values), without.rates(d.start, d.values))
    with pytest.raises(ParameterError, match="strength of noise"):
        dd.right_hand_side(model, ["n.amplitude"])
