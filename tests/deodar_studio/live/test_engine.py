"""The engine: a session in a thread of its own, paced by the wall clock and read from other threads."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ModelError, ParameterError, TimeError
from deodar.model import edit
from deodar.model.unit import unit_seconds
from deodar.session.pace import Pace
from deodar_studio.live import engine as engine_module
from deodar_studio.live.engine import Engine, Injection
from deodar_studio.live.section import Section
from deodar_studio.live.trace import CAPACITY, Trace, TraceRequest

X = dd.Axis("x", 0, 100, samples=101)
WAIT = 600.0


def model() -> dd.Model:
    network = dd.Model("m")
    u = network.add(dd.Field("u", [X], kernel=[dd.Gaussian(1, 5)]))
    network.add(dd.GaussianStimulus("s", [X], center=50, amplitude=2)) >> u
    return network


class Driven:
    """An engine with a model, and methods that wait for it."""

    def __init__(self) -> None:
        self.news = threading.Event()
        self.engine = Engine(self.news.set)
        self.model = model()
        self.u = self.model["u"].id
        self.do(lambda: self.engine.load(dd.Session(self.model)))

    def do(self, function: Callable[[], Any]) -> Any:
        return self.engine.call(function).result(WAIT)

    def until(self, condition: Callable[[], Any]) -> None:
        end = time.monotonic() + WAIT
        while not condition():
            assert time.monotonic() < end, "it never came"
            self.engine.want()
            self.news.wait(0.05)
            self.news.clear()

    def idle(self, condition: Callable[[], Any]) -> None:
        """Wait without requesting a state."""
        end = time.monotonic() + WAIT
        while not condition():
            assert time.monotonic() < end, "it never came"
            time.sleep(0.01)


@pytest.fixture
def driven() -> Iterator[Driven]:
    one = Driven()
    yield one
    one.engine.close()


def test_a_snapshot_after_steps_equals_that_of_a_script(driven: Driven) -> None:
    engine, place = driven.engine, (driven.u, "activation")
    driven.do(lambda: engine.show([place], []))
    driven.do(lambda: engine.step(123))
    driven.until(lambda: engine.published.tick == 123 and place in engine.published.arrays)
    script = dd.Session(driven.model)
    script.step(123)
    np.testing.assert_array_equal(engine.published.arrays[place], script.read("u.activation"))
    assert not engine.running


def test_a_port_requested_before_a_session_exists_is_shown(driven: Driven) -> None:
    engine, place = driven.engine, (driven.u, "activation")
    driven.do(lambda: engine.load(None))
    driven.do(lambda: engine.show([place], [TraceRequest(place)]))
    driven.do(lambda: engine.load(dd.Session(driven.model)))
    driven.until(lambda: place in engine.published.arrays)


def test_an_injected_input_is_part_of_the_input(driven: Driven) -> None:
    engine, place = driven.engine, (driven.u, "input")
    driven.do(lambda: engine.show([place], []))
    driven.until(lambda: place in engine.published.arrays)
    before = engine.published.arrays[place]
    driven.do(lambda: engine.inject(Injection(driven.u, np.full(101, 2.5))))
    driven.until(lambda: np.allclose(engine.published.arrays[place], before + 2.5))
    driven.do(lambda: engine.inject(None))
    driven.until(lambda: np.allclose(engine.published.arrays[place], before))


def test_steps_wait_for_a_session(driven: Driven) -> None:
    engine = driven.engine
    driven.do(lambda: engine.load(None))
    driven.do(lambda: engine.step(7))
    driven.do(lambda: engine.load(dd.Session(driven.model)))
    driven.until(lambda: engine.published.tick == 7)


def test_play_waits_for_a_session(driven: Driven) -> None:
    engine = driven.engine
    driven.do(lambda: engine.load(None))
    driven.do(lambda: engine.play(True))
    driven.do(lambda: engine.load(dd.Session(driven.model)))
    driven.until(lambda: engine.published.tick > 5)
    driven.do(lambda: engine.load(dd.Session(driven.model)))
    assert not engine.running, "another document is paused at first"


def test_real_time_and_slow_motion_follow_the_wall_clock(driven: Driven) -> None:
    """In real time a second of the model takes at least a second; a slow machine may take longer."""
    engine = driven.engine
    for speed in (1.0, 0.1):
        driven.do(lambda speed=speed: engine.pace.go(speed))
        driven.do(lambda: engine.play(True))
        began, first = time.perf_counter(), driven.do(lambda: engine.session.time)  # type: ignore[union-attr]
        driven.until(lambda first=first: engine.session is not None and engine.session.time >= first + 50)
        last, passed = driven.do(lambda: engine.session.time), time.perf_counter() - began  # type: ignore[union-attr]
        assert 0 < last - first <= 1000 * speed * passed + 25
        driven.do(lambda: engine.play(False))


def test_speed_none_is_faster_than_real_time(driven: Driven) -> None:
    engine = driven.engine
    driven.do(lambda: engine.pace.go(None))
    driven.do(lambda: engine.play(True))
    driven.until(lambda: engine.published.tick > 5000)
    assert engine.pace.speed is None


def test_a_request_without_a_session_is_an_error(driven: Driven) -> None:
    engine = driven.engine
    driven.do(lambda: engine.load(None))
    for function in (engine.measure, lambda: engine.lengthen(2.0)):
        with pytest.raises(ModelError, match="no model runs yet"):
            driven.do(function)


def test_without_requested_ports_no_state_is_published(driven: Driven) -> None:
    engine = driven.engine
    driven.until(lambda: engine.published.number > 0)
    driven.do(lambda: engine.play(True))
    driven.idle(lambda: engine.session is not None and engine.session.tick > 10)
    number, tick = engine.published.number, driven.do(lambda: engine.session.tick)  # type: ignore[union-attr]
    driven.idle(lambda: engine.session is not None and engine.session.tick > tick + 100)
    assert engine.published.number <= number + 1
    engine.want()
    driven.until(lambda: engine.published.number > number + 1)


def test_traces_contain_times_and_values_and_are_cleared_by_a_reset(driven: Driven) -> None:
    engine = driven.engine
    requests = [TraceRequest((driven.u, "activation"), reduce) for reduce in ("max", "mean")] + [
        TraceRequest((driven.u, "activation"), "at", (50.0,))
    ]
    driven.do(lambda: engine.show([], requests))
    # the program that samples is compiled
    driven.until(
        lambda: all(request in engine.traces and engine.traces[request].count for request in requests)
    )
    driven.do(lambda: engine.step(200))
    driven.until(lambda: engine.published.tick == 200)
    samples = {w: engine.traces[w].since(0) for w in requests}
    top, mean, at = (samples[w] for w in requests)
    assert top[-1, 0] == 200 and (np.diff(top[:, 0]) > 0).all() and len(top) > 4
    assert (top[:, 1] >= mean[:, 1]).all() and np.allclose(top[:, 1], at[:, 1])
    driven.do(engine.reset)
    assert all(engine.traces[w].count == 0 for w in requests)


def test_requested_steps_wait_for_the_program_that_samples_a_new_trace(
    driven: Driven, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Otherwise a plot that was just opened would stay without the steps that follow."""
    made = engine_module.port_reader

    def slow(*arguments: Any) -> Any:
        time.sleep(0.5)
        return made(*arguments)

    monkeypatch.setattr(engine_module, "port_reader", slow)
    engine, place = driven.engine, (driven.u, "activation")
    both = [place, (driven.model["s"].id, "output")]  # read by another program than the trace
    driven.do(lambda: engine.show(both, []))
    driven.until(lambda: place in engine.published.arrays)  # whose state is the first sample of the trace
    request = TraceRequest(place, "mean")
    driven.do(lambda: engine.show(both, [request]))
    driven.do(lambda: engine.step(40))
    driven.until(lambda: engine.published.tick == 40)
    times = engine.traces[request].since(0)[:, 0]
    assert times[-1] == 40 and len(times) > 4 and np.diff(times).max() < 40


