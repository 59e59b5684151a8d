"""Changes that a session accepts, or refuses without an effect."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.function import Function
from deodar.elements.stimuli import Boost
from deodar.elements.variables import Attractor
from deodar.elements.world_ports import Sensor
from deodar.model.check import problems

x = dd.Axis("x", 0, 20, samples=21)


def two(**parameters: object) -> dd.Model:
    model = dd.Model("two")
    model.add(dd.Field("u", [x], **({"tau": 10.0} | parameters)))  # type: ignore[arg-type]
    model.add(dd.Field("v", [x], tau=10, resting_level=-2))
    model.add(dd.GaussianStimulus("s", [x], center=10, amplitude=4)) >> model["u"]
    return model


def test_a_snapshot_is_restored_after_changes_of_noise_and_structure() -> None:
    model = two()
    reference = dd.Session(model, seed=2, precision="float64")
    reference.step(20)
    s = dd.Session(model, seed=2, precision="float64")
    s.step(5)
    snapshot = s.snapshot()
    for path, value in (
        ("u.noise", 0.3),
        ("v.kernel", [dd.Gaussian(1, 3)]),
        ("u.noise_length", 2.0),
        ("s.windows", [(0, 7)]),
    ):
        s.set(path, value)
        s.step(3)
    s.restore(snapshot)
    assert s.tick == 5 and s.get("u.noise") == 0
    s.step(15)
    assert np.abs(s.read("u.activation") - reference.read("u.activation")).max() < 1e-10


def test_a_snapshot_of_a_program_with_noise_set_to_zero_is_restored() -> None:
    s = dd.Session(two(noise=0.1))
    s.step(3)
    s.set("u.noise", 0.0)
    snapshot = s.snapshot()
    s.set("u.kernel", [dd.Gaussian(1, 2)])
    s.restore(snapshot)
    s.step(2)
    assert s.tick == 5


@pytest.mark.parametrize("wrong", [None, 3, {}])
def test_a_value_that_is_not_a_snapshot_is_refused(wrong: object) -> None:
    s = dd.Session(two())
    with pytest.raises(dd.errors.ParameterError, match="expected a snapshot"):
        s.restore(wrong)  # type: ignore[arg-type]


def test_snapshots_of_another_model_or_precision_are_refused() -> None:
    s = dd.Session(two())
    model = dd.Model("other")
    model.add(dd.Field("z", []))
    with pytest.raises(dd.errors.ParameterError, match="another model"):
        s.restore(dd.Session(model).snapshot())
    with pytest.raises(dd.errors.ParameterError, match="float64"):
        s.restore(dd.Session(two(), precision="float64").snapshot())
    s.step(2)


def test_setting_a_value_to_off_recompiles() -> None:
    s = dd.Session(two(noise=0.2))
    assert s.set("u.noise_length", 3.0) == "recompile" and s.set("u.noise_length", 4.0) == "rebuild"
    assert s.set("u.noise_length", 0.0) == "recompile"
    s.step(5)
    model = two()
    model.add(Attractor("phi", x, tau=50.0, initial=0.0))
    model["u"] >> model["phi"]
    model.set("s.amplitude", 9)
    free = dd.Session(model)
    free.set("phi.fastest", 0.001)
    free.step(50)
    slow = float(free.read("phi.output"))
    free.set("phi.fastest", 0.0)
    free.step(400)
    assert slow < 0.1 and float(free.read("phi.output")) == pytest.approx(10, abs=0.2)
    with pytest.raises(dd.errors.ParameterError, match="switches it off"):
        dd.simulate(two(), 5, sweep={"u.noise_length": [0, 5]})


def test_an_attractor_never_overshoots() -> None:
    model = two()
    # the integral of the input is far above 1, so that the step is longer than the relaxation time
    model.add(Attractor("phi", x, tau=1.0))
    model["s"] >> model["phi"]
    phi = dd.simulate(model, 20, record=["phi.output"])["phi.output"].values
    assert phi[0] == 0 and np.allclose(phi[1:], 10, atol=1e-3)


def test_another_function_of_the_same_name_is_another_program() -> None:
    def step(state, inputs, time):  # type: ignore[no-untyped-def]
        return state + 1.0

    step.__module__, step.__qualname__ = __name__, "step"
    globals()["step"] = step
    model = dd.Model("function")
    model.add(Function("f", [x], function=step))
    assert dd.simulate(model, 5, record=["f.output"])["f.output"].values[-1, 0] == 5

    def second(state, inputs, time):  # type: ignore[no-untyped-def]
        return state + 100.0

    second.__module__, second.__qualname__ = __name__, "step"
    globals()["step"] = second
    model.set("f.function", second)
    assert dd.simulate(model, 5, record=["f.output"])["f.output"].values[-1, 0] == 500


def test_a_refused_edit_changes_nothing() -> None:
    s = dd.Session(two())
    s.step(3)
    with_sensor = dd.Model(document=s.document)
    with_sensor.add(Sensor("eye", [x]))
    with pytest.raises(dd.errors.WorldError):
        s.edit(with_sensor.document)
    s.step(2)
    assert s.tick == 5 and "eye" not in [e.path for e in s.document.entries]


def test_a_duration_is_in_time_also_before_a_new_dt_takes_effect() -> None:
    model = two()
    model.set_ticks("v", 10)
    s = dd.Session(model, dt=0.5)
    s.step(5)
    s.dt = 1.0
    s.run(100.5)  # 5 steps of 0.5 up to the common tick, then steps of 1
    assert s.time == pytest.approx(103.0) and s.dt == 1.0
    s.step(5)
    s.dt = 0.5
    for wrong in (-1, "a", float("nan"), float("inf"), 1.1):
        with pytest.raises(dd.errors.TimeError):
            s.run(wrong)  # type: ignore[arg-type]
    with pytest.raises(dd.errors.TimeError, match="time constant"):
        s.set("u.tau", 0.6)


def test_time_constants_of_a_restored_snapshot_are_compared_with_its_step() -> None:
    model = dd.Model("fast")
    model.add(dd.Field("u", [x], tau=20))
    s = dd.Session(model, dt=0.1)
    s.set("u.tau", 0.5)
    snapshot = s.snapshot()
    s.set("u.tau", 20)
    s.dt = 1
    s.restore(snapshot)
    assert s.dt == 0.1 and s.get("u.tau") == 0.5


def test_a_coupling_that_is_not_finite_is_named() -> None:
    model = dd.Model("inf")
    model.add(Boost("b", [x], amplitude=1e30)) >> dd.Gain(1e30, name="g")
    with pytest.raises(dd.errors.NotFinite, match=r"^g\.output became"):
        dd.simulate(model, 3, record=["g.output"])
    model.add(dd.Field("u", [x]))
    model.connect("g", "u")
    with pytest.raises(dd.errors.NotFinite, match=r"^g became"):
        dd.Session(model).step(3)
    model.rename("g", "renamed")
    with pytest.raises(dd.errors.NotFinite, match=r"^renamed became"):
        dd.Session(model).step(3)


def test_numbers_that_the_precision_cannot_hold_are_refused() -> None:
    s = dd.Session(two())
    with pytest.raises(
        dd.errors.ParameterError, match=r"s\.amplitude: is 1e\+300, beyond what float32.*float64"
    ):
        s.set("s.amplitude", 1e300)
    s.step(1)
    assert s.get("s.amplitude") == 4
    with pytest.raises(dd.errors.ParameterError, match="float32"):
        dd.simulate(two(resting_level=-1e39), 3)


def test_handles_are_accepted_as_paths() -> None:
    model = two()
    s = dd.Session(model)
    assert s.read(model["u"]["activation"]).shape == (21,) and s.read(model["u"]).shape == (21,)
    record = dd.simulate(model, 2, record=[model["u"]["activation"]])
    assert list(record.data_vars) == ["u.activation"]
    for wrong in (3, None, ["u"]):
        with pytest.raises(dd.errors.DeodarError):
            s.read(wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("order", [1, -1])
def test_a_chain_of_1500_couplings_runs_in_any_order_of_declaration(order: int) -> None:
    model = dd.Model("chain")
    gains = {k: model.add(dd.Gain(1.0, name=f"g{k}")) for k in list(range(1500))[::order]}
    model.add(Boost("b", [x], amplitude=2.0)) >> gains[0]
    for k in list(range(1499))[::order]:
        model.document  # noqa: B018
        gains[k] >> gains[k + 1]
    assert not problems(model.document)


@pytest.mark.parametrize("duration", [1e-9, 5e-7])
def test_a_duration_that_is_shorter_than_a_step_is_refused(duration: float) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", []))
    s = dd.Session(model, dt=1)
    for call in (lambda: s.run(duration), lambda: dd.simulate(model, duration)):
        with pytest.raises(dd.errors.TimeError, match=r"is shorter than a step of dt = 1. Use 1"):
            call()
    s.run(0)
    assert s.tick == 0 and dd.simulate(model, 0).sizes


def test_an_interval_that_is_longer_than_the_run_is_refused() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", []))
    message = r"every is 50, and the run lasts 20, so only its start would be recorded. Take at most every=20"
    with pytest.raises(dd.errors.TimeError, match=message):
        dd.simulate(model, 20, record=["u"], every=50)
    with pytest.raises(dd.errors.TimeError, match=message):
        dd.Trials(model, dd.TrialPlan(20, ["u"], every=50)).run()
    with pytest.raises(dd.errors.TimeError, match=message):
        dd.rollout(dd.dynamics(model), 20, record=["u"], every=50)
    assert dd.simulate(model, 20, record=["u"], every=20).sizes["time"] == 2
