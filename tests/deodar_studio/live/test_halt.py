"""A robot rests when the run pauses: the engine halts its world once, after the last step."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.worlds._base import Signal, World
from deodar.worlds._link_state import LinkState
from deodar_studio.live.engine import Engine


class Halting(World):
    """A world that counts how often it is moved, and notes at which number it was halted."""

    sensors = {}
    motors = {"speed": Signal("speed", (), "rad/s")}
    period = 10.0
    stands_in = False

    def __init__(self) -> None:
        self.moved = 0
        self.halts: list[int] = []

    def reset(self, seed, trials=(0,), precision="float32") -> None:
        self.moved = 0

    def act(self, motors, time) -> None:
        self.moved += 1
        if float(motors["speed"][0]) > 5:
            raise RuntimeError("too fast")

    def halt(self) -> None:
        self.halts.append(self.moved)


@pytest.fixture
def engine() -> Iterator[Engine]:
    made = Engine(lambda: None)
    yield made
    made.close()


def running(engine: Engine, world: World) -> dd.Model:
    """Load a model that drives the world, and wait until it moves."""
    model = dd.Model("turning", dt=10)
    model.add(dd.Boost("go", amplitude=1.0)) >> model.add(dd.Motor("turn", motor="speed"))
    do(engine, lambda: engine.load(dd.Session(model, world=world)))
    do(engine, lambda: engine.play(True))
    return model


def do(engine: Engine, function: Callable[[], object]) -> object:
    return engine.call(function).result(60)


def until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.01)


def test_a_pause_halts_the_world_once_and_nothing_moves_it_after(engine: Engine):
    world = Halting()
    running(engine, world)
    until(lambda: world.moved > 5)
    assert world.halts == []
    do(engine, lambda: engine.play(False))
    until(lambda: len(world.halts) == 1)
    time.sleep(0.1)
    assert world.halts == [world.moved]


def test_the_last_of_some_steps_halts_the_world(engine: Engine):
    world = Halting()
    running(engine, world)
    do(engine, lambda: engine.step(30))
    until(lambda: len(world.halts) == 1)
    do(engine, lambda: engine.step(5))
    until(lambda: len(world.halts) == 2)


@pytest.mark.parametrize("ended", ["another session", "another world", "the end"])
def test_a_world_that_is_left_is_halted(engine: Engine, ended: str):
    world = Halting()
    model = running(engine, world)
    until(lambda: world.moved > 5)
    if ended == "another session":
        do(engine, lambda: engine.load(dd.Session(model)))
    elif ended == "another world":
        do(engine, lambda: engine.see(Halting()))
    else:
        engine.close()
    assert len(world.halts) == 1


def test_a_run_that_fails_halts_the_world(engine: Engine):
    world = Halting()
    model = running(engine, world)
    until(lambda: world.moved > 5)
    model.set("go.amplitude", 9.0)
    do(engine, lambda: engine.adopt(model, model.document))
    until(lambda: bool(engine.failure[0]))
    until(lambda: len(world.halts) == 1)


class Linked(Halting):
    """A robot in another process, which may refuse to begin."""

    def __init__(self, robot: str, events: list[str], refuses: bool = False) -> None:
        super().__init__()
        self.robot, self.events, self.refuses = robot, events, refuses

    def reset(self, seed, trials=(0,), precision="float32") -> None:
        if self.refuses:
            raise WorldError("is commanded by another")
        self.events.append(f"begin {self.robot}")
        super().reset(seed, trials, precision)

    def link(self) -> LinkState:
        return LinkState(self.robot, 0, 0, 0, 0, 0)

    def close(self) -> None:
        self.events.append(f"close {self.robot}")


def test_a_robot_that_refuses_leaves_the_robot_in_use(engine: Engine):
    events: list[str] = []
    world = Linked("first", events)
    running(engine, world)
    until(lambda: world.moved > 5)
    with pytest.raises(WorldError, match="commanded by another"):
        do(engine, lambda: engine.see(Linked("second", [], refuses=True)))
    moved = world.moved
    until(lambda: world.moved > moved + 5)
    assert events == ["begin first"] and engine.session is not None and engine.session.world is world


@pytest.mark.parametrize(
    ("robot", "expected"),
    [("second", ["begin second", "close first"]), ("first", ["close first", "begin first"])],
)
def test_a_robot_is_left_for_another_or_for_another_link_with_it(engine: Engine, robot, expected):
    events: list[str] = []
    running(engine, Linked("first", events))
    do(engine, lambda: engine.see(Linked(robot, events)))
    assert events == ["begin first", *expected]


@pytest.mark.parametrize("ended", [False, True])
def test_the_next_document_leaves_the_robot_unless_it_moves_it(engine: Engine, ended: bool):
    events: list[str] = []
    world = Linked("first", events)
    model = running(engine, world)
    for coming, expected in [(world, []), (Halting(), ["close first"]), (Halting(), ["close first"])]:
        if ended:
            do(engine, lambda: engine.load(None))
        do(engine, lambda coming=coming: engine.load(dd.Session(model, world=coming), leave=True))
        assert [event for event in events if event.startswith("close")] == expected


def test_a_session_that_may_return_keeps_its_robot(engine: Engine):
    events: list[str] = []
    model = running(engine, Linked("first", events))
    do(engine, lambda: engine.load(dd.Session(model, world=Halting())))
    assert events == ["begin first"]
