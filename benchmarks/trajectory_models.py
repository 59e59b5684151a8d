"""The models of `trajectories.py`: every example, registered kind, architecture and imported file, and
experiments.

A `Scene` is a model with its world and its number of steps; a `Table` holds the numbers of a script or an
experiment.
"""

from __future__ import annotations

import dataclasses as dc
import math
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import deodar as dd
from deodar import architectures as published
from deodar.architectures._elementary_behaviour import elementary_behaviour
from deodar.architectures.serial_order import action_axis, ordinal_pair
from deodar.experiments.actions import Move, Push, Ramp, Set
from deodar.experiments.events import Appears, Crosses, Vanishes
from deodar.experiments.factor import Factor
from deodar.experiments.measures import Measure
from deodar.importers import examples
from deodar.numerics.kernels.separable import MexicanHat
from deodar.worlds._base import World
from deodar.worlds.arena.arena import Arena
from deodar_papers.saliency.scenes import photographs
from deodar_robots.mujoco.mujoco import MuJoCo

ROOT = Path(__file__).parents[1]
STEPS = 300

sys.path[:0] = [str(path) for path in (ROOT, ROOT / "examples") if str(path) not in sys.path]

from tests.contracts import build, embodied  # noqa: E402
from tests.deodar.experiments.robots import decider, room, straight  # noqa: E402
from tests.deodar.session.models import mixed  # noqa: E402
from tests.deodar_interop.importers.cosivina.files import SAMPLES  # noqa: E402


@dc.dataclass(frozen=True)
class Scene:
    """A model and how it is run: from the start of its document, with seed 0.

    Attributes:
        build: makes the model.
        world: makes its world; none: no world.
        dt: Euler step; none: the document's own, else 1.
        steps: number of Euler steps.
        why: reason for another number of steps than `STEPS`.
        precisions: of the runs.
    """

    build: Callable[[], dd.Model]
    world: Callable[[], World] | None = None
    dt: float | None = None
    steps: int = STEPS
    why: str = ""
    precisions: tuple[str, ...] = ("float64", "float32")


@dc.dataclass(frozen=True)
class Table:
    """Numbers of a script or of an experiment: lists by their names.

    Attributes:
        numbers: computes them.
        exact: names of the lists that must be equal, such as times of events; the limits apply to the others.
        precisions: of the runs.
    """

    numbers: Callable[[str], Mapping[str, list[Any]]]
    exact: tuple[str, ...] = ()
    precisions: tuple[str, ...] = ("float64", "float32")


HEAVY = {"saliency": 100, "spa": 100, "color_search": 100, "pointing": 100}
"""Steps of the examples whose steps are expensive."""

ENDS = {"Recording": 30}
"""Steps of worlds whose example does not last 300 of them."""

LINE = dd.Axis("x", 0, 100, samples=51, unit="deg")


def _photograph() -> World:
    return next(s for s in photographs() if s.name == "coffee").picture


EXAMPLE_WORLDS: Mapping[str, Callable[[], World]] = {
    "saliency": _photograph,
    "spa": lambda: Arena("z"),
    "color_search": lambda: Arena(
        "search", unit="mm", vehicle="khepera", physics=dd.ArenaPhysics(period=20, camera_every=4)
    ),
    "pointing": MuJoCo.example,
}


def _example(name: str) -> Scene:
    steps = HEAVY.get(name, STEPS)
    return Scene(
        lambda: dd.load(f"example:{name}"),
        EXAMPLE_WORLDS.get(name),
        steps=steps,
        why="a step is expensive" if steps < STEPS else "",
    )


def _to_the_end(name: str) -> Scene:
    """An example for the duration that its notes state, in double precision: most examples show their effect
    after the first 300 steps.
    """
    model, duration = dd.load(f"example:{name}"), examples.duration(name)
    steps = round((duration or 0.0) / model.document.step)
    return Scene(
        lambda: dd.load(f"example:{name}"),
        EXAMPLE_WORLDS.get(name),
        steps=steps,
        why="to the end of the example",
        precisions=("float64",),
    )


def _two_layers() -> dd.Model:
    model = dd.Model("two layers")
    kernel, inhibition = [dd.Gaussian(2.0, 4.0)], [dd.Gaussian(-1.0, 8.0)]
    model.insert(
        published.two_layer_field(
            [LINE],
            kernel,
            inhibition,
            drive=[dd.Gaussian(1.0, 4.0)],
            excitatory=published.Layer(noise=0.3),
        ),
        "layers",
    )
    (
        model.add(dd.GaussianStimulus("input", [LINE], center=40, sigma=5, amplitude=8))
        >> model["layers.excitatory"]
    )
    return model


def _small(model: Callable[[], dd.Model], target: str) -> Callable[[], dd.Model]:
    """A template with one input that drives its field `target`."""

    def built() -> dd.Model:
        made = model()
        axes = made[target].element.axes  # type: ignore[attr-defined]
        made.add(build.source("drive", axes, 6.0)) >> made[target]
        return made

    return built


def _looking(form: str) -> Callable[[], dd.Model]:
    """One form of the transformation between frames of reference, with an object and a gaze."""

    def built() -> dd.Model:
        made = _small(lambda: published.reference_frame(form), "retina")()  # type: ignore[arg-type]
        made.add(build.source("looking", [], 12.0)) >> made["gaze"]
        return made

    return built


def _noisy_maze() -> dd.Model:
    return published.spa(published.maze("z", "high"), "high")


