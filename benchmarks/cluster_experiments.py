"""Ten short experiments of different kinds: what a trial computes, what changes in it, and how it is run."""

from __future__ import annotations

from collections.abc import Callable

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor
from deodar.worlds.arena.arena import Arena

ROOM = {
    "unit": "cm",
    "arena": {"x": [0, 100], "y": [0, 40]},
    "walls": [{"name": "far", "center": [97, 20], "size": [4, 40]}],
}


def decision(trials: int) -> dd.Experiment:
    """Noise drives a node over its threshold; two resting levels."""
    model = dd.Model("decision")
    model.add(dd.Field("u", [], tau=20, resting_level=-1, noise=3.0))
    levels = [dd.Factor("level", [-1.0, -2.0], "u.resting_level")]
    seen = [dd.Crosses("decided", "u.activation")]
    return dd.Experiment("decision", model, dd.TrialPlan(600, events=seen), trials // 2, factors=levels)


def _two_inputs(samples: int = 101) -> dd.Model:
    x = dd.Axis("x", 0, 100, samples=samples)
    model = dd.Model("two inputs")
    u = model.add(
        dd.Field(
            "u", [x], tau=20, resting_level=-5, kernel=[dd.Gaussian(1.2, 5)], global_inhibition=0.6, noise=1.0
        )
    )
    for name, center in (("left", 30), ("right", 70)):
        model.add(dd.GaussianStimulus(name, [x], center=center, sigma=5, amplitude=6)) >> u
    return model


def selection(trials: int) -> dd.Experiment:
    """A field selects one of two inputs; conditions with places, measures of one and of many numbers."""
    seen = [dd.Appears(name, "u", near=place, radius=10) for name, place in (("left", 30), ("right", 70))]
    measures = [dd.Measure("where", "u.activation", "place"), dd.Measure("most", "u.activation", "max")]
    return dd.Experiment(
        "selection", _two_inputs(), dd.TrialPlan(300, events=seen, measures=measures), trials
    )


def double(trials: int) -> dd.Experiment:
    """The same in double precision."""
    seen = [dd.Appears("left", "u", near=30, radius=10)]
    return dd.Experiment(
        "double", _two_inputs(51), dd.TrialPlan(200, events=seen), trials, precision="float64"
    )


def actions(trials: int) -> dd.Experiment:
    """Parameters change at times and after an event; the states are reset once."""
    seen = [dd.Appears("seen", "u", ends=False), dd.Vanishes("gone", "u")]
    changes = [
        dd.Set(0, "left.amplitude", 0.0, when="seen"),
        dd.Set(0, "right.amplitude", 0.0, when="seen"),
        dd.Reset(100, when="seen"),
    ]
    return dd.Experiment(
        "actions", _two_inputs(), dd.TrialPlan(400, events=seen, actions=changes, every=2), trials
    )


def times(trials: int) -> dd.Experiment:
    """A push whose time each trial has of its own."""
    model = dd.Model("pushed")
    model.add(dd.Field("u", [], tau=20, resting_level=-5, noise=1.0, kernel=[dd.Gaussian(2.0, 1.0)]))
    push = dd.Push([20.0 + 10 * (k % 5) for k in range(trials)], "u", 8.0, 50)
    return dd.Experiment(
        "times", model, dd.TrialPlan(300, events=[dd.Crosses("on", "u.activation")], actions=[push]), trials
    )


def rebuilt(trials: int) -> dd.Experiment:
    """A factor that needs a program of its own for each of its values."""
    sizes = [dd.Factor("width", [4.0, 6.0], "u.kernel.0.sigma")]
    seen = [dd.Appears("seen", "u")]
    return dd.Experiment("rebuilt", _two_inputs(), dd.TrialPlan(200, events=seen), trials // 2, factors=sizes)


def diverging(trials: int) -> dd.Experiment:
    """Trials of one level diverge."""
    model = dd.Model("diverging")
    u = model.add(dd.Field("u", [], tau=10, sigmoid=dd.Logistic(beta=1), resting_level=1.0, noise=1.0))
    u["activation"] >> model.add(dd.Gain(0.1, name="loop")) >> u
    levels = [dd.Factor("loop", [0.1, 1e6], "loop.factor")]
    measures = [dd.Measure("last", "u.activation", "max")]
    return dd.Experiment("diverging", model, dd.TrialPlan(80, measures=measures), trials // 2, factors=levels)


def learning(trials: int) -> dd.Experiment:
    """A memory trace stays when the states are reset."""
    model = _two_inputs()
    x = model["u"].axes[0]
    trace = model.add(dd.MemoryTrace("trace", [x], tau_build=100))
    model["u"] >> trace
    trace >> dd.Gain(2, name="preshape") >> model["u"]
    again = [dd.Reset(150, keep_learned=True)]
    seen = [dd.Reached("end", 299.0)]
    kept = [dd.Measure("strength", "trace.output", "max", when="end")]
    return dd.Experiment(
        "learning", model, dd.TrialPlan(300, events=seen, measures=kept, actions=again), trials
    )


def robot(trials: int) -> dd.Experiment:
    """A robot in an arena that the program computes; an object moves."""
    model = dd.Model("straight")
    model.describe(time_unit="1 = 64 ms")
    for wheel in ("left", "right"):
        push = model.add(Boost(f"go {wheel}", amplitude=400.0))
        model.connect(push, model.add(Motor(wheel, motor=wheel)))
    for name, size in (("pose", 3), ("goal", 2)):
        model.add(dd.Sensor(name, [dd.Axis("value", 0, size - 1, samples=size)], sensor=name))
    room = Arena(ROOM, start=(10, 20, 0), goal=(80, 20), unit="cm", noise=dd.ArenaNoise(slip=0.2))
    wall = [dd.Place(5, "block", (60, 20), (5, 5), (1, 0, 0), height=10)]
    seen = [dd.Within("there", 60, "pose.output", "goal.output")]
    return dd.Experiment("robot", model, dd.TrialPlan(60, events=seen, actions=wall), trials, world=room)


def alone(trials: int) -> dd.Experiment:
    """Trials that run one by one, because an action rebuilds the program."""
    widths = [dd.Set(100, "u.kernel.0.sigma", 6.0)]
    return dd.Experiment(
        "alone", _two_inputs(51), dd.TrialPlan(150, events=[dd.Appears("seen", "u")], actions=widths), trials
    )


TEN: dict[str, Callable[[int], dd.Experiment]] = {
    made.__name__: made
    for made in (decision, selection, double, actions, times, rebuilt, diverging, learning, robot, alone)
}
"""The experiments by name, each with its number of trials as argument."""
