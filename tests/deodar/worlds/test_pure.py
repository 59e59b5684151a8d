"""Worlds of pure functions: worlds of one structure share compiled functions."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.numerics.axes import Axis
from deodar.worlds import _pure
from deodar.worlds._base import Signal
from deodar.worlds._pure import PureWorld

LINE = (Axis("x", 0, 2, 3),)


class Counter(PureWorld):
    """A number that grows by a step, which is a constant of the program, from a start, which is an array."""

    period = 1.0
    sensors = {"count": Signal("how often", each=True)}
    motors = {}

    def __init__(self, step: float, start: float = 0.0) -> None:
        self.by, self.first = step, start

    def structure(self):
        return self.by

    def own(self, trials):
        return {"start": np.full(len(trials), self.first)}

    def start(self, shared, own):
        return own["start"]

    def advance(self, shared, own, state, motors):
        return state + self.by

    def read(self, shared, own, state, sensor, axes):
        return state


def compiled() -> int:
    return _pure._compiled.cache_info().misses


def counted(world: Counter, axes=(), copies: int = 1):
    world.reset(1, range(copies))
    world.act({}, 0.0)
    return world.sense("count", axes, 0.0).tolist()


def test_a_second_world_of_the_same_structure_compiles_nothing() -> None:
    assert counted(Counter(2.0)) == [2.0]
    before = compiled()
    assert counted(Counter(2.0, 5.0)) == [7.0]
    assert compiled() == before


def test_worlds_of_other_structure_or_axes_have_programs_of_their_own() -> None:
    assert (counted(Counter(2.0)), counted(Counter(3.0))) == ([2.0], [3.0])
    before = compiled()
    assert counted(Counter(3.0), LINE) == [[3.0, 3.0, 3.0]]
    assert compiled() == before + 1, "the sensor over other axes"


def test_a_change_of_a_world_does_not_affect_another_world() -> None:
    counter = Counter(4.0)
    assert counted(counter) == [4.0]
    counter.by = 9.0
    assert counted(counter) == [9.0]
    assert counted(Counter(4.0), copies=2) == [4.0, 4.0], (
        "another number of copies: traced again, from the stored copy"
    )


def test_several_sensors_are_read_by_one_compiled_function() -> None:
    world = Counter(5.0)
    counted(world)
    requests = [("count", ()), ("count", LINE)]
    before = compiled()
    seen = world.sense_all(requests, 0.0)
    assert compiled() == before + 1
    assert [reading.tolist() for reading in seen] == [[5.0], [[5.0, 5.0, 5.0]]]


def test_a_world_with_a_reading_of_its_own_is_read_by_it() -> None:
    class Doubled(Counter):
        def sense(self, sensor, axes, time):
            return 2 * super().sense(sensor, axes, time)

    world = Doubled(6.0)
    assert counted(world) == [12.0]
    assert [reading.tolist() for reading in world.sense_all([("count", ())] * 2, 0.0)] == [[12.0], [12.0]]


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_a_world_computes_in_the_precision_of_the_model(precision: str) -> None:
    world = Counter(1 / 3, 0.1)
    world.reset(1, (0,), precision)
    world.act({}, 0.0)
    seen = world.sense("count", (), 0.0)
    dtype = np.dtype(precision).type
    assert seen.dtype == dtype and seen == dtype(0.1) + dtype(1 / 3)


def test_one_compiled_function_advances_a_world_and_reads_its_sensors() -> None:
    world, apart = Counter(7.0), Counter(7.0)
    counted(world)
    counted(apart)
    requests = [("count", ()), ("count", LINE)]
    assert world.exchanges
    before = compiled()
    seen = world.exchange({}, requests)
    assert compiled() == before + 1
    apart.act({}, 1.0)
    assert [reading.tolist() for reading in seen] == [[14.0], [[14.0, 14.0, 14.0]]]
    assert [a.tolist() for a in apart.sense_all(requests, 2.0)] == [a.tolist() for a in seen]
    assert world.keep() == apart.keep()


def test_an_unknown_sensor_leaves_the_world_as_it_was() -> None:
    world = Counter(8.0)
    assert counted(world) == [8.0]
    with pytest.raises(WorldError, match="no sensor 'sum'"):
        world.exchange({}, [("count", ()), ("sum", ())])
    assert world.sense("count", (), 1.0).tolist() == [8.0]


def test_a_world_with_a_step_or_a_reading_of_its_own_keeps_it() -> None:
    class Doubled(Counter):
        def sense(self, sensor, axes, time):
            return 2 * super().sense(sensor, axes, time)

    class Twice(Counter):
        def act(self, motors, time):
            super().act(motors, time)
            super().act(motors, time)

    for kind in (Doubled, Twice):
        assert not kind(9.0).exchanges
        world = kind(0.25)
        session = dd.Session(watching(), world=world)
        session.step(4)
        assert session.read("s.output") == 2.0


def watching() -> dd.Model:
    model = dd.Model("watching")
    model.add(dd.Sensor("s", [], "count"))
    return model


class Slow(Counter):
    """A counter whose sensor has a new reading in every third period."""

    sensors = {
        "count": Signal("how often, in every third period", period=3.0, each=True),
        "now": Signal("how often", each=True),
    }

    def renews(self, state, sensor):
        return state % 3 == 0


def test_the_reading_of_a_sensor_with_a_period_of_its_own_is_held() -> None:
    world = Slow(1.0)
    world.reset(1, [0, 1])
    requests = [("count", ()), ("now", ())]
    seen, before = [], None
    for _ in range(7):
        before = world.exchange({}, requests, before)
        seen.append([reading.tolist() for reading in before])
    assert [count for count, _ in seen] == [[k] * 2 for k in (1, 1, 3, 3, 3, 6, 6)], "the first one is read"
    assert [now for _, now in seen] == [[k] * 2 for k in range(1, 8)]


def test_a_held_reading_is_the_same_inside_the_step() -> None:
    model = dd.Model("slow", dt=1)
    model.add(dd.Sensor("count", sensor="count"))
    model.add(dd.Sensor("now", sensor="now"))
    for inside in (True, False):
        world = Slow(1.0)
        world.inside = inside
        record = dd.simulate(model, 8, record=["count.output", "now.output"], every=1, world=world)
        assert record["count.output"].values.tolist() == [0, 0, 0, 3, 3, 3, 6, 6, 6]
        assert record["now.output"].values.tolist() == list(range(9))
