"""The step as pure functions of parameters, state, inputs, tick and key."""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.compiler.dynamics import Dynamics
from deodar.errors import ParameterError, UnknownName, WorldError
from tests.deodar.gradients.models import X, field, mixed

RECORD = ["u.activation", "node.activation"]


def stepped(d: Dynamics, n: int, parameters: Any = None, inputs: Any = None, key: Any = None) -> Any:
    """Return the state after some steps, each by one program."""
    prepared, key = d.prepare(parameters), d.key() if key is None else key
    step = jax.jit(lambda state, tick: d.step(prepared, state, inputs or {}, tick, key))
    state = d.init(parameters, key)
    for tick in range(n):
        state = step(state, tick)
    return state


@pytest.mark.parametrize("precision", ["float64", "float32"])
def test_steps_are_those_of_simulate_with_noise_time_and_slow_parts(precision: str) -> None:
    model = mixed()
    d = dd.dynamics(model, precision=precision)
    record = dd.simulate(model, 12, seed=3, trials=[5], record=RECORD, precision=precision)
    with d.context():
        key = d.key(3, 5)
        state = stepped(d, 12, key=key)
        seen = d.observe(d.prepare(), state, {}, 12, key, RECORD)
    for path in RECORD:
        assert seen[path] == pytest.approx(
            record[path].values[0, -1], abs=1e-12 if precision == "float64" else 1e-5
        )
        assert seen[path].dtype == precision
        assert np.array_equal(seen[path], d.named(state)[path])


def test_parameters_are_numbers_document_parameters_and_arrays() -> None:
    model = mixed()
    model.parameter("h", -2.5)
    model.link("u.resting_level", "h")
    d = dd.dynamics(model, ["u.tau", "u.kernel.0.sigma", "u.noise", "h", "sum.weights", "gain.factor"])
    assert {name: array.shape for name, array in d.parameters.items()} == {
        **dict.fromkeys(["u.tau", "u.kernel.0.sigma", "u.noise", "h", "gain.factor"], ()),
        "sum.weights": (21,),
    }
    new = {
        "u.tau": 12.0,
        "h": -1.5,
        "u.noise": 0.8,
        "sum.weights": np.linspace(0, 0.3, 21),
        "gain.factor": 0.0,
    }
    for path, number in new.items():
        model.set(path, number)
    record = dd.simulate(model, 9, record=RECORD, precision="float64")
    with d.context():
        state = d.named(jax.jit(lambda p: stepped(d, 9, p))(new))
    for path in RECORD:
        assert state[path] == pytest.approx(record[path].values[-1], abs=1e-12)


def test_a_number_at_its_neutral_value_is_a_parameter() -> None:
    d = dd.dynamics(field(0.0), ["u.noise"])
    with d.context():
        rough, smooth = (d.named(stepped(d, 3, {"u.noise": q}))["u.activation"] for q in (1.0, 0.0))
    model = field(1.0)
    expected = dd.simulate(model, 3, record="u", precision="float64")["u.activation"].values[-1]
    assert rough == pytest.approx(expected, abs=1e-12)
    assert np.abs(rough - smooth).max() > 0.1 and d.parameters == {"u.noise": 0.0}


def test_transformations_of_jax_apply() -> None:
    d = dd.dynamics(field(0.5), ["u.tau", "s.amplitude"])

    def end(tau: Any, trial: Any) -> Any:
        return d.named(stepped(d, 6, {"u.tau": tau}, key=d.key(0, trial)))["u.activation"]

    with d.context():
        many = jax.jit(jax.vmap(end))(jnp.array([10.0, 15.0]), jnp.array([0, 7]))
        assert many[1] == pytest.approx(np.asarray(end(15.0, 7)), abs=1e-12)
        slope = jax.grad(lambda tau: end(tau, 0).sum())(10.0)
        ends = [float(end(10.0 + e, 0).sum()) for e in (1e-5, -1e-5)]
    assert slope == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-6)


def test_external_input_is_that_of_a_session() -> None:
    model, bump = mixed(), np.exp(-0.5 * ((X.points - 4) / 2) ** 2)
    session = dd.Session(model, precision="float64")
    session.run(2)
    session.inject("u", 3 * bump, 4)
    d = dd.dynamics(model)
    with d.context():
        prepared, key = d.prepare(), d.key()
        state = d.init(key=key)
        for tick in range(6):
            state = d.step(prepared, state, {"u": 3 * bump} if tick >= 2 else {}, tick, key)
    assert d.named(state)["u.activation"] == pytest.approx(session.read("u.activation"), abs=1e-12)
    with pytest.raises(ParameterError, match="no input from outside"), d.context():
        d.step(prepared, state, {"trace": 1.0}, 0, key)


def test_readings_of_sensors_are_inputs() -> None:
    model = dd.Model("sensor")
    model.add(dd.Sensor("eye", [X], sensor="eye")) >> model.add(dd.Field("u", [X]))
    d = dd.dynamics(model)
    with d.context():
        prepared, key = d.prepare(), d.key()
        state = d.init(key=key)
        seen = d.observe(prepared, state, {"eye": X.points}, 0, key, ["eye"])
        new = d.named(d.step(prepared, state, {"eye": X.points}, 0, key))
        blind = d.named(d.step(prepared, state, {}, 0, key))
    assert np.array_equal(seen["eye"], X.points)
    assert new["u.activation"] - blind["u.activation"] == pytest.approx(X.points / 20)


def test_states_are_replaced_by_path() -> None:
    d = dd.dynamics(mixed())
    with d.context():
        state = d.replaced(d.init(), {"u.activation": np.ones(21), "trace.trace": np.zeros(21)})
    assert d.named(state)["u.activation"].tolist() == [1.0] * 21
    with pytest.raises(UnknownName, match=r"u\.activation"):
        d.replaced(state, {"u.activatio": 0.0})


def test_what_cannot_be_is_refused() -> None:
    model = field()
    with pytest.raises(UnknownName, match="amplitude"):
        dd.dynamics(model, ["s.amplitud"])
    with pytest.raises(ParameterError, match="another program"):
        dd.dynamics(model, ["u.quadrature"])
    with pytest.raises(ParameterError, match="same number"):
        dd.dynamics(model, ["u.tau", "u.tau"])
    with pytest.raises(ParameterError, match="several numbers"):
        dd.dynamics(model, ["u.kernel.0"])
    d = dd.dynamics(model, ["u.tau"])
    with pytest.raises(ParameterError, match="single precision"):
        d.prepare()
    with d.context():
        with pytest.raises(UnknownName, match=r"dd\.dynamics"):
            dd.dynamics(model).prepare({"u.tau": 3.0})
        with pytest.raises(ParameterError, match="shape"):
            d.prepare({"u.tau": np.ones(3)})


def test_a_world_on_the_host_is_refused_and_says_what_to_do() -> None:
    model = dd.Model("sensor")
    axes = [dd.Axis(name, 0, n - 1, samples=n) for name, n in (("y", 4), ("x", 4), ("colour", 3))]
    model.add(dd.Sensor("eye", axes, sensor="picture")) >> model.add(dd.Field("u", axes))
    with pytest.raises(WorldError, match="inputs="):
        dd.dynamics(model, world=dd.Picture(np.zeros((4, 4, 3))))
