"""Trials: their ends, their actions, and equal results for equal arguments."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ParameterError, TimeError, WorldError
from deodar.experiments.actions import Move, Place, Remove, Set
from deodar.experiments.events import Crosses, Leaves, Within
from deodar.experiments.trial_samples import Stops
from tests.deodar.experiments.calls import run_alone
from tests.deodar.experiments.robots import decider, room, straight

GOAL = Within("reached", 7.0)
TOUCH = Crosses("touched", "touching", 0.5)


def test_a_goal_that_is_reached_ends_the_trial():
    course = run_alone(straight(), 500, room(), events=[GOAL, TOUCH], watch=["pose"])
    assert course.outcome == "reached" and course.events == {"reached": course.times[-1], "touched": None}
    last, before = course.values["pose"][-1], course.values["pose"][-2]
    assert np.hypot(last[0] - 80, last[1] - 20) <= 7 < np.hypot(before[0] - 80, before[1] - 20)
    # 500 steps/s are 6.44 cm/s, 0.412 cm a step; the wheels turn from the second exchange on
    np.testing.assert_allclose(
        np.diff(course.values["pose"][:, 0])[1:], 500 * 2 * np.pi * 2.05 / 1000 * 0.064, rtol=1e-4
    )


def test_an_event_may_require_several_samples_and_need_not_end_the_trial():
    once = run_alone(straight(), 500, room(), events=[GOAL]).times[-1]
    course = run_alone(
        straight(),
        300,
        room(),
        events=[Within("reached", 7.0, times=10, ends=False), Leaves("moved", 2.5), TOUCH],
    )
    assert course.events["reached"] == once + 9
    assert course.events["moved"] == pytest.approx(np.ceil(2.5 / 0.4122), abs=1)
    assert course.outcome == "touched" and course.events["touched"] > course.events["reached"]


def test_trials_run_on_to_the_last_of_several_samples_and_to_the_limit():
    stops = Stops(10, 85, looks=3)
    assert [stops.after(tick, []) for tick in (0, 25, 40, 60, 80)] == [30, 50, 70, 80, 85]


def test_the_limit_ends_a_trial_without_another_end():
    course = run_alone(straight(0.0), 20, room(), events=[GOAL], every=5)
    assert course.outcome == "time" and course.duration == 20
    np.testing.assert_array_equal(course.times, [0, 5, 10, 15, 20])


def test_a_port_that_crosses_a_value_ends_a_trial_without_a_world():
    course = run_alone(
        decider(), 5000, watch=["u.activation"], events=[Crosses("decided", "u.activation")], trial=3
    )
    u = course.values["u.activation"]
    assert course.outcome == "decided" and u[-1] > 0 and (u[:-1] <= 0).all()
    whole = dd.simulate(decider(), course.duration, trials=[3], record="u.activation")["u.activation"].values[
        0
    ]
    np.testing.assert_allclose(u, whole, atol=1e-5)


def test_the_first_sample_may_end_a_trial():
    assert run_alone(straight(), 100, room(goal=(12, 20)), events=[GOAL]).duration == 0


def test_an_object_that_appears_stops_the_robot_until_it_is_removed():
    placed = Place(60, "box", (50, 20), (4, 30))
    world = room()
    course = run_alone(straight(), 250, world, events=[TOUCH], actions=[placed], watch=["pose"])
    assert course.outcome == "touched" and course.values["pose"][-1, 0] == pytest.approx(
        50 - 2 - 3.7, abs=0.05
    )
    through = run_alone(
        straight(), 500, world, events=[GOAL], actions=[placed, Remove(200, "box")], watch=["pose"]
    )
    assert through.outcome == "reached" and (np.diff(through.values["pose"][:, 0]) < 1e-3).sum() > 50
    trial = run_alone(straight(), 500, world, events=[GOAL], actions=[placed, Move(100.0, "box", (50, -60))])
    assert trial.duration == through.duration - 100
    # the box was removed after each trial
    assert run_alone(straight(), 500, world, events=[GOAL]).outcome == "reached"


def test_a_moved_goal_is_restored_after_the_trial():
    world = room()
    early = run_alone(straight(), 500, world, events=[GOAL]).duration
    assert (
        run_alone(straight(), 500, world, events=[GOAL], actions=[Move(10, "goal", (50, 20))]).duration
        < early - 50
    )
    assert run_alone(straight(), 500, world, events=[GOAL]).duration == early


def test_an_action_between_two_samples_has_its_own_time():
    often, seldom = (
        run_alone(
            straight(),
            120,
            room(),
            actions=[Place(61, "box", (50, 20), (4, 30))],
            watch=["pose"],
            every=every,
        )
        for every in (1, 40)
    )
    np.testing.assert_array_equal(often.values["pose"][::40], seldom.values["pose"])


def test_a_parameter_is_set_at_a_time():
    course = run_alone(
        straight(),
        60,
        room(),
        actions=[Set(30, "go left.amplitude", 0.0), Set(30, "go right.amplitude", 0.0)],
        watch=["pose"],
    )
    x = course.values["pose"][:, 0]
    assert x[30] > x[29] > x[1] and (x[30:] == x[30]).all()


@pytest.mark.parametrize("t0", [0, 100])
def test_an_action_has_a_document_time_from_any_start(t0):
    model = dd.Model("late")
    model.add(dd.Field("n", []))
    model.add(dd.Boost("b", [], amplitude=0.0)) >> model["n"]
    model.describe(t0=t0)
    course = run_alone(model, 20, actions=[Set(t0 + 12, "b.amplitude", 5.0)], watch=["n.input"])
    np.testing.assert_array_equal(course.times, t0 + np.arange(21))
    # the sample at the time of an action is taken before it
    np.testing.assert_array_equal(course.values["n.input"], 5.0 * (np.arange(21) > 12))


def test_a_trial_does_not_depend_on_earlier_trials():
    world = room(slip=0.3, place_noise=0.5, start=[(10, 15, 0), (10, 25, 0.2)])
    options = {"limit": 80, "world": world, "watch": ["pose", "place"], "seed": 4}
    first = run_alone(straight(), trial=1, **options)
    other = run_alone(straight(), trial=0, **options)
    second = run_alone(straight(), trial=1, **options)
    assert [round(float(c.values["pose"][0, 1]), 4) for c in (first, other)] == [25, 15]
    np.testing.assert_array_equal(first.values["place"], second.values["place"])
    assert not np.array_equal(first.values["place"], other.values["place"])


def test_invalid_trials_are_refused():
    with pytest.raises(WorldError, match="the action Remove needs a world, and none is given"):
        run_alone(decider(), 10, actions=[Remove(3, "box")])
    with pytest.raises(ParameterError, match="name of two events"):
        run_alone(straight(), 10, room(), events=[GOAL, GOAL])
    with pytest.raises(ParameterError, match="reduce: is 'uper'; expected one of max"):
        Crosses("late", "u.activation", reduce="uper")
    with pytest.raises(ParameterError, match="sampled over axes that a model states"):
        run_alone(straight(), 10, room(), watch=["above"])
    with pytest.raises(TimeError, match=r"time of an action of 1\.5"):
        run_alone(straight(), 10, room(), actions=[Remove(1.5, "far")])
    with pytest.raises(TimeError, match="every is 0"):
        run_alone(straight(), 10, room(), every=0)


class Shelf(dd.World):
    """A world of objects without positions, with a sensor of their number."""

    sensors = {"things": dd.Signal("how many things there are", shape=())}
    period = 1.0

    def __init__(self) -> None:
        self.things = {"cup"}

    def sense(self, sensor: str, axes: dd.Axes, time: float) -> np.ndarray:
        return np.asarray(float(len(self.things)))

    def place(self, name, center, size, color=(0, 0, 0)) -> None:
        self.things.add(name)

    def remove(self, name: str) -> None:
        self.things.remove(name)

    def arrangement(self) -> set[str]:
        return set(self.things)

    def arrange(self, kept: set[str]) -> None:
        self.things = kept


def test_actions_change_any_world_that_has_their_methods():
    world = Shelf()
    options = {
        "actions": [Place(2, "plate", (0, 0), (1, 1)), Remove(4, "cup"), Remove(6, "plate")],
        "watch": ["things"],
    }
    # both trials start with the same objects; at the time of an action the sample is taken first
    for _ in range(2):
        assert run_alone(decider(), 8, world, **options).values["things"].tolist() == [
            1,
            1,
            1,
            2,
            2,
            1,
            1,
            0,
            0,
        ]
    assert world.things == {"cup"}


class Fixed(Shelf):
    """The same world without `arrangement`."""

    arrangement = dd.World.arrangement


@pytest.mark.parametrize(
    ("world", "action", "method"),
    [
        (
            Shelf(),
            Move(3, "cup", (0, 0)),
            "the action Move calls World.move, which the world Shelf does not have",
        ),
        (
            Fixed(),
            Remove(3, "cup"),
            (
                "the action Remove needs World.arrangement, to restore objects after a trial, which the world"
                " Fixed does not have"
            ),
        ),
        (
            dd.Picture(np.zeros((2, 2, 3))),
            Remove(3, "cup"),
            "the action Remove calls World.remove, which the world Picture does not have",
        ),
    ],
    ids=["no move", "no way back", "a picture"],
)
def test_an_action_refuses_a_world_without_its_method(world: dd.World, action: dd.Action, method: str):
    with pytest.raises(WorldError, match=method):
        run_alone(decider(), 10, world, actions=[action])


def test_a_height_needs_a_world_whose_objects_have_one():
    tall = Place(3, "plate", (0, 0), (1, 1), height=7.0)
    says = r"the action Place has a height, and Shelf\.place has no argument 'height'\. Leave height out"
    with pytest.raises(WorldError, match=says):
        run_alone(decider(), 10, Shelf(), actions=[tall])
    with pytest.raises(ParameterError, match=r"Place\.height: is 0; expected a number above 0"):
        Place(3, "plate", (0, 0), (1, 1), height=0.0)
    written = dd.Experiment("tall", decider(), dd.TrialPlan(10, actions=[tall]), world=room()).to_data()[
        "actions"
    ]
    assert written[0]["height"] == 7.0


def test_an_experiment_refuses_an_action_that_its_world_cannot_do():
    (problem,) = dd.Experiment(
        "none", decider(), dd.TrialPlan(10, actions=[Move(3, "cup", (0, 0))]), world=Shelf()
    ).check()
    assert (problem.where, problem.what) == (
        "actions.0",
        "the action Move calls World.move, which the world Shelf does not have",
    )