def test_a_trace_whose_program_is_late_gets_the_present_sample(driven: Driven) -> None:
    engine, place = driven.engine, (driven.u, "activation")
    both = [place, (driven.model["s"].id, "output")]
    driven.do(lambda: engine.show(both, []))
    driven.until(lambda: place in engine.published.arrays)
    request = TraceRequest(place, "mean")

    def late() -> None:
        engine.show(both, [request])
        assert engine.session is not None
        engine.session.step(5)  # as in a run that does not wait

    driven.do(late)
    driven.until(lambda: engine.traces[request].newest == 5)
    assert len(engine.traces[request].since(0)) == 2


def test_a_live_change_acts_at_once_and_a_structural_one_when_it_is_compiled(driven: Driven) -> None:
    engine, m = driven.engine, driven.model
    m.set("u.resting_level", -3)
    assert driven.do(lambda: engine.adopt(m, m.document)) == "live"
    assert driven.do(lambda: engine.session.get("u.resting_level")) == -3  # type: ignore[union-attr]
    driven.do(lambda: engine.play(True))
    driven.until(lambda: engine.published.tick > 20)
    m.set("u.kernel", [dd.Gaussian(1, 5), dd.Gaussian(-0.5, 9)])
    assert driven.do(lambda: engine.adopt(m, m.document)) == "recompile"
    m.set("u.tau", 30)
    driven.do(lambda: engine.adopt(m, m.document))
    driven.until(lambda: engine.session is not None and engine.session.document is m.document)
    tick = engine.published.tick
    driven.until(lambda: engine.published.tick > tick + 20)
    assert engine.running and not engine.failure[0]