def architectures() -> dict[str, Scene]:
    """Architectures that are not among the examples, and those of the demonstrations and papers with their
    worlds.
    """
    return {
        "behaviour": Scene(_small(published.behaviour, "task")),
        "behaviour over a line": Scene(_small(lambda: published.behaviour([LINE]), "goal")),
        "change_detection": Scene(lambda: published.change_trial((60.0, 200.0), (60.0, 150.0), noise=0.1)),
        "elementary_behaviour": Scene(lambda: elementary_behaviour([LINE], [2.0])),
        "feature_space": Scene(_small(published.feature_space, "space")),
        "ordinal_pair": Scene(_small(lambda: ordinal_pair(action_axis()), "node")),
        "plan to the left": Scene(lambda: published.plan(start=200.0)),
        "reference_frame diagonal": Scene(_looking("diagonal")),
        "reference_frame steered": Scene(_looking("steered")),
        "saliency of another hue": Scene(
            lambda: published.saliency(hue=120.0, cue=9.0), _photograph, steps=50, why="a step is expensive"
        ),
        "serial_order": Scene(lambda: published.serial_order(3)),
        "spa with noise": Scene(
            _noisy_maze, lambda: published.maze("z", "high"), steps=100, why="a step is expensive"
        ),
        "two_layer_field": Scene(_two_layers),
    }


def scenes() -> dict[str, Scene]:
    """All models by name."""
    out = {f"example {name}": _example(name) for name in examples.names()}
    out |= {f"example {name} to the end": _to_the_end(name) for name in examples.names() if name not in HEAVY}
    out["example own_function"] = Scene(_own_function)
    out |= {f"architecture {name}": scene for name, scene in architectures().items()}
    out |= {f"imported {path.stem}": Scene(lambda path=path: dd.load(path)) for path in SAMPLES}
    for kind in (*build.KINDS, *build.PARTS):
        out[f"contract {kind}"] = Scene(
            lambda kind=kind: build.around(build.any_example(kind), noisy=True), build.AnyWorld
        )
    out |= {
        f"world {kind}": Scene(
            lambda kind=kind: embodied.everything(kind),
            cls.example,
            embodied.step_of(kind),
            ENDS.get(kind, STEPS),
            "the world ends" if kind in ENDS else "",
        )
        for kind, cls in embodied.WORLDS.items()
    }
    out |= {"several rates": Scene(mixed), "straight on": Scene(straight, room), "decider": Scene(decider)}
    return out


def _own_function() -> dd.Model:
    import own_function

    return own_function.model()


# ------------------------------------------------------------------------- numbers of experiments and scripts


def _rows(experiment: dd.Experiment) -> Callable[[str], dict[str, list[Any]]]:
    def numbers(precision: str) -> dict[str, list[Any]]:
        data = dc.replace(experiment, precision=precision).run()
        names = [
            "outcome",
            "duration",
            *(p.name for p in (*experiment.plan.events, *experiment.plan.measures)),
        ]
        return {name: [_plain(v) for v in data[name].values.ravel().tolist()] for name in names}

    return numbers


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and math.isnan(value) else value


def _experiment(experiment: dd.Experiment) -> Table:
    return Table(_rows(experiment), ("outcome", "duration", *(c.name for c in experiment.plan.events)))


def _choice() -> dd.Experiment:
    """Two inputs from 20 ms on, with every kind of action in between."""
    model = dd.Model("choice")
    u = model.add(
        dd.Field(
            "u",
            [LINE],
            tau=10,
            resting_level=-5,
            kernel=[MexicanHat(1.2, 5, 0.3, 15)],
            global_inhibition=0.4,
            noise=1.0,
        )
    )
    for name, center in (("left", 30), ("right", 70)):
        (
            model.add(
                dd.GaussianStimulus(name, [LINE], center=center, sigma=5, amplitude=6, windows=[(20, 120)])
            )
            >> u
        )
    return dd.Experiment(
        "choice",
        model,
        dd.TrialPlan(
            200,
            events=[Appears("detected", "u", threshold=1.0, ends=False), Vanishes("gone", "u")],
            measures=[
                Measure("where", "u.activation", "place", "detected"),
                Measure("end", "u.activation", "mean"),
            ],
            actions=[
                Push(10, "u", 1.0, 5),
                Set(50, "u.resting_level", -5.5, when="detected"),
                Ramp(130, "u.resting_level", -8.0, 20),
            ],
        ),
        3,
        factors=[Factor("strength", [6.0, 7.0], "left.amplitude")],
        seed=1,
    )


def _robot() -> dd.Experiment:
    far = [Crosses("far", "pose", 60, ends=False), Crosses("touched", "touching", 0.5)]
    return dd.Experiment(
        "robot",
        straight(),
        dd.TrialPlan(300, events=far, actions=[Move(5, "far", (88, 20), when="far")]),
        world=room(),
    )


def tables() -> dict[str, Table]:
    """All tables by name."""
    import choices
    import live_session
    import reaction_time
    import sequences

    return {
        "example reaction_time": _experiment(reaction_time.experiment(trials=1)),
        "example choices": Table(lambda precision: {"shares": choices.shares(20)}, ("shares",), ("float32",)),
        "example live_session": Table(
            lambda precision: live_session.main(), ("remembered", "pulled along", "restored"), ("float32",)
        ),
        "example sequences": Table(
            lambda precision: {"judged": list(sequences.judged(2, range(1)))}, ("judged",), ("float32",)
        ),
        "experiment choice": _experiment(_choice()),
        "experiment robot": _experiment(_robot()),
        "experiment decider": _experiment(
            dd.Experiment("d", decider(), dd.TrialPlan(400, events=[Crosses("decided", "u.activation")]), 6)
        ),
    }
