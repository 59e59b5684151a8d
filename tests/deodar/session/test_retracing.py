"""An unchanged model compiles once for all durations, seeds and values of live parameters."""

from __future__ import annotations

from collections.abc import Iterator

import jax
import pytest

import deodar as dd
from tests.deodar.session.models import mixed


class Counter:
    """A counter of traces and compilations of this process."""

    def __init__(self) -> None:
        self.on = False
        self.events: list[str] = []

    def __call__(self, event: str, duration: float, **_: object) -> None:
        if self.on and ("trace" in event or "compile" in event or "lower" in event):
            self.events.append(event)


@pytest.fixture
def counter() -> Iterator[Counter]:
    counter = Counter()
    jax.monitoring.register_event_duration_secs_listener(counter)
    yield counter
    counter.on = False


def test_the_counter_counts_compilations(counter: Counter) -> None:
    counter.on = True
    jax.jit(lambda x: x * 3 + 1)(2.0)
    assert counter.events


def test_a_second_simulate_compiles_nothing(counter: Counter) -> None:
    model = mixed()
    dd.simulate(model, 30, seed=1, record=["u.activation"], every=3)
    counter.on = True
    dd.simulate(model, 90, seed=2, record=["u.activation"], every=9)
    dd.simulate(model, 45, seed=2, record=["u.activation"], every=45, dt=0.5)
    model.set("s.amplitude", 3)
    model.set("u.kernel.0.sigma", 2)
    model.set("u.tau", 15)
    dd.simulate(model, 10, record=["u.activation"])
    assert counter.events == []


def test_a_second_session_compiles_nothing(counter: Counter) -> None:
    model = mixed()
    first = dd.Session(model)
    first.step(3)
    first.read("u.activation")
    counter.on = True
    second = dd.Session(model, seed=7, dt=0.5)
    second.run(20)
    second.step(7)
    assert second.set("s.amplitude", 2) == "live"
    assert second.set("u.kernel.0.sigma", 6) == "rebuild"
    second.dt = 1
    second.step(4)
    second.read("u.activation")
    second.reset()
    snapshot = second.snapshot()
    second.step(2)
    second.restore(snapshot)
    assert counter.events == []


def test_leaving_a_neutral_value_recompiles_once_and_keeps_the_state(counter: Counter) -> None:
    model = dd.Model("neutral")
    axis = dd.Axis("x", 0, 10, samples=11)
    model.add(dd.Field("u", [axis], noise=0))
    session = dd.Session(model)
    session.step(20)
    before = session.read("u.activation")
    session.set("u.resting_level", -3)
    session.step(20)
    middle = session.read("u.activation")
    assert session.set("u.noise", 0.5) == "recompile"
    assert (session.read("u.activation") == middle).all() and session.tick == 40 and (middle != before).all()
    session.step(1)
    counter.on = True
    assert session.set("u.noise", 0.0) == "live"
    session.step(1)
    session.set("u.noise", 0.2)
    session.step(1)
    assert counter.events == []


def test_a_second_batch_compiles_nothing(counter: Counter) -> None:
    model = mixed()
    dd.simulate(model, 5, trials=3, sweep={"s.amplitude": [1, 2]})
    counter.on = True
    dd.simulate(model, 9, trials=[7, 8, 9], seed=4, sweep={"s.amplitude": [5, 9]})
    assert counter.events == []
