"""Runs that continue from an earlier moment have the bits of an undisturbed session."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ParameterError, RecordError
from deodar.model import edit
from deodar.model.document import Document
from deodar.session.port_reader import PortKey
from deodar_studio.live import branch_states
from deodar_studio.live.branch_states import BranchStates, size
from deodar_studio.live.engine import Injection
from deodar_studio.live.ring import StateRing
from deodar_studio.live.section import Section
from deodar_studio.live.trace import Trace, TraceRequest
from tests.deodar.session.models import bits, mixed
from tests.deodar.worlds.test_recorded_run import driving
from tests.deodar_studio.live.test_engine import Driven


class Branching(Driven):
    """An engine whose states are stored at every exchange, each of `stride` steps."""

    def __init__(self, model: dd.Model, world: Any = None) -> None:
        super().__init__()
        self.model = model
        self.do(lambda: self.engine.load(dd.Session(model, seed=3, world=world)))
        self.ident = next(e.id for e in model.document.entries if isinstance(e.element, dd.Field))
        self.place = (self.ident, "activation")
        self.do(lambda: self.engine.show([self.place], [TraceRequest(self.place)]))
        self.until(lambda: self.place in self.engine.published.arrays)  # its reader is compiled

    def step(self, n: int, stride: int = 7) -> None:
        for done in range(0, n, stride):
            tick = self.session.tick + min(stride, n - done)
            self.do(lambda done=done: self.engine.step(min(stride, n - done)))
            self.until(lambda tick=tick: self.session.tick == self.engine.published.tick == tick)

    def branch(self, time: float) -> Document:
        return self.do(lambda: self.engine.branch(time))

    @property
    def session(self) -> dd.Session:
        found = self.engine.session
        assert found is not None
        return found


@pytest.fixture
def branching() -> Iterator[Callable[..., Branching]]:
    all: list[Branching] = []

    def make(model: dd.Model, world: Any = None) -> Branching:
        all.append(Branching(model, world))
        return all[-1]

    yield make
    for branched in all:
        branched.engine.close()


def test_a_branch_has_the_bits_of_an_undisturbed_session(branching: Callable[..., Branching]) -> None:
    branched = branching(mixed())
    branched.step(70)
    for tick in (63, 35, 14):  # each time from what remains of the past
        branched.branch(tick)
        script = dd.Session(mixed(), seed=3)
        script.step(tick)
        assert bits(branched.session) == bits(script), tick
        branched.step(20)
        script.step(20)
        assert bits(branched.session) == bits(script), tick
        branched.branch(tick)
    span = branched.engine.ring.span()
    assert span is not None and span.last == 14 and branched.session.tick == 14
    assert branched.engine.traces[TraceRequest(branched.place)].since(0)[-1, 0] == 14


REQUESTS = {
    "time courses": lambda place: TraceRequest(place, "mean"),
    "rows over time": lambda place: TraceRequest(place, section=Section(most=1)),
}


@pytest.mark.parametrize("request_for", REQUESTS.values(), ids=REQUESTS)
def test_a_branch_keeps_what_any_plot_showed_before_the_moment(
    branching: Callable[..., Branching], request_for: Callable[[PortKey], TraceRequest]
) -> None:
    branched = branching(mixed())
    request = request_for(branched.place)
    branched.do(lambda: branched.engine.show([branched.place], [request]))
    branched.step(35)
    course = branched.engine.traces[request].since(0)
    branched.branch(21)
    shortened = branched.engine.traces[request].since(0)
    assert shortened[-1, 0] == 21 and np.array_equal(shortened, course[course[:, 0] <= 21])
    branched.step(14)
    repeated = branched.engine.traces[request].since(0)
    times, first, second = np.intersect1d(course[:, 0], repeated[:, 0], return_indices=True)
    assert times[-1] == 35, "single samples may be missing, while a reader is compiled"
    assert np.array_equal(course[first], repeated[second])


def test_a_branch_that_fails_leaves_the_run_as_it_was(
    branching: Callable[..., Branching], monkeypatch: pytest.MonkeyPatch
) -> None:
    branched = branching(mixed())
    branched.step(28)
    present, ring, traces = bits(branched.session), branched.engine.ring, branched.engine.traces

    def fail(*_: Any) -> Any:
        raise ValueError("no such moment")

    for owner in (Trace, StateRing):
        with monkeypatch.context() as patch:
            patch.setattr(owner, "until", fail)
            with pytest.raises(ValueError, match="no such moment"):
                branched.branch(7)
        assert bits(branched.session) == present and branched.session.tick == 28
        assert branched.engine.ring is ring and branched.engine.traces is traces
    branched.branch(7)
    assert branched.session.tick == 7


def test_changes_before_the_moment_are_made_again_at_their_ticks(branching: Callable[..., Branching]) -> None:
    """A live value, another program, a step and an injected input: each lies after the stored state."""
    branched, script = branching(mixed()), dd.Session(mixed(), seed=3)
    states = branched.engine.states
    branched.step(7)
    assert states.ticks[0] == 0
    states._due = 1e9  # no further state: everything is computed from the start
    docs: list[Document] = [branched.session.document]

    def change(path: str, value: Any) -> None:
        docs.append(edit.change_all(docs[-1], {path: value}))
        branched.do(lambda: branched.engine.adopt(branched.model, docs[-1]))
        branched.until(lambda: branched.session.document == docs[-1] and not branched.engine.busy)

    change("u.resting_level", -4.0)
    branched.step(7)
    branched.do(lambda: branched.engine.inject(Injection(branched.ident, np.full(31, 2.0))))
    branched.step(7)
    branched.do(lambda: branched.engine.inject(None))
    change("u.sigmoid", dd.Step())
    branched.step(7)
    docs.append(edit.describe(docs[-1], dt=0.5))
    branched.do(lambda: branched.engine.adopt(branched.model, docs[-1]))
    branched.step(14)
    later = bits(branched.session)

    script.step(7)
    script.set("u.resting_level", -4.0)
    script.step(7)
    script.inject("u", np.full(31, 2.0), 7)
    script.set("u.sigmoid", dd.Step())
    script.step(7)
    script.edit(docs[-1])
    script.dt = 0.5
    script.step(7)
    time = script.time
    found = branched.branch(time)
    assert states is branched.engine.states and states.ticks == [0]
    assert found == docs[-1]
    assert branched.session.dt == script.dt == 0.5
    assert bits(branched.session) == bits(script)
    branched.step(7)
    script.step(7)
    assert bits(branched.session) == bits(script) == later


def test_a_moment_before_an_edit_has_the_parameters_of_that_moment(
    branching: Callable[..., Branching],
) -> None:
    branched = branching(mixed())
    branched.step(14)
    before = branched.session.document
    branched.do(
        lambda: branched.engine.adopt(branched.model, edit.change_all(before, {"u.resting_level": -9.0}))
    )
    branched.step(14)
    assert branched.branch(7) == before
    script = dd.Session(mixed(), seed=3)
    script.step(7)
    assert bits(branched.session) == bits(script)


def test_a_branch_of_a_world_has_its_objects_and_its_motion(branching: Callable[..., Branching]) -> None:
    branched, script = (
        branching(driving(), dd.Arena("blocks")),
        dd.Session(driving(), seed=3, world=dd.Arena("blocks")),
    )
    scene = script.scene()
    assert scene is not None
    name = next(box.name for box in scene.boxes if not box.fixed)
    branched.step(14)
    branched.engine.states._due = 1e9
    place = (0.9, 0.4)
    branched.do(lambda: branched.engine.rearrange(lambda session: session.place("late", place, (0.04, 0.04))))
    branched.do(lambda: branched.engine.rearrange(lambda session: session.remove(name)))
    branched.step(14)
    script.step(14)
    script.place("late", place, (0.04, 0.04))
    script.remove(name)
    script.step(7)
    branched.branch(script.time)
    assert bits(branched.session) == bits(script)
    branched.step(30)
    script.step(30)
    assert bits(branched.session) == bits(script)
    branched.branch(7 * 16)
    first = dd.Session(driving(), seed=3, world=dd.Arena("blocks"))
    first.step(7)
    assert bits(branched.session) == bits(first), "the object is back"
    trail = branched.engine.track.trail.places
    assert trail[0] == branched.engine.ring.at(0)[1].trail.places[0]  # type: ignore[index]


def test_a_branch_returns_to_the_world_of_its_moment(branching: Callable[..., Branching]) -> None:
    branched = branching(driving(), dd.Arena("blocks"))
    branched.step(14)
    branched.engine.states._due = 1e9
    branched.do(lambda: branched.engine.see(dd.Arena("large")))
    branched.step(14)
    after = bits(branched.session)
    branched.step(7)
    branched.branch(28 * 16)
    assert bits(branched.session) == after and "large" in str(branched.session.world.describe())  # type: ignore[union-attr]
    branched.branch(7 * 16)
    script = dd.Session(driving(), seed=3, world=dd.Arena("blocks"))
    script.step(7)
    assert bits(branched.session) == bits(script)


@pytest.mark.parametrize("replaced", [False, True])
def test_a_branch_brings_back_no_motor_without_its_limits(
    branching: Callable[..., Branching], replaced: bool
) -> None:
    branched = branching(driving(), dd.Robot("epuck"))
    branched.step(14)
    narrow = dd.Robot("epuck")
    narrow.narrow("left", (-1.0, 1.0))
    change = {
        True: lambda: branched.engine.see(narrow),
        False: lambda: branched.engine.narrow("left", (-1.0, 1.0), None),
    }[replaced]
    branched.do(change)
    branched.step(14)
    after = bits(branched.session)
    branched.step(7)
    with pytest.raises(RecordError, match="no state before it is kept"):
        branched.branch(7 * 16)
    branched.branch(28 * 16)
    world = branched.session.world
    assert world is not None and world.rules["left"].limits == (-1.0, 1.0)
    bits(branched.session)  # moves the world up to this moment
    branched.do(world.halt)  # as the pause did after the steps
    assert bits(branched.session) == after


def test_a_moment_before_the_first_element_is_restored(branching: Callable[..., Branching]) -> None:
    branched = branching(mixed())
    full, empty = branched.session.document, Document("nothing yet")
    branched.do(lambda: branched.engine.adopt(branched.model, empty))
    branched.until(lambda: branched.session.document == empty and not branched.engine.busy)
    branched.do(lambda: branched.engine.show([], []))
    branched.do(branched.engine.reset)
    branched.step(14)
    branched.do(lambda: branched.engine.see(dd.Arena("blocks")))
    branched.do(lambda: branched.engine.adopt(branched.model, full))
    branched.until(lambda: branched.session.document == full and not branched.engine.busy)
    branched.step(14)
    after = bits(branched.session)
    branched.step(7)
    branched.branch(28)
    assert bits(branched.session) == after
    assert branched.branch(7) == empty and branched.session.tick == 7 and branched.session.world is None


def test_a_refused_return_to_a_moment_keeps_the_edit_that_is_being_compiled(
    branching: Callable[..., Branching],
) -> None:
    branched = branching(mixed())
    branched.step(7)
    wrong = dc.replace(branched.do(branched.engine.snapshot), precision="float64")
    branched.engine.states._too_large = 2**40

    def adopt_and_return(coming: Document, back: Callable[[], Any], error: type[Exception]) -> None:
        branched.engine.adopt(branched.model, coming)  # in one call, so that its compilation has not ended
        with pytest.raises(error):
            back()

    for sigmoid, back, error in (
        (dd.Step(), lambda: branched.engine.branch(7), RecordError),
        (dd.Absolute(), lambda: branched.engine.restore(wrong), ParameterError),
    ):
        coming = edit.change_all(branched.session.document, {"u.sigmoid": sigmoid})
        branched.do(lambda coming=coming, back=back, error=error: adopt_and_return(coming, back, error))
        branched.until(lambda coming=coming: branched.session.document == coming and not branched.engine.busy)


def test_a_world_that_cannot_be_read_again_is_named(branching: Callable[..., Branching]) -> None:
    class Window(dd.Arena):
        repeatable = False

    branched = branching(driving(), Window("blocks"))
    branched.step(14)
    before = bits(branched.session)
    with pytest.raises(RecordError, match="the world Window cannot be read again"):
        branched.branch(0)
    assert bits(branched.session) == before


def test_memory_is_bounded_and_a_moment_that_is_gone_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(branch_states, "SHARE", 1e9)
    session = dd.Session(mixed())
    branched = size(session.snapshot())
    assert branched > 0
    states = BranchStates(interval=0.0, most=6 * branched)
    for _ in range(40):
        states.follow(session)
        session.step(3)
        assert states.nbytes <= 6 * branched
    assert states.ticks[0] == 0 and len(states.ticks) >= 4, "thinned, from the start on"
    small = BranchStates(most=branched)
    small.follow(session)
    with pytest.raises(RecordError, match="a state of it takes"):
        small.branch(session, session.tick, lambda *_: None)
    with pytest.raises(RecordError, match="no state before it is kept"):
        BranchStates().branch(session, 0, lambda *_: None)


def test_an_error_while_a_moment_is_computed_leaves_the_present_state() -> None:
    session = dd.Session(mixed())
    states = BranchStates()
    states.follow(session)
    session.step(50)
    before = bits(session)

    def stop(done: int, steps: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        states.branch(session, 20, stop)
    assert bits(session) == before
    states.branch(session, 20, lambda *_: None)
    script = dd.Session(mixed())
    script.step(20)
    assert bits(session) == bits(script)


def test_progress_counts_the_steps() -> None:
    session = dd.Session(mixed())
    states = BranchStates()
    states.follow(session)
    session.step(5000)
    said: list[tuple[int, int]] = []
    states.branch(session, 4000, lambda *at: said.append(at))
    assert said[-1] == (4000, 4000) and len(said) > 2
    assert [done for done, _ in said] == sorted(done for done, _ in said)
    assert dc.asdict(session.snapshot().clock)["tick"] == 4000
