"""Actions on the trials of a batch: each trial equals one that `run_alone` runs alone."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DeodarError, ParameterError, RunWarning, WorldError
from deodar.experiments.actions import (
    Action,
    End,
    Move,
    Place,
    Push,
    Ramp,
    Record,
    Remove,
    Reset,
    Set,
    Snapshot,
    require,
)
from deodar.experiments.events import Appears, Crosses, Event, Reached
from deodar.experiments.measures import Measure
from deodar.experiments.trial import Trial
from tests.deodar.experiments.calls import changed, run_alone, run_together
from tests.deodar.experiments.robots import ROOM, straight

PROGRAMS: dict[Any, Any] = {}
"""Compiled programs, which all models of this file share."""

UP = Crosses("up", "u.activation", 0.0, ends=False)
SEEN = Appears("seen", "f", threshold=0.0, ends=False)


def noisy() -> dd.Model:
    """Return a node that noise drives over its threshold, a field that it excites, and a shared parameter."""
    model = dd.Model("noisy")
    model.programs = PROGRAMS
    model.parameter("mode", 0.0)
    u = model.add(dd.Field("u", [], tau=20, resting_level=-0.5, noise=3.0))
    f = model.add(dd.Field("f", [dd.Axis("x", 0, 10, 11)], tau=10, resting_level=-2, noise=0.5))
    model.add(dd.Boost("b", [], amplitude=0.0)) >> u
    model.link("b.amplitude", "mode")
    u >> dd.Gain(4.0) >> f
    return model


def requires_equal(
    model: dd.Model,
    actions: Sequence[Action],
    events: Sequence[Event],
    watch: Sequence[str],
    limit: float = 120,
    precision: str = "float64",
    **options: Any,
) -> list[Trial]:
    """Require that a batch of four equals four single trials, and return the batch."""
    options |= {"watch": watch, "events": events, "actions": actions, "precision": precision, "seed": 3}
    many = run_together(model, limit, [4, 0, 3, 1], **options)
    tolerance = {"rtol": 0, "atol": 1e-10 if precision == "float64" else 1e-4}
    for number, trial in zip([4, 0, 3, 1], many, strict=True):
        alone = run_alone(model, limit, trial=number, **options)
        assert (trial.outcome, trial.events) == (alone.outcome, alone.events)
        np.testing.assert_array_equal(trial.times, alone.times)
        np.testing.assert_array_equal(trial.recorded, alone.recorded)
        for name in watch:
            np.testing.assert_allclose(trial.values[name], alone.values[name], **tolerance)
        for name, measure in alone.measures.items():
            numbers = [float("nan") if v is None else v for v in (trial.measures[name], measure)]
            np.testing.assert_allclose(*numbers, **tolerance)
        assert list(trial.snapshots) == list(alone.snapshots)
        for label, (moment, ports) in alone.snapshots.items():
            at, values = trial.snapshots[label]
            assert at == moment
            for path, measure in ports.items():
                np.testing.assert_allclose(values[path], measure, **tolerance)
    return many


@pytest.mark.parametrize(
    "actions",
    [
        [Set(31, "u.resting_level", 2.0), Set(7, "f.resting_level", -1.0, when="up")],
        [Set(31, "mode", 2.0), Set(5, "mode", -3.0, when="up")],
        [Ramp(31, "u.resting_level", 1.0, 20), Ramp(3, "f.resting_level", 1.0, 12, start=-3.0, when="up")],
        [Push(31, "f", 6.0, 13), Push(4, "f", -9.0, 8, when="up"), Push(20, "u", -9.0, 30, when="up")],
        [Record(31, False), Record(52), Record(6, False, when="up")],
        [Snapshot(31, "then", ["u", "f.output"]), Snapshot(3, "after", ["f"], when="up")],
        [Reset(31), Reset(4, when="up"), Set(31, "u.tau", 15.0)],
        [End(63, "late"), End(17, "early", when="up")],
        [
            Set([10, 25, 0, 31, 42], "u.resting_level", 1.0),
            Push([50, 61, 0, 47, 33], "f", 6.0, 13),
            Snapshot([3, 4, 5, 6, 7], "after", ["f"], when="up"),
        ],
    ],
    ids=["Set", "Set shared", "Ramp", "Push", "Record", "Snapshot", "Reset", "End", "times of each trial"],
)
def test_each_action_on_a_batch_gives_the_trials_that_run_alone(actions: list[Action]) -> None:
    """At a time between two samples, and after an event that the trials have at different times."""
    measures = [Measure("last", "f.activation", "max"), Measure("then", "u.activation", "max", when="up")]
    many = requires_equal(noisy(), actions, [UP, SEEN], ["u", "f.output"], every=4, measures=measures)
    assert len({trial.events["up"] for trial in many}) > 2
    free = run_together(noisy(), 120, [4], ["u", "f"], [UP, SEEN], seed=3, every=4, precision="float64")[0]
    assert free.duration == 120 and not free.snapshots and len(free.recorded) == 31


def test_actions_on_a_batch_give_equal_trials_in_single_precision() -> None:
    actions = [
        Set(10, "u.resting_level", -0.5),
        Push(2, "f", 3.0, 10, when="up"),
        Reset(40, when="up"),
        Ramp(60, "u.resting_level", -3.0, 10),
    ]
    requires_equal(noisy(), actions, [UP], ["u", "f"], precision="float32")


def test_trials_may_differ_in_the_parameter_that_an_action_sets() -> None:
    actions, levels = [Ramp(20, "mode", 5.0, 10), Set(90, "u.tau", 30.0)], [0.0, 1.0, 2.0, -1.0]
    options: dict[str, Any] = {"watch": ["u"], "actions": actions, "precision": "float64", "seed": 3}
    many = run_together(
        noisy(), 120, range(4), values={"mode": levels, "u.resting_level": [-1, -2, 0, 1]}, **options
    )
    for k, trial in enumerate(many):
        model = noisy()
        model.set({"mode": levels[k], "u.resting_level": [-1, -2, 0, 1][k]})
        alone = run_alone(model, 120, trial=k, **options)
        np.testing.assert_allclose(trial.values["u"], alone.values["u"], atol=1e-10)


def learner() -> dd.Model:
    """Return two fields, and an element of each kind that learns; one has a step of its own."""
    model = dd.Model("learner")
    model.programs = PROGRAMS
    x = dd.Axis("x", 0, 10, 11)
    u = model.add(dd.Field("u", [x], tau=10, resting_level=-1, noise=0.5))
    v = model.add(dd.Field("v", [x], tau=10, resting_level=-1, noise=0.5))
    for name, field in (("a", u), ("b", v)):
        model.add(dd.GaussianStimulus(name, [x], center=5, sigma=2, amplitude=3)) >> field
    u >> model.add(dd.MemoryTrace("trace", [x], tau_build=30, tau_decay=300))
    model.set_ticks("trace", 3)
    for kind, name in ((dd.AdaptiveWeights, "adaptive"), (dd.Hebbian, "hebbian")):
        weights = model.add(kind([x], rate=0.02, name=name))
        u >> weights
        model.connect(v, f"{name}.post")
    u >> model.add(dd.GainAdaptation(tau=50, initial=0.5, name="gains"))
    model.connect(v, "gains.error")
    return model


LEARNED = ["trace.output", "hebbian.weights"]


@pytest.mark.parametrize("keep_learned", [True, False])
def test_what_was_learned_starts_the_next_phase(keep_learned: bool) -> None:
    """Fields start again; weights, gains and traces stay, or start again as well."""
    ports = ["u", "v", *LEARNED]
    actions = [
        Snapshot(40, "before", ports),
        Reset(40, keep_learned=keep_learned),
        Snapshot(40, "after", ports),
        Reset(3, when="up", keep_learned=keep_learned),
    ]
    up = Crosses("up", "trace.output", 0.8, ends=False)
    watch = ["u", "gains.output", "adaptive.output", *LEARNED]
    many = requires_equal(learner(), actions, [up], watch, every=5)
    for trial in many:
        before, after = (trial.snapshots[name][1] for name in ("before", "after"))
        np.testing.assert_array_equal(after["u"], np.full(11, -1.0))
        for name in LEARNED:
            assert np.abs(before[name]).max() > 0.05
            np.testing.assert_array_equal(after[name], before[name] if keep_learned else 0 * before[name])
        assert trial.events["up"] is not None


def test_a_trial_that_diverges_by_an_action_leaves_the_others() -> None:
    """At other times in two of the trials; in the others the action is never due."""
    model = dd.Model("runaway")
    u = model.add(dd.Field("u", [], tau=10, sigmoid=dd.Logistic(beta=1), resting_level=1.0, noise=0.1))
    u["activation"] >> model.add(dd.Gain(0.1, name="g")) >> u
    options: dict[str, Any] = {"watch": ["u"], "tolerant": True, "precision": "float64", "every": 2}
    actions = [Set([200, 21, 200, 34], "g.factor", 1e6), Snapshot(30, "then", ["u"])]
    many = run_together(model, 200, range(4), actions=actions, **options)
    for k, trial in enumerate(many):
        alone = run_alone(model, 200, trial=k, actions=actions, **options)
        assert trial.outcome == alone.outcome == ("diverged" if k % 2 else "time")
        np.testing.assert_array_equal(trial.times, alone.times)
        np.testing.assert_allclose(trial.values["u"], alone.values["u"], atol=1e-10)
        assert str(trial.error) == str(alone.error) and list(trial.snapshots) == list(alone.snapshots)


def test_an_action_with_a_time_for_each_trial_is_part_of_the_file_and_needs_enough_times() -> None:
    several = [Set([10, 20, 30], "u.resting_level", 1.0), Push([5, 6, 7], "u", 1.0, 5)]
    experiment = dd.Experiment("schedules", noisy(), dd.TrialPlan(60, actions=several), 3)
    plain = experiment.to_data()
    assert plain["actions"][0]["at"] == [10, 20, 30]
    assert dd.Experiment.from_data({**plain, "model": "m.json"}).plan.actions == experiment.plan.actions
    assert not experiment.check() and experiment.setup().batched
    (problem,) = changed(experiment, trials=4, actions=several[:1]).check()
    assert (problem.where, problem.what) == ("actions.0: Set.at", "there are 3 times, and trial 3 is run")
    (problem,) = changed(experiment, actions=[Set([10, 61, 3], "u.tau", 10.0)]).check()
    assert problem.what.startswith("is never done: it is due at 61")
    for run in (
        lambda: run_together(noisy(), 60, [3], actions=several),
        lambda: run_alone(noisy(), 60, trial=3, actions=several),
    ):
        with pytest.raises(ParameterError, match="there are 3 times, and trial 3 is run"):
            run()


# ------------------------------------------------------------------------------------------------- in a world


def robot() -> dd.Model:
    """Return a robot that drives straight on, with sensors of its position and of the arena."""
    model = straight(600.0)
    model.programs = PROGRAMS
    model.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    model.add(dd.Sensor("touching", [], sensor="touching"))
    plane = [dd.Axis("x", 0, 100, 26, unit="cm"), dd.Axis("y", 0, 40, 11, unit="cm")]
    model.add(dd.Sensor("map", plane, sensor="obstacles"))
    model.add(dd.Sensor("goal", [dd.Axis("of", 0, 1, 2)], sensor="goal"))
    return model


def rooms(**options: Any) -> dd.Arena:
    """Return an arena with another object in each of five trials."""
    layouts = [
        {**ROOM, "blocks": [{"name": "own", "center": [30 + 5 * k, 20], "size": [4, 4]}], "start": [8, 20]}
        for k in range(5)
    ]
    return dd.Arena(layouts, unit="cm", goal=(80, 8), noise=dd.ArenaNoise(slip=0.2), **options)


FAR = Crosses("far", "pose.output", 24, ends=False)
TOUCHED = Crosses("touched", "touching.output", 0.5, ends=False)
WATCH = ["pose.output", "map.output", "goal.output"]


@pytest.mark.parametrize(
    "actions",
    [
        [Place(31, "box", (60, 10), (4, 9)), Place(9, "own", (20, 33), (6, 6), when="touched")],
        [
            Move(31, "far", (97, 5)),
            Move(7, "goal", (50, 30), when="far"),
            Move(9, "own", (9, 36), when="far"),
        ],
        [Remove([31, 12, 20, 30, 25], "far"), Remove(12, "own", when="touched")],
        [
            Place(20, "box", (60, 10), (4, 9)),
            Reset(20),
            Remove(30, "box"),
            Set(40, "go left.amplitude", 300.0),
        ],
    ],
    ids=["Place", "Move", "Remove", "mixed"],
)
def test_objects_are_changed_in_the_arena_of_each_trial(actions: list[Action]) -> None:
    world = rooms()
    before = world.describe()
    many = requires_equal(robot(), actions, [FAR, TOUCHED], WATCH, world=world, every=2)
    assert world.describe() == before
    assert len({(trial.events["touched"], trial.events["far"]) for trial in many}) > 2


@pytest.mark.parametrize("alone", [True, False], ids=["alone", "batch"])
def test_a_block_that_is_put_onto_another_one_during_a_run_is_named(alone: bool) -> None:
    red: dict[str, Any] = {"name": "red", "center": [40, 20], "size": [4, 4]}
    green: dict[str, Any] = {"name": "green", "center": [60, 20], "size": [4, 4]}
    layout = {**ROOM, "blocks": [red, green], "start": [8, 20]}

    def run(*actions: Action) -> list[str]:
        world = dd.Arena([layout] * 2, unit="cm", goal=(80, 8))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            if alone:
                run_alone(robot(), 40, world=world, actions=actions)
            else:
                run_together(robot(), 40, [0, 1], world=world, actions=actions)
        return [str(w.message) for w in caught if w.category is RunWarning]

    copies = 1 if alone else 2
    texts = run(Move(20, "red", (61, 22)), Move(30, "red", (70, 20)))
    assert len(texts) == copies
    assert texts[0].startswith("arena: the blocks 'red' and 'green' overlap by 3 x 2 cm")
    assert len(run(Place(20, "blue", (62, 20), (4, 4)))) == copies
    assert run(Move(20, "red", (60, 20)), Move(20, "green", (40, 20))) == []  # they change places


def test_a_placed_object_has_its_own_height_in_each_trial() -> None:
    model = straight(0.0)
    picture = [dd.Axis("column", 0, 7, 8), dd.Axis("row", 0, 23, 24), dd.Axis("channel", 0, 2, 3)]
    model.add(dd.Sensor("eye", picture, sensor="camera"))
    block: dict[str, Any] = {"object": "block", "center": (40, 20), "size": (4, 30), "color": (0, 1, 0)}
    actions = [
        Place([30, 31, 33, 36, 40], height=2.0, **block),
        Place(50, height=8.0, **block),
        Place(70, **block),
    ]
    empty = {**ROOM, "walls": [], "start": [8, 20]}
    world = dd.Arena([empty] * 5, unit="cm")
    many = requires_equal(model, actions, [], ["eye.output"], 90, world=world, every=2)
    for trial in many:
        green = (trial.values["eye.output"][:, 4, :, 1] > 0.9) & (
            trial.values["eye.output"][:, 4, :, 0] < 0.1
        )
        rows = green.sum(axis=1)[[k // 2 for k in (20, 48, 68, 88)]]
        assert rows[0] == 0 < rows[1] < rows[2] < rows[3]  # by default as tall as the walls, 10 cm


def test_trials_in_a_world_may_have_other_parameters_in_one_batch() -> None:
    speeds = [300.0, 600.0, 500.0, 400.0]
    options: dict[str, Any] = {"watch": WATCH, "world": rooms(), "precision": "float64", "events": [TOUCHED]}
    many = run_together(robot(), 60, range(4), values={"go left.amplitude": speeds}, **options)
    for k, trial in enumerate(many):
        model = robot()
        model.set("go left.amplitude", speeds[k])
        alone = run_alone(model, 60, trial=k, **options)
        assert trial.events == alone.events
        for name in WATCH:
            np.testing.assert_allclose(trial.values[name], alone.values[name], atol=1e-10)


def test_trials_with_changed_arenas_stay_themselves_when_others_end() -> None:
    """The batch becomes narrower, and the objects of the others have been changed before."""
    ends = Crosses("touched", "touching.output", 0.5)
    actions = [Remove(12, "own", when="far"), Set(20, "go left.amplitude", 580.0)]
    model = robot()
    many = requires_equal(model, actions, [FAR, ends], WATCH, world=rooms(), limit=260)
    assert len({trial.duration for trial in many}) == 4


def test_an_experiment_with_actions_runs_in_one_batch() -> None:
    speed = dd.Factor("speed", [500.0, 600.0], "go left.amplitude")
    experiment = dd.Experiment(
        "robots",
        robot(),
        dd.TrialPlan(
            60,
            events=[FAR, TOUCHED],
            measures=[Measure("where", "pose.output", "max")],
            actions=[Place(10, "box", (30, 28), (4, 4), when="far"), Set(40, "go right.amplitude", 0.0)],
        ),
        2,
        factors=[speed],
        world=rooms(),
        precision="float64",
    )
    setup = experiment.setup()
    assert setup.batched and setup.pieces() == [[0, 1, 2, 3]]
    table = experiment.run()
    for k in range(4):
        model = robot()
        model.set("go left.amplitude", float(table["speed"][k]))
        options = {"world": rooms(), "events": [FAR, TOUCHED], "actions": experiment.plan.actions}
        alone = run_alone(
            model, 60, trial=k, measures=experiment.plan.measures, precision="float64", **options
        )  # type: ignore[arg-type]
        assert float(table["where"][k]) == pytest.approx(alone.measures["where"], abs=1e-10)


@pytest.mark.parametrize(
    ("model", "action", "world", "error", "says"),
    [
        (
            noisy,
            Set(5, "f.quadrature", "point"),
            None,
            ParameterError,
            "cannot be set in one trial of a batch",
        ),
        (noisy, Remove(5, "box"), None, WorldError, "the action Remove needs a world"),
        (noisy, Set(5, "v.tau", 3.0), None, dd.errors.UnknownName, "nothing is called 'v.tau'"),
        (
            noisy,
            Set(5, "u.tau", 3.0, when="never"),
            None,
            dd.errors.UnknownName,
            "waits for the event 'never'",
        ),
        (noisy, Set(5, "u.tau", 0.5), None, dd.errors.TimeError, "tau"),
        (
            robot,
            Remove(5, "nothing"),
            rooms,
            dd.errors.UnknownName,
            "nothing in the arena is called 'nothing'",
        ),
    ],
)
def test_invalid_actions_on_a_batch_are_refused(
    model: Any, action: Action, world: Any, error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=says):
        run_together(
            model(),
            10,
            [0, 1],
            actions=[action],
            events=[Reached("soon", 1, ends=False)],
            world=world and world(),
        )


KERNEL = Set(2.0, "f.kernel", [dd.Gaussian(1, 3)])
INSIDE = Set(5.0, "f.kernel.0.amplitude", 2.0)


@pytest.mark.parametrize(
    "actions",
    [
        (KERNEL, INSIDE),
        (INSIDE, KERNEL),
        (KERNEL, Set(2.0, "f.kernel.0.amplitude", 2.0)),
        (KERNEL, Set(3.0, "f.kernel.0", dd.MexicanHat(5, 1, 2, 3)), Set(4.0, "f.kernel.0.excitation", 6.0)),
        (Set(2.0, "f.kernel", [dd.Gaussian(1, 3)], when="up"), INSIDE),
        (KERNEL, Set([3.0, 4.0], "f.kernel.0.amplitude", 2.0)),
    ],
)
def test_an_action_may_set_a_parameter_of_what_an_earlier_one_sets(actions: Sequence[Action]) -> None:
    require(actions, ["up"], noisy().document, None)
    plan = dd.TrialPlan(20.0, events=[UP], actions=list(actions), measures=[Measure("end", "f.activation")])
    assert dd.Experiment("e", noisy(), plan, trials=2).check() == []


@pytest.mark.parametrize(
    ("actions", "fault"),
    [
        ((INSIDE,), "kernel"),
        ((Set(6.0, "f.kernel", [dd.Gaussian(1, 3)]), INSIDE), "kernel"),
        ((INSIDE, Set(5.0, "f.kernel", [dd.Gaussian(1, 3)])), "kernel"),
        ((KERNEL, Set(5.0, "f.kernel.0.sigma", -1.0)), "below its lower bound"),
        ((Set(2.0, "f.kernle", []), Set(5.0, "f.kernle.0.amplitude", 2.0)), "no parameter"),
    ],
)
def test_an_action_that_is_wrong_when_it_is_due_is_refused(actions: Sequence[Action], fault: str) -> None:
    with pytest.raises(DeodarError, match=fault):
        require(actions, [], noisy().document, None)
