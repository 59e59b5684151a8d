"""The session: changes, steps, journal, snapshots, worlds, values that are not finite."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

import deodar as dd
from deodar.elements.function import Function
from deodar.elements.world_ports import Sensor
from deodar.errors import Untrusted
from deodar.numerics.axes import Axes
from deodar.numerics.sigmoids import Linear
from deodar.session.run import Run
from deodar.worlds._base import Signal, World
from deodar.worlds.picture import Picture

x = dd.Axis("x", 0, 20, samples=21)


def relaxing(every: int = 1, **parameters: float) -> dd.Model:
    model = dd.Model("relaxing")
    model.add(
        dd.Field("u", [x], **({"tau": 10.0, "resting_level": 1.0, "noise": 0.0} | parameters)), ticks=every
    )
    model.add(dd.GaussianStimulus("s", [x], center=10, sigma=3, amplitude=0)) >> model["u"]
    return model


def test_a_change_acts_from_the_next_step_and_is_recorded_in_the_journal() -> None:
    s = dd.Session(relaxing(), precision="float64")
    s.step(3)
    assert s.set("u.resting_level", 2) == "live"
    assert (s.read("u.activation") == 1).all()
    s.step(1)
    assert np.allclose(s.read("u.activation"), 1 + 0.1 * (2 - 1), atol=1e-12)
    assert s.set("u.kernel", [dd.Gaussian(0.5, 2)]) == "recompile"
    snapshot = s.snapshot()
    s.step(2)
    s.restore(snapshot)
    s.reset()
    assert [(c.tick, c.method, c.arguments[0]) for c in s.journal] == [
        (3, "set", "u.resting_level"),
        (4, "set", "u.kernel"),
        (6, "restore", snapshot),
        (4, "reset", 0),
    ]


def test_dt_changes_without_moving_time() -> None:
    s = dd.Session(relaxing(), dt=2)
    s.run(10)
    s.dt = 0.5
    assert s.time == 10
    s.run(3)
    assert s.time == 13 and s.tick == 11
    with pytest.raises(dd.errors.TimeError, match="multiple"):
        s.run(0.7)


def test_a_changed_dt_waits_for_the_tick_common_to_all_parts() -> None:
    model = relaxing(every=4)
    model.add(dd.Field("fast", [x]))
    s = dd.Session(model, dt=1)
    s.step(2)
    s.dt = 0.5
    assert s.dt == 1
    s.step(1)
    assert s.dt == 1
    s.step(3)
    assert s.dt == 0.5 and s.time == 4 + 2 * 0.5


def test_time_keeps_its_digits_over_a_day_in_float32() -> None:
    """A pulse of eight steps (the spacing of float32 numbers), a day after the start, is exact."""
    model = relaxing(tau=1.0, resting_level=0.0)
    model.describe(t0=86_399_990.0)
    model.set("s.amplitude", 1.0)
    model.set("s.windows", [(86_400_000.0, 86_400_008.0)])
    model.set("s.sigma", 1e6)
    record = dd.simulate(model, 20, record=["s.output"])["s.output"]
    assert record["time"].values[record.values[:, 0] > 0.5].tolist() == [86_400_000.0 + k for k in range(8)]


def test_windows_are_half_open_for_any_step_and_division_of_the_run() -> None:
    model = relaxing(tau=10.0)
    model.set("s.amplitude", 1.0)
    model.set("s.windows", [(0.3, 0.9), (1.2, 1.5)])
    whole = dd.simulate(model, 3, dt=0.1, record=["s.output"], precision="float64")["s.output"]
    on = np.round(whole["time"].values[whole.values[:, 10] > 0], 9).tolist()
    assert on == [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.2, 1.3, 1.4]
    s = dd.Session(model, dt=0.1, precision="float64")
    for k in range(30):
        assert (s.read("s.output")[10] > 0) == (whole.values[k, 10] > 0), k
        s.step()


def test_structural_changes_keep_states_by_id() -> None:
    model = relaxing()
    model.add(dd.Field("v", [x], tau=10, resting_level=-2))
    s = dd.Session(model)
    s.set("u.resting_level", 3)
    s.step(50)
    before = s.read("u.activation")
    edited = dd.Model(document=s.document)
    edited.rename("u", "renamed")
    edited.remove("v")
    edited.add(dd.Field("w", [x], resting_level=-7))
    s.edit(edited.document)
    assert (
        np.array_equal(s.read("renamed.activation"), before)
        and (s.read("w.activation") == -7).all()
        and s.tick == 50
    )


def test_documents_are_not_changed_by_a_session() -> None:
    model = relaxing()
    document = model.document
    s = dd.Session(model)
    s.set("u.tau", 30)
    model.set("u.tau", 50)
    assert s.get("u.tau") == 30 and model.get("u.tau") == 50
    model.undo()
    assert model.document is document


def test_a_value_that_is_not_finite_names_element_step_and_fix() -> None:
    model = dd.Model("explosive")
    u = model.add(dd.Field("fine", [x]))
    v = model.add(
        dd.Field("v", [x], tau=1, resting_level=1, sigmoid=Linear(3.0), kernel=[dd.Gaussian(50, 5)])
    )
    u >> dd.Gain(0.0) >> v
    s = dd.Session(model)
    with pytest.raises(
        dd.errors.NotFinite, match=r"^v became infinite or undefined in step (\d+) .*smaller dt"
    ) as caught:
        s.step(500)
    step = int(str(caught.value).split("step ")[1].split()[0])
    session = dd.Session(model)
    session.step(step - 1)
    assert np.isfinite(session.read("v.activation")).all()
    with pytest.raises(dd.errors.NotFinite, match=f"in step {step} "):
        session.step(1)
    with pytest.raises(dd.errors.NotFinite, match=f"in step {step} "):
        dd.simulate(model, 500, record=["v.activation"], trials=2)


def test_ctrl_c_returns_the_record_so_far(monkeypatch: pytest.MonkeyPatch) -> None:
    from deodar.session.run import Run

    model, chunk, calls = relaxing(), Run._chunk, []

    def stopping(self: Run, *args: object) -> object:
        calls.append(1)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return chunk(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Run, "_chunk", stopping)
    with pytest.raises(dd.errors.Interrupted) as caught:
        dd.simulate(model, 100_000, record=["u.activation"])
    from deodar.recording.record import about

    record = caught.value.data
    assert 1 < record.sizes["time"] < 100_001 and not about(record)["complete"]
    assert np.array_equal(record["time"].values, np.arange(record.sizes["time"]))
    assert np.allclose(record["u.activation"].values, 1)


class Ramp(World):
    """A world that shows its time, updated every 4 units."""

    sensors: ClassVar[Mapping[str, Signal]] = {"clock": Signal("time")}
    period = 4.0

    def __init__(self) -> None:
        self.asked: list[float] = []

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        self.asked.append(time)
        return np.full([a.samples for a in axes], time)


def test_a_world_is_sensed_at_its_period_for_any_chunks() -> None:
    model = dd.Model("sensing")
    model.add(Sensor("eye", [x], sensor="clock"))
    expected = [4.0 * (t // 4) for t in range(21)]
    world = Ramp()
    record = dd.simulate(model, 20, record=["eye.output"], world=world)
    assert record["eye.output"].values[:, 0].tolist() == expected and world.asked == [0, 4, 8, 12, 16, 20]
    s = dd.Session(model, world=Ramp())
    for n in (1, 2, 5, 7):
        s.step(n)
        assert s.read("eye.output")[0] == expected[s.tick]
    early = dd.Session(model, world=Ramp())
    early.step(6)
    snapshot = early.snapshot()
    early.step(7)
    early.restore(snapshot)  # inside a period: the sensor has its old reading again
    for _ in range(9):
        assert early.read("eye.output")[0] == expected[early.tick]
        early.step(1)
    s.reset()
    assert s.read("eye.output")[0] == 0


def test_worlds_that_do_not_fit_are_refused() -> None:
    model = dd.Model("sensing")
    model.add(Sensor("eye", [x], sensor="clock"))
    with pytest.raises(dd.errors.WorldError, match="no world was given"):
        dd.Session(model)
    with pytest.raises(dd.errors.WorldError, match="has no sensor 'clock'"):
        dd.Session(model, world=Picture.example())
    with pytest.raises(dd.errors.TimeError, match="period"):
        dd.Session(model, world=Ramp(), dt=3).step(1)


def test_a_picture_is_sampled_with_its_proportions_and_colours() -> None:
    wide = np.zeros((10, 20, 3), np.uint8)
    wide[:, :10, 0], wide[:, 10:, 2] = 255, 255
    axes = (dd.Axis("x", 0, 19, 20), dd.Axis("y", 0, 19, 20), dd.Axis("channel", 0, 2, 3))
    seen = Picture(wide).sense("picture", axes, 0.0)
    assert seen.shape == (20, 20, 3) and seen[:, :5].max() == 0 and seen[:, 15:].max() == 0
    assert (seen[:10, 5:15] == [1, 0, 0]).all() and (seen[10:, 5:15] == [0, 0, 1]).all()
    assert Picture(wide).to_pixels(axes, 0, 5) == (0.5, 0.5)


def test_a_long_run_takes_few_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first chunk measures the speed; the others have the steps that take a fifth of a second."""
    chunk, used = Run._chunk, list[int]()

    def counted(self: Run, program: object, counts: dict[str, int], steps: int) -> object:
        used.append(steps)
        return chunk(self, program, counts, steps)  # type: ignore[arg-type]

    monkeypatch.setattr(Run, "_chunk", counted)
    model = dd.Model("m")
    model.add(dd.Field("n", []))
    session = dd.Session(model)
    session.step(40_000)
    assert sum(used) == session.tick == 40_000 and used[0] == 20
    assert len(used) < 500, "chunks of the length of the first would be 2000"


def test_the_cost_of_a_document_imports_no_function_that_it_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "named_by_a_document.py").write_text("def f(state, inputs, time):\n    return state\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    model = dd.Model("m")
    model.add(dd.Boost("b"))
    session = dd.Session(dd.Model(document=model.document, trusted=False))
    for name in ("named_by_a_document:f", "no_such_module:f"):
        model.add(Function(name.partition(":")[0], function=name))
        assert session.cost(model.document) == "recompile"
    with pytest.raises(Untrusted):
        session.edit(model.document)
    assert "named_by_a_document" not in sys.modules
