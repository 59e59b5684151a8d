"""A robot rests when the run pauses: the engine halts its world once, after the last step."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest

import deodar as dd
from deodar.worlds._base import Signal, World
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
