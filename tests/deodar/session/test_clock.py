"""Runs paced to the wall clock: lag, catching up, and steps that grow.

All tests but the last one use a simulated clock.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.elements.world_ports import Sensor
from deodar.errors import TimeError
from deodar.session.meter import Meter
from deodar.session.pace import EXCHANGE, MOST_LAG, Pace
from deodar.session.run_live import run_live
from deodar.worlds._base import Signal, World

X = dd.Axis("x", 0, 100, samples=51)


def session(every: int = 1, dt: float = 1.0, unit: str = "ms") -> dd.Session:
    model = dd.Model("m", time_unit=unit)
    u = model.add(dd.Field("u", [X], tau=20, kernel=[dd.Gaussian(1, 5)], noise=0.2))
    model.add(dd.Field("slow", [X], tau=100, noise=0.1), ticks=every)
    model.add(dd.GaussianStimulus("s", [X], center=50, amplitude=8)) >> u
    return dd.Session(model, dt=dt, seed=3)


class Wall:
    """A clock that advances in sleeps and steps; steps take the stated time."""

    def __init__(
        self, one: dd.Session, cost: float = 0.0, hiccups: dict[int, float] | None = None, drowsy: float = 0.0
    ) -> None:
        self.now, self.cost, self.hiccups, self.drowsy = 0.0, cost, hiccups or {}, drowsy
        self.session, self.bursts = one, [0]
        self.pace = Pace(lambda: self.now, self.sleep)

    def sleep(self, seconds: float) -> None:
        self.now += seconds + self.drowsy

    def live(self, duration: float, speed: float | None = 1.0, longest: float | None = None) -> Meter:
        """Run like `run_live`, with a step that takes `cost` seconds, and some that take longer."""
        step, took = self.session.step, self.pace.took

        def stepped(n: int = 1) -> None:
            step(n)
            self.bursts.append(n)
            self.now += n * self.cost
            for at in [t for t in self.hiccups if self.session.tick >= t]:
                self.now += self.hiccups.pop(at)

        def learnt(one: dd.Session, n: int, passed: float, seconds: float) -> None:
            took(one, n, passed, n * self.cost)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(self.session, "step", stepped)
            patch.setattr(self.pace, "took", learnt)
            return run_live(self.session, duration, speed, longest, pace=self.pace)


def test_with_enough_time_no_step_is_late_and_no_delay_accumulates() -> None:
    wall = Wall(session(), cost=0.0002, drowsy=0.0003)
    meter = wall.live(3000)
    assert wall.session.time == 3000 and meter.steps == 3000 and meter.time == 3000
    assert meter.drift < 1 and meter.worst < 1 and meter.overruns == 0 and meter.lost == 0
    assert meter.factor == pytest.approx(1, abs=1e-3) and wall.now == pytest.approx(3, abs=1e-3)
    assert not wall.session.journal


@pytest.mark.parametrize(
    ("speed", "unit", "dt", "seconds"),
    [(0.1, "ms", 1, 2.0), (4, "ms", 1, 0.05), (1, "1 = 64 ms", 1, 12.8), (2, "s", 0.5, 100.0)],
)
def test_slow_motion_fast_motion_and_other_units(speed: float, unit: str, dt: float, seconds: float) -> None:
    wall = Wall(session(dt=dt, unit=unit), cost=0.0001)
    meter = wall.live(200, speed)
    assert wall.now == pytest.approx(seconds, rel=1e-2) and meter.factor == pytest.approx(speed, rel=1e-2)
    assert meter.overruns == 0 and meter.lost == 0


def test_a_run_without_a_speed_never_waits_and_is_never_late() -> None:
    wall = Wall(session(), cost=0.0005)
    meter = wall.live(1000, None)
    assert (
        wall.now == pytest.approx(0.5)
        and meter.factor == pytest.approx(2)
        and meter.lag == meter.overruns == 0
    )


def test_the_cost_of_a_step_is_measured_again_for_a_new_program() -> None:
    wall = Wall(session(), cost=1e-7)
    wall.live(200_000, None)
    most = wall.pace.most(wall.session)
    assert most == pytest.approx(EXCHANGE / 1e-7, rel=1e-3)
    wall.session.edit(session(every=2).document)
    assert wall.pace.most(wall.session) == 1
    wall.pace.took(wall.session, 1, 1.0, 0.004)
    assert wall.pace.most(wall.session) == 2


def test_a_delay_is_one_overrun_and_is_caught_up_with_steps_of_dt() -> None:
    wall = Wall(session(), cost=0.0002, hiccups={500: 0.1})
    meter = wall.live(1000)
    assert meter.overruns == 1 and 95 < meter.worst < 101 and meter.lost == 0 and 100 < meter.longest < 160
    assert meter.drift < 1 and wall.now == pytest.approx(1, abs=1e-3) and meter.lengthened == 0
    assert max(wall.bursts) <= EXCHANGE / wall.cost + 1


def test_a_long_pause_is_skipped() -> None:
    wall = Wall(session(), cost=0.0002, hiccups={500: 3600.0})
    meter = wall.live(1000)
    assert meter.lost == pytest.approx(3.6e6 - 1e3 * MOST_LAG, rel=1e-3) and meter.overruns == 1
    assert max(wall.bursts) <= EXCHANGE / wall.cost + 1, "no unbounded burst"
    assert wall.now == pytest.approx(3601 - MOST_LAG, abs=0.01) and meter.drift == pytest.approx(
        meter.lost, abs=1
    )


def test_the_meter_reports_the_lag_of_a_machine_that_is_too_slow() -> None:
    wall = Wall(session(), cost=0.002)
    meter = wall.live(2000)
    assert meter.factor == pytest.approx(0.5, rel=0.01) and meter.drift == pytest.approx(2000, rel=0.02)
    assert meter.lag <= 1e3 * MOST_LAG + 11 and meter.lost == pytest.approx(meter.drift - meter.lag)
    assert meter.overruns == 1 and meter.longest > 1900 and meter.lengthened == 0
    assert not wall.session.journal, "steps stay what they are"
    text = str(meter)
    assert text.startswith("0.") and "1 overrun," in text and "given up" in text


@pytest.mark.parametrize("every", [1, 3])
def test_a_step_that_may_grow_keeps_up_and_the_journal_repeats_the_run(every: int) -> None:
    one = session(every)
    wall = Wall(one, cost=0.0023)
    meter = wall.live(3000, longest=5)
    assert one.time == 3000 and meter.time == 3000 and meter.factor == pytest.approx(1, rel=0.02)
    assert meter.lengthened > 500 and 3 <= meter.step <= 5 and meter.lost == 0
    assert one.dt == one.next_dt == 1, "planned again at the end"
    changes = [c for c in one.journal if c.method == "dt"]
    assert changes and all(dt == round(dt) and 1 <= dt <= 5 for c in changes for dt in c.arguments)

    second = session(every)
    for change in changes:
        second.step(change.tick - second.tick)
        change.repeat(second)
    second.step(one.tick - second.tick)
    assert second.time == one.time
    np.testing.assert_array_equal(second.read("u.activation"), one.read("u.activation"))
    np.testing.assert_array_equal(second.read("slow.activation"), one.read("slow.activation"))


def test_a_step_at_its_bound_does_not_grow_and_the_run_is_late() -> None:
    wall = Wall(session(), cost=0.008)
    meter = wall.live(2000, longest=4)
    assert meter.step == 4 and meter.factor == pytest.approx(0.5, rel=0.05) and meter.lost > 500


def test_a_lengthened_step_returns_to_dt_when_there_is_time() -> None:
    wall = Wall(session(), cost=0.0025, hiccups={300: 0.0})
    first = wall.live(600, longest=10)
    wall.cost = 0.0001
    second = wall.live(2000, longest=10)
    assert first.lengthened > 100 and second.lengthened < 600 and second.drift < 5
    assert wall.session.journal[-1].arguments == (1,)


class Told(World):
    """A world with one sensor that reads the time, every 12 ms."""

    sensors: Mapping[str, Signal] = {"time": Signal("the time", ())}
    period = 12.0

    def __init__(self) -> None:
        self.read: list[float] = []

    def sense(self, sensor: str, axes: Any, time: float) -> np.ndarray:
        self.read.append(time)
        return np.asarray(time)


def test_a_world_is_read_at_its_period_for_every_step() -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [], tau=50))
    model.add(Sensor("eye", [], sensor="time")) >> u
    world = Told()
    session = dd.Session(model, world=world)
    wall = Wall(session, cost=0.0025)
    meter = wall.live(3000, longest=5)
    assert {dt for c in session.journal for dt in c.arguments} <= {1, 2, 3, 4}, (
        "five steps do not fit into the period"
    )
    assert meter.lengthened > 500 and session.time == 3000
    gaps = np.diff(world.read)
    assert gaps.min() >= 12 and gaps.max() < 12 + 4 and np.median(gaps) == 12


def test_the_function_between_may_set_values_and_end_the_run() -> None:
    one = session()
    seen: list[float] = []

    def between() -> None:
        seen.append(one.time)
        one.set("s.amplitude", len(seen))
        if len(seen) == 20:
            raise StopIteration

    with pytest.raises(StopIteration):
        one.run_live(10_000, speed=2, between=between, between_every=0)
    assert len(seen) == 20 and one.get("s.amplitude") == 20 and one.time == seen[-1] < 10_000


@pytest.mark.parametrize(
    ("every", "takes", "calls"),
    [
        (50, 0.0, [1, 51, 101, 151, 200]),
        (0, 0.0, [*range(1, 201)]),
        (50, 0.02, [1, 81, 161, 200]),  # a slow function gets a quarter of the time
    ],
)
def test_the_function_between_is_called_at_a_rate_and_at_the_end(
    every: float, takes: float, calls: list[int]
) -> None:
    live, clock, seen = session(), [0.0], list[float]()

    def sleep(seconds: float) -> None:
        clock[0] += seconds

    def between() -> None:
        seen.append(live.time)
        clock[0] += takes

    run_live(live, 200, between=between, between_every=every, pace=Pace(lambda: clock[0], sleep))
    assert len(seen) == len(calls) and np.abs(np.array(seen) - calls).max() <= 1000 * takes + 2


@pytest.mark.parametrize(
    ("how", "says"),
    [
        ({"speed": 0}, "above 0"),
        ({"speed": "fast"}, "above 0"),
        ({"longest_step": 0.5}, "not below the planned step of 1"),
        ({"longest_step": 30}, "longer than the time constant tau = 20"),
        ({"between_every": -1}, "between_every is -1; expected a number of ms"),
        ({"duration": 10.5}, "not a multiple"),
        ({"duration": -1}, "0 or above"),
    ],
)
def test_invalid_arguments_of_run_live_are_refused_before_the_run(how: dict[str, float], says: str) -> None:
    one = session()
    with pytest.raises(TimeError, match=says):
        one.run_live(**({"duration": 10} | how))
    assert one.tick == 0 and not one.journal


def test_a_live_run_follows_the_wall_clock() -> None:
    """Half a second on a machine that may be busy; benchmarks/clock.py measures exact figures."""
    one = session()
    meter = one.run_live(500)
    assert one.time == 500 and meter.steps == 500
    assert 0.5 <= meter.wall < 5 and meter.drift == pytest.approx(1e3 * meter.wall - 500, abs=2)
    script = session()
    script.step(500)
    np.testing.assert_array_equal(one.read("u.activation"), script.read("u.activation"))
