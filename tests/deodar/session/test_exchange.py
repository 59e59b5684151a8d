"""The times of the exchange between model and world: the rule of elements with a step of their own, for
all chunks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.elements.function import Function
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal, World

x = dd.Axis("x", 0, 4, samples=5)


class Tank(World):
    """A tank: in each period of 4 ms the level changes by 0.08 times the difference of flow and level."""

    sensors: Mapping[str, Signal] = {"level": Signal("level", (5,))}
    motors: Mapping[str, Signal] = {"flow": Signal("flow", (5,))}
    period = 4.0

    def __init__(self) -> None:
        self.acted: list[float] = []

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self.level, self.acted = np.zeros(5), []

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return self.level.copy()

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        self.acted.append(time)
        flow = motors["flow"][0] if "flow" in motors else np.zeros(5)
        self.level = self.level + 4.0 * 0.02 * (flow - self.level)

    def keep(self) -> Any:
        return self.level.copy()

    def put(self, kept: Any) -> None:
        self.level = kept


def closed(outside: bool, **options: Any) -> dd.Model:
    """Return a field that drives a tank and reads its level; the tank is a world, or an element that runs
    at every fourth step.
    """
    model = dd.Model("tank", **options)
    u = model.add(dd.Field("u", [x], tau=15, resting_level=1.0))
    if outside:
        u >> dd.Gain(2.0) >> model.add(Motor("pump", [x], "flow"))
        level = model.add(Sensor("level", [x], "level"))
    else:
        flow = model.add(
            Function("tank", [x], function="deodar.elements.function:leaky", values={"rate": 0.02}), ticks=4
        )
        u >> dd.Gain(2.0) >> flow
        level = flow
    level >> dd.Gain(-3.0) >> u
    model.add(dd.GaussianStimulus("s", [x], center=2, sigma=1, amplitude=4, windows=[(10, 60)])) >> u
    return model


@pytest.mark.parametrize("every", [1, 3])
def test_a_world_gives_the_run_of_an_element_with_the_same_period(every: int) -> None:
    """The rule: read at multiples of k, visible k ticks later.

    The same plant as a world and as an element gives the same run.
    """
    options: dict[str, Any] = dict(record=["u.activation"], every=every, precision="float64")
    world = Tank()
    outside = dd.simulate(closed(True), 120, world=world, **options)["u.activation"].values
    inside = dd.simulate(closed(False), 120, **options)["u.activation"].values
    np.testing.assert_allclose(outside, inside, atol=1e-12)
    assert np.abs(np.diff(inside, axis=0)).max() > 0.05
    assert world.acted == [4.0 * k for k in range(30)]


def test_a_run_in_a_world_is_independent_of_chunks_and_snapshots_restore_the_world() -> None:
    whole = dd.simulate(closed(True), 60, record=["u.activation"], world=Tank())["u.activation"].values
    s = dd.Session(closed(True), world=Tank())
    for n in (1, 2, 4, 3, 7, 1, 2):
        s.step(n)
        np.testing.assert_array_equal(s.read("u.activation"), whole[s.tick])
    snapshot = s.snapshot()
    s.step(13)
    s.restore(snapshot)
    for _ in range(12):
        np.testing.assert_array_equal(s.read("u.activation"), whole[s.tick])
        s.step()


def test_an_edit_inside_a_period_does_not_change_the_world() -> None:
    plain, edited = (dd.Session(closed(True), world=Tank()) for _ in range(2))
    for s in (plain, edited):
        s.step(10)
    model = dd.Model(document=edited.document)
    model.add(dd.Field("bystander", [x]))
    edited.edit(model.document)
    for s in (plain, edited):
        s.step(15)
    np.testing.assert_allclose(edited.read("u"), plain.read("u"), rtol=1e-6)


def test_periods_are_milliseconds_for_every_unit_of_the_document() -> None:
    for unit, dt in (("1 = 4 ms", 1.0), ("1 = 2 ms", 0.5), ("s", 0.004)):
        world = Tank()
        dd.simulate(closed(True, time_unit=unit), 20 * dt, dt=dt, record=["u.activation"], world=world)
        seconds = {"1 = 4 ms": 0.004, "1 = 2 ms": 0.002, "s": 1.0}[unit]
        np.testing.assert_allclose(world.acted, np.arange(round(20 * dt * seconds / 0.004)) * 4.0, atol=1e-9)
    with pytest.raises(dd.errors.TimeError, match="the world's period of 2 is not a multiple of dt = 3"):
        dd.Session(closed(True, time_unit="1 = 2 ms"), dt=3, world=Tank()).step()


def test_a_motor_without_a_world_runs_without_effect() -> None:
    model = dd.Model("loose")
    model.add(dd.GaussianStimulus("s", [x], center=2, sigma=1)) >> model.add(Motor("pump", [x], "flow"))
    record = dd.simulate(model, 5, record=["pump.output", "s.output"])
    np.testing.assert_array_equal(record["pump.output"].values, record["s.output"].values)


def test_axes_that_a_motor_does_not_have_are_refused() -> None:
    model = dd.Model("wrong")
    model.add(Motor("pump", [], "flow"))
    with pytest.raises(WorldError, match=r"pump: 'flow' has axes of 5 samples; the model gives it \[\]"):
        dd.Session(model, world=Tank())


class Each(Tank):
    """A tank for each copy."""

    sensors: Mapping[str, Signal] = {"level": Signal("level", (5,), each=True)}


def test_a_batch_of_a_world_with_readings_of_each_copy_is_refused() -> None:
    with pytest.raises(WorldError, match="level differ from copy to copy"):
        dd.simulate(closed(True), 8, trials=2, record="u.activation", world=Each())


def test_a_sensor_that_fails_once_is_read_again_and_the_world_does_not_act_twice() -> None:
    class Loose(Tank):
        failures = 0

        def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
            if self.failures:
                self.failures -= 1
                raise OSError("unplugged")
            return super().sense(sensor, axes, time)

    worlds = Tank(), Loose()
    steady, loose = (dd.Session(closed(outside=True), world=world) for world in worlds)
    steady.step(12)
    loose.step(7)
    worlds[1].failures = 2
    for _ in range(2):
        with pytest.raises(WorldError, match=r"unplugged"):
            loose.step(5)
        assert loose.tick == 8
    loose.step(4)
    assert worlds[1].acted == worlds[0].acted
    assert np.array_equal(loose.read("level.output"), steady.read("level.output"))
