"""Document time after 30 days at a step of 1 ms: in single precision every event occurs in the same step
as in double precision.
"""

from __future__ import annotations

import dataclasses as dc
import importlib.util
import re
from collections.abc import Callable

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.compiler.functions import Functions
from deodar.element import Setting, Time
from deodar.elements.changing_stimuli import MovingGaussian, TimeSeries
from deodar.elements.memories import History
from deodar.elements.stimuli import Boost
from deodar.errors import TimeError
from deodar.leaves import leaves
from deodar.model.model import Model
from deodar.numerics.axes import shape
from deodar.parameters import parameters
from tests.contracts.build import KINDS, PARTS, any_example, around, example, node

DAY = 86_400_000.0
RING = dd.Axis("phi", 0, 360, 36, periodic=True)


def begun(t0: float, dt: float = 1.0) -> Model:
    model = dd.Model("late", dt=dt)
    model.describe(t0=t0)
    return model


def both(model: Model, path: str, duration: float = 12.0, **others: object) -> tuple[np.ndarray, np.ndarray]:
    single, double = (
        dd.simulate(model, duration, record=[path], precision=p, **others)[path].values
        for p in ("float32", "float64")
    )
    assert single.dtype == np.float32
    return single, double


@pytest.mark.parametrize("t0", [2.0**24, 3 * DAY, 30 * DAY - 20, 30 * DAY + 0.25, 400 * DAY])
def test_a_window_of_two_steps_lasts_two_steps_at_late_times(t0: float) -> None:
    model = begun(t0)
    model.add(Boost("s", amplitude=2.0, windows=[(t0 + 3, t0 + 5), (t0 + 8, t0 + 9)]))
    single, double = both(model, "s.output")
    assert single.tolist() == double.tolist() == [0, 0, 0, 2, 2, 0, 0, 0, 2, 0, 0, 0, 0]


def test_a_window_that_is_changed_swept_or_linked_keeps_its_digits() -> None:
    t0 = 30 * DAY
    model = begun(t0)
    model.add(Boost("s", windows=[(t0 + 3, t0 + 5)]))
    sweep = {"s.windows.0.start": [t0 + 2, t0 + 3, t0 + 4]}
    seen = dd.simulate(model, 6, record=["s.output"], sweep=sweep)["s.output"].values
    assert seen.sum(1).tolist() == [3, 2, 1]
    session = dd.Session(model)
    session.step(4)
    assert session.read("s.output") == 1
    session.set("s.windows.0.start", t0 + 5)
    assert session.read("s.output") == 0
    session.set("s.windows.0.stop", t0 + 6)
    session.step()
    assert session.read("s.output") == 1
    model.parameter("begin", t0 + 1)
    model.link("s.windows.0.start", "begin")
    assert both(model, "s.output", 6)[0].tolist() == [0, 1, 1, 1, 1, 0, 0]


@pytest.mark.parametrize("velocity", [0.1, -1 / 3])
def test_a_stimulus_moves_in_every_step_at_late_times(velocity: float) -> None:
    t0 = 30 * DAY
    model = begun(t0)
    model.add(
        MovingGaussian(
            "s", [RING], center=20.0, sigma=30.0, velocity=velocity, waypoints=[[t0, 0.0], [t0 + 6, 60.0]]
        )
    )
    single, double = both(model, "s.output")
    np.testing.assert_allclose(single, double, atol=2e-6)
    time = t0 + np.arange(13)
    distance = RING.points - (20 + velocity * time + np.interp(time, [t0, t0 + 6], [0, 60]))[:, None]
    distance -= 360 * np.round(distance / 360)
    np.testing.assert_allclose(single, np.exp(-0.5 * (distance / 30) ** 2), atol=1e-5)


@pytest.mark.parametrize("interpolation", ["linear", "hold"])
@pytest.mark.parametrize("period", [0.0, 7.1, DAY])
def test_a_time_series_is_exact_at_late_times(interpolation: str, period: float) -> None:
    t0 = 30 * DAY
    times = (t0 if period == 0.0 else 0.0) + np.array([1.0, 3.0, 3.5, 6.0])
    model = begun(t0, dt=0.5)
    model.add(TimeSeries("s", [], times, [1.0, 2.0, -3.0, 5.0], interpolation=interpolation, period=period))
    single, double = both(model, "s.output", 15)
    np.testing.assert_allclose(single, double, atol=1e-5)
    assert double.std() > 1


def test_a_history_keeps_its_interval_at_late_times() -> None:
    model = begun(30 * DAY)
    source = model.add(TimeSeries("s", [], 30 * DAY + np.arange(40.0), np.arange(40.0)))
    source >> model.add(History("h", [], dd.Axis("slot", 0, 9, 10), interval=3.0))
    single, double = both(model, "h.output", 31)
    np.testing.assert_array_equal(single, double)
    assert (np.diff(double[-1]) == -3).all()


def test_a_step_that_is_not_a_binary_fraction_is_counted_exactly() -> None:
    """With a step of 0.1 ms, a window opens in the right step 2^26 steps after the start."""
    t0 = 2.0**26 * 0.1
    model = begun(t0, dt=0.1)
    model.add(Boost("s", windows=[(t0 + 0.3, t0 + 0.5)]))
    single, double = both(model, "s.output", 0.8)
    assert single.tolist() == double.tolist() == [0, 0, 0, 1, 1, 0, 0, 0, 0]


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_times_that_cannot_be_distinguished_are_refused(precision: str) -> None:
    model = begun(2.0**45)
    model.add(dd.Field("u", []))
    with pytest.raises(
        TimeError,
        match=(
            r"time 3.51844e\+13 ms is 3.52e\+13 steps of dt = 1 from time 0; times are exact up to 1.76e\+13"
        ),
    ):
        dd.simulate(model, 10, precision=precision)
    with pytest.raises(TimeError, match="times are exact up to"):
        dd.Session(model, precision=precision)
    model.describe(t0=0)
    session = dd.Session(model, precision=precision)
    with pytest.raises(TimeError, match=r"at most 1\.76"):
        session.run(2.0**45)


