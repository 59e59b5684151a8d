"""Gazes: a run of the architecture in front of the screen, and tests of its map by single gazes.

The loop closes inside the compiled step, and nothing is reset in a run: the screen shows targets, and the
architecture turns to them. A gaze ends when the node `satisfied` exceeds its threshold.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.architectures.looking import looking
from deodar.batch.simulate import simulate
from deodar.compiler.build import Build
from deodar.compiler.copy_batch import Batch
from deodar.compiler.dynamics import Dynamics
from deodar.elements.world_ports import Sensor
from deodar.model.model import Model
from deodar.numerics.axes import Axis
from deodar.resources import Resources
from deodar.session.exchange import embodied
from deodar.session.run import Run
from deodar_robots.eye.eye import Eye
from deodar_robots.eye.pan_tilt import CENTRE, PIXELS, PanTilt
from deodar_robots.eye.screen import EyeScreen

STEP = 10.0
"""Euler step and period of the world, ms."""

SLICE = 6000
"""Steps between two counts of the gazes."""

NEAR, CLOSE = 12.0, 6.0
"""Distances from the centre of the retina that the results count, pixels."""

MARGIN, POSES = 6.0, (500.0, 1500.0)
"""Where targets of tests are: so far inside the retina, pixels; and the poses from which gazes start."""

WAIT, PATIENCE = 300.0, 2200.0
"""Time before the target of a test, and the time after which a test counts as without a gaze, ms."""

SIGNALS = ("satisfied.activation", "target", "shift", "pose", "correction peak", "rewarded")
"""What is sampled in every step; those of the correcting mechanism only where it has them."""


def observed(mechanism: str, **settings: Any) -> Model:
    """Return the architecture with a sensor of the true place of the target, which nothing reads."""
    model = looking(mechanism, **settings)
    model.add(Sensor("target", [Axis("component", 0, 1, 2)], sensor="target"))
    return model


@dataclass(frozen=True)
class Learned:
    """A run of learning.

    Attributes:
        maps: the map at the end of the slice in which each number of gazes was reached.
        ends: step in which each gaze ended.
        arrivals: distance of the target from the centre at the end of each gaze, pixels.
        signals: samples of `SIGNALS`, one a step.
        seconds: simulated time.
    """

    maps: Mapping[int, np.ndarray]
    ends: np.ndarray
    arrivals: np.ndarray
    signals: Mapping[str, np.ndarray]
    seconds: float


def learn(
    model: Model,
    world: Eye,
    seed: int,
    marks: Sequence[int],
    progress: Callable[[int], None] | None = None,
) -> Learned:
    """Run the architecture until it has made the last number of gazes of `marks`.

    Args:
        model: the architecture, as `observed` returns it.
        world: the world.
        seed: seed of all noise.
        marks: numbers of gazes after which the map is stored, ascending.
        progress: called with the number of gazes.
    """
    document = model.document
    dynamics = Dynamics(model, Build(document, body=embodied(document, world)))
    run = Run(dynamics, Batch(), STEP, seed, [0], world)
    program = run.program
    idents = {entry.path: entry.id for entry in document.entries}
    names = [name for name in SIGNALS if name.split(".")[0] in idents]
    ports = [
        program.port(idents[name.split(".")[0]], name.split(".")[1] if "." in name else "output")
        for name in names
    ]
    map_port = [program.port(idents["map"], "weights")]
    found: dict[str, list[np.ndarray]] = {name: [] for name in names}

    def collect(_: int, seen: tuple[np.ndarray, ...]) -> None:
        for name, part in zip(names, seen, strict=True):
            found[name].append(part)

    maps: dict[int, np.ndarray] = {}
    ends = np.zeros(0, int)
    while len(maps) < len(marks):
        run.record(SLICE, ports, 1, 1, collect)
        ends = onsets(np.concatenate(found["satisfied.activation"]))
        for mark in marks:
            if len(ends) >= mark and mark not in maps:
                maps[mark] = run.read(map_port)[0]
        if progress is not None:
            progress(len(ends))
    signals = {name: np.concatenate(parts) for name, parts in found.items()}
    away = np.linalg.norm(signals["target"] - CENTRE, axis=-1)
    return Learned(maps, ends, away[ends], signals, len(away) * STEP / 1000)


def test(
    mechanism: str,
    weights: np.ndarray,
    seed: int,
    count: int,
    pan_tilt: PanTilt,
    samples: Sequence[int],
) -> np.ndarray:
    """Return the distance of the target from the centre after a single gaze, pixels, for each test.

    Each gaze starts from rest, at a random pose, to a random place; nothing is learned; the noise and the
    exploration are on. A test without a gaze is NaN.

    Args:
        mechanism: that of the architecture.
        weights: the map.
        seed: seed of places, poses and noise.
        count: number of tests.
        pan_tilt: the pan-tilt unit, such as one with a changed gain.
        samples: samples of the visual and of the motor fields.
    """
    rng = np.random.default_rng([seed, 1])
    eye = Eye(
        pan_tilt=pan_tilt,
        screen=EyeScreen(wait=WAIT, endless=False),
        first=rng.uniform(MARGIN, PIXELS - 1 - MARGIN, (count, 2)),
        pose=rng.uniform(*POSES, (count, 2)),
    )
    model = observed(mechanism, samples=samples, weights=weights, learns=False)
    record = ["satisfied.activation", "target"]
    data = simulate(
        model,
        WAIT + PATIENCE,
        record=record,
        every=STEP,
        trials=count,
        world=eye,
        seed=seed,
        on=Resources(progress=False),
    )
    node = data["satisfied.activation"].transpose("trial", "time").values
    away = np.linalg.norm(data["target.output"].transpose("trial", "time", ...).values - CENTRE, axis=-1)
    first = [onsets(row)[:1] for row in node]
    return np.array([away[k, step[0]] if len(step) else np.nan for k, step in enumerate(first)])


def onsets(activation: np.ndarray) -> np.ndarray:
    """Return the steps in which an activation exceeds its threshold, 0, for the first time."""
    above = activation > 0
    return np.flatnonzero(above[1:] & ~above[:-1]) + 1


def summary(errors: np.ndarray) -> dict[str, Any]:
    """Return the numbers of a set of tests; one without a gaze counts as far away."""
    away = np.where(np.isnan(errors), np.inf, errors)
    median = float(np.median(away))
    return {
        "tests": len(errors),
        "near": int(np.count_nonzero(away <= NEAR)),
        "close": int(np.count_nonzero(away <= CLOSE)),
        "no gaze": int(np.count_nonzero(np.isnan(errors))),
        "median": median if np.isfinite(median) else None,
    }