def test_a_document_that_cannot_continue_is_refused_and_nothing_changes(driven: Driven) -> None:
    engine, m = driven.engine, driven.model
    session = engine.session
    assert session is not None
    before = session.document
    for bad in (edit.change(m.document, "u.tau", 0.5), edit.describe(m.document, dt=50.0)):
        with pytest.raises(TimeError, match="longer than the time constant"):
            driven.do(lambda bad=bad: engine.adopt(m, bad))
    assert session.document is before
    with pytest.raises(ParameterError, match="takes no input"):
        driven.do(lambda: engine.inject(Injection(m["s"].id, np.zeros(101))))


def test_a_failure_stops_the_run_and_a_reset_ends_it(driven: Driven) -> None:
    engine, m = driven.engine, driven.model
    model_of_trouble = dd.Model("trouble")
    u = model_of_trouble.add(dd.Field("u", [], tau=1, resting_level=1, noise=1))
    model_of_trouble.add(dd.GaussianStimulus("s", [], amplitude=1e38)) >> dd.Gain(1e38) >> u
    driven.do(lambda: engine.load(dd.Session(model_of_trouble)))
    driven.do(lambda: engine.play(True))
    driven.until(lambda: engine.failure != ((), ()))
    assert not engine.running and "infinite" in engine.failure[0][0].what and engine.failure[1]
    driven.do(engine.reset)
    assert engine.failure == ((), ())
    assert m is driven.model


def test_a_new_trace_begins_with_the_stored_states(driven: Driven) -> None:
    engine, place = driven.engine, (driven.u, "activation")
    driven.do(lambda: engine.show([place], []))
    driven.until(lambda: engine.published.arrays)
    for n in (3, 4):
        driven.do(lambda n=n: engine.step(n))
        driven.until(lambda n=n: engine.published.tick == {3: 3, 4: 7}[n])
    stored = engine.ring.states()
    requests = [TraceRequest(place), TraceRequest(place, section=Section(most=1))]
    driven.do(lambda: engine.show([place], requests))
    course, rows = (engine.traces[request].since(0) for request in requests)
    assert stored[-1].time == 7 and len(stored) >= 2
    assert course.tolist() == [[s.time, s.arrays[place].max()] for s in stored]
    assert np.array_equal(rows[:, 1:], [s.arrays[place] for s in stored])
    missing = TraceRequest((driven.u, "no such port"))
    driven.do(lambda: engine.show([place], [missing]))
    assert engine.traces[missing].count == 0


