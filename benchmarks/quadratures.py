"""Prints what published architectures do with sums over points and over cells: `python
benchmarks/quadratures.py [serial-order] [saliency] [spa]`.

Serial order: learned sequences of ten actions, how many trials produce all ten in their order at their
places. Saliency: the untuned photographs of `deodar demo saliency` and what is required of them together.
Planning (spa): the first pairs of start and goal in the Z-maze at low noise, how many goals are reached, and
how long the paths are. All fields over axes take the quadrature. Nothing is asserted.
"""

from __future__ import annotations

import argparse
import os
import sys
import time

os.environ.setdefault("NPROC", "1")

import numpy as np

import deodar as dd
from deodar.analysis.paths import path_length
from deodar.analysis.shortest import shortest_path
from deodar.architectures.cascade import cascade, cascade_paths
from deodar.architectures.saliency import saliency
from deodar.architectures.serial_order import lesson, lesson_end, production_start
from deodar.architectures.spa import spa
from deodar.experiments.batch import run_batch
from deodar.experiments.events import Within
from deodar_papers.saliency.scenes import photographs, run_scene
from deodar_papers.saliency.targets import totals
from deodar_papers.spa import cases
from deodar_papers.spa.pairs import pairs, reference
from deodar_papers.spa.trials import LIMIT, POSE, RADIUS, STAY

SEQUENCE = [30.0, 6.0, 6.0, 54.0, 30.0, 18.0, 42.0, 42.0, 42.0, 6.0]
PLACES = (6.0, 18.0, 30.0, 42.0, 54.0)
RELEASED = 250.0
"""After production began, ms: what was cleared is clear."""
TRIALS = 16
PAIRS = 20
"""Pairs of start and goal for the planner, of 96."""


def with_quadrature(model: dd.Model, quadrature: str) -> dd.Model:
    """The model, all its fields over axes with this quadrature."""
    for entry in model.document.entries:
        if isinstance(entry.element, dd.Field) and entry.element.axes:
            model.set(f"{entry.path}.quadrature", quadrature)
    return model


def serial_order(quadrature: str) -> None:
    n = len(SEQUENCE)
    model = with_quadrature(lesson(SEQUENCE, PLACES), quadrature)
    runs = dd.simulate(
        model, lesson_end(n, len(PLACES)), record=cascade_paths(n), trials=TRIALS, progress=False
    )
    right, lasting = 0, []
    for trial in range(TRIALS):
        found = cascade(runs.isel(trial=trial), production_start(n) + RELEASED)
        items = [t.item for t in found] == list(range(1, n + 1))
        right += items and all(abs(t.place - place) <= 1.5 for t, place in zip(found, SEQUENCE, strict=True))
        lasting += [abs(t.place - place) for t, place in zip(found, SEQUENCE, strict=False)]
    farthest = max(lasting, default=float("nan"))
    said = f"{right} of {TRIALS} trials right; peaks lie at most {farthest:.2f} samples from their actions"
    print(f"{'serial order':14}{quadrature:8}{said}", flush=True)


def saliency_demo(quadrature: str) -> None:
    scenes = [scene for scene in photographs(untuned=True) if not scene.tuned]
    results = [run_scene(scene, model=with_quadrature(saliency(), quadrature)) for scene in scenes]
    for claim in totals(results):
        print(f"{'saliency':14}{quadrature:8}{claim.name}: {claim.value} ({claim.target})", flush=True)


def planning(quadrature: str) -> None:
    c = cases.conditions(True)["z/planner/low"]
    arena = cases.world(c)
    model = with_quadrature(spa(arena, c.noise, c.factor), quadrature)
    reached, ratios, steps = 0, [], []
    for trial in list(c.trials)[:PAIRS]:
        [course] = run_batch(
            model, LIMIT, [trial], [POSE], [Within("done", RADIUS, POSE, "goal.output", STAY)], world=arena
        )
        start, goal = pairs(c.maze)[0][trial, :2], pairs(c.maze)[1][trial]
        line, best = course.values[POSE][:, :2], shortest_path(reference(c.maze), start, goal)
        reached += (there := bool(np.linalg.norm(line[-1] - goal) <= RADIUS))
        steps.append(len(line) - 1)
        if there and best is not None:
            ratios.append(path_length(line) / path_length(best))
    said = (
        f"{reached} of {len(steps)} goals reached; paths {np.mean(ratios):.3f} times the shortest;"
        f" {np.mean(steps):.0f} steps"
    )
    print(f"{'planning':14}{quadrature:8}{said}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("which", nargs="*", help="serial-order, saliency, spa (default: all)")
    given = parser.parse_args()
    began = time.time()
    measured = {"serial-order": serial_order, "saliency": saliency_demo, "spa": planning}
    for name in given.which or measured:
        for quadrature in ("point", "cell"):
            measured[name](quadrature)
    print(f"\n{time.time() - began:.0f} s; deodar {dd.__version__}, single precision")
    return 0


if __name__ == "__main__":
    sys.exit(main())