WINDOWED = sorted(kind for kind, cls in KINDS.items() if any(p.name == "windows" for p in parameters(cls)))
"""Kinds with windows that switch them on and off."""


def windowed(kind: str, t0: float) -> Model:
    """Return the example of a kind, on in two windows, with a source for each input."""
    model = around(dc.replace(example(kind), windows=[(t0 + 3, t0 + 5), (t0 + 8, t0 + 9)]))  # type: ignore[call-arg]
    model.describe(t0=t0)
    return model


def scene(kind: str, name: str) -> Callable[..., Model] | None:
    """Return a function of the test of a kind: `timed(t0)`, a model with its element `example` and an event
    within twelve steps after t0, or `lasting(duration)`, a model whose output changes after this duration.
    """
    folder = KINDS[kind].__module__.removeprefix("deodar.").rpartition(".")[0]
    path = f"tests.deodar.{folder}.test_{re.sub('(?<!^)(?=[A-Z])', '_', kind).lower()}"
    return getattr(importlib.import_module(path), name, None) if importlib.util.find_spec(path) else None


TIMED = {kind: found for kind in KINDS if (found := scene(kind, "timed"))}
LASTING = {kind: found for kind in KINDS if (found := scene(kind, "lasting"))}
LONG = 30 * DAY + 7


class Watched(Time):
    """A time that records whether it was read, and not only the step."""

    read: set[str] = set()

    @property
    def wide(self) -> object:
        self.read.add("wide")
        return super().wide


def reads_time(kind: str) -> bool:
    """Return whether a step of the example of a kind depends on the time."""
    options = example(kind)
    element = dc.replace(options, windows=[(1, 2)]) if kind in WINDOWED else options  # type: ignore[call-arg]
    here = node(around(element))
    at = Setting(here.ins, here.outs, np.dtype("float32"))
    inputs = {port: np.zeros(shape(axes), at.dtype) for port, axes in here.ins.items()}
    if element.external:
        inputs[element.external] = np.zeros(shape(here.outs["output"]), at.dtype)
    inputs |= {p: np.zeros(shape(here.outs[p]), at.dtype) for p in element.reads_own_output}
    noise = None if element.noise_axes() is None else np.ones(shape(element.noise_axes()), at.dtype)  # type: ignore[arg-type]
    time = Watched.at(0.0, 1.0, at.dtype)

    def step() -> object:
        functions = Functions(here, {})
        begun = dc.replace(at, constants=functions.prepare(element, at), state=element.init(at))
        now = dc.replace(
            begun, constants=functions.hoist(element, begun), inputs=inputs, time=time, noise=noise
        )
        return functions.output(element, now), functions.advance(element, now)

    Watched.read.clear()
    jax.eval_shape(step)
    return bool(Watched.read)


def test_every_kind_that_reads_time_is_tested() -> None:
    kinds = {kind for kind in KINDS if reads_time(kind)}
    lasting = {kind for kind, cls in KINDS.items() if any(p.role == "duration" for p in parameters(cls))}
    assert kinds | lasting == {*WINDOWED, *TIMED}, (
        "the test of a kind that reads time has a function timed(t0)"
    )
    assert lasting == set(LASTING), "the test of a kind with a duration has a function lasting(duration)"


@pytest.mark.parametrize("kind", sorted({*WINDOWED, *TIMED}))
def test_the_output_of_a_kind_does_not_depend_on_the_start_time(kind: str) -> None:
    scene = TIMED.get(kind, lambda t0: windowed(kind, t0))
    seen, late = (
        dd.simulate(scene(t0), 12, dt=1, record=["example.output"])["example.output"].values
        for t0 in (0.0, 30 * DAY)
    )
    assert np.abs(np.diff(seen, axis=0)).max() > 0.01
    np.testing.assert_allclose(late, seen, atol=1e-5 * np.abs(seen).max())


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("kind", LASTING)
def test_a_run_of_a_month_ends_at_the_exact_step(kind: str, precision: str) -> None:
    session = dd.Session(LASTING[kind](LONG), precision=precision)
    session.step(5)
    then = session.snapshot()
    # kinds that count steps in their state do not count the days between
    session.restore(dc.replace(then, clock=then.clock.after(int(30 * DAY) - 5)))
    seen: list[float] = []
    for _ in range(12):
        seen.append(float(np.ravel(session.read("example.output"))[0]))
        session.step()
    assert len(set(seen[:7])) == 1 and seen[7] != seen[6]


def test_every_parameter_that_is_a_time_or_duration_is_declared_exact() -> None:
    """Single precision is enough for a rate that multiplies the step, and never the elapsed time."""
    for name, cls in {**KINDS, **PARTS}.items():
        declared = {p.name: p for p in parameters(cls)}
        declared |= {path: p for path, _, p in leaves(any_example(name)) if p.exact}
        for p in declared.values():
            assert p.exact or p.role not in ("moment", "duration"), (name, p.name)
            assert p.exact or "/time" not in p.unit or not (name in KINDS and reads_time(name)), (
                name,
                p.name,
            )