def test_a_trace_keeps_the_newest_samples() -> None:
    trace = Trace()
    for k in range(CAPACITY + 10):
        trace.add(k, 2 * k)
    kept = trace.since(0)
    assert (
        len(kept) == CAPACITY and kept[0, 0] == 10 and kept[-1].tolist() == [CAPACITY + 9, 2 * (CAPACITY + 9)]
    )
    assert trace.since(CAPACITY + 8)[:, 0].tolist() == [CAPACITY + 8, CAPACITY + 9]


@pytest.mark.parametrize(
    ("unit", "seconds"),
    [("ms", 1e-3), ("s", 1), ("1 = 64 ms", 0.064), ("1 = 2 min", 120), ("abstract", 1e-3)],
)
def test_units_of_time_are_converted_to_seconds(unit: str, seconds: float) -> None:
    assert unit_seconds(unit) == pytest.approx(seconds)


def test_a_machine_that_is_too_slow_does_not_pile_up_steps() -> None:
    session = dd.Session(model())
    pace = Pace()
    pace.go(1.0)
    pace.took(session, 1, 1.0, 0.004)  # 4 ms a step, and 1 ms is requested
    time.sleep(0.05)
    assert pace.due(session) <= pace.most(session) <= 3


def test_a_trace_up_to_a_time_has_the_earlier_samples() -> None:
    trace = Trace()
    for at in range(10):
        trace.add(at, 2.0 * at)
    np.testing.assert_array_equal(trace.until(3).since(0), [(t, 2.0 * t) for t in range(4)])
    assert trace.count == 10


def test_the_first_steps_after_an_edit_are_published_at_once(
    driven: Driven, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine, m, place = driven.engine, driven.model, (driven.u, "activation")
    driven.do(lambda: engine.show([place], []))
    driven.until(lambda: place in engine.published.arrays)
    monkeypatch.setattr(engine_module, "FRAME", math.inf)
    driven.do(lambda: engine.play(True))

    def adopted() -> int:
        assert engine.session is not None and engine.adopt(m, m.document) == "live"
        return engine.session.tick

    for level in (3.0, -20.0):
        number = engine.published.number
        m.set("u.resting_level", level)
        tick = driven.do(adopted)
        driven.until(lambda number=number: engine.published.number >= number + engine_module.HURRIED)
        assert engine.published.number == number + engine_module.HURRIED
        assert engine.published.tick > tick


def test_an_edit_that_loses_a_state_is_refused_while_the_model_runs_and_begins_it_again_before(
    driven: Driven,
) -> None:
    engine, m = driven.engine, driven.model
    plane = [X, dd.Axis("y", 0, 10, samples=11)]
    m.set("u.axes", plane)
    assert driven.do(lambda: engine.adopt(m, m.document)) == "recompile"
    driven.do(lambda: engine.session.step(5))  # type: ignore[union-attr]
    driven.until(lambda: engine.session is not None and engine.session.document is m.document)
    assert engine.session is not None and engine.session.tick == 0 and not engine.failure[0]
    driven.do(lambda: engine.session.step(5))  # type: ignore[union-attr]
    m.undo()
    with pytest.raises(ParameterError, match=r"u: .*it is no longer along the axis y"):
        driven.do(lambda: engine.adopt(m, m.document))


def test_a_snapshot_of_another_model_is_refused_and_the_run_continues(driven: Driven) -> None:
    engine, model = driven.engine, dd.Model("another")
    model.add(dd.Field("v", [X]))
    wrong = dd.Session(model).snapshot()
    driven.do(lambda: engine.play(True))
    with pytest.raises(ParameterError, match=r"another model"):
        driven.do(lambda: engine.restore(wrong))
    assert engine.running
