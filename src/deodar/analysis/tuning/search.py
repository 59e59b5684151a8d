"""The search for a candidate that meets all requirements: random points, then CMA-ES from the best."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

import numpy as np

from deodar.analysis.tuning.judge import CandidateJudge, losses
from deodar.errors import MissingExtra

FIRST = 256
"""Random points at the begin."""

SPREAD = 0.15
"""Standard deviation of CMA-ES at the begin, in widths of the cube."""

POPULATION = 32
"""Candidates in a generation."""

NEAR = 0.2
"""Distance from an earlier start or its end, along any parameter of the cube, within which none begins."""

GENERATIONS = 80
"""Generations of a start, after which the next best point follows."""


def searched(judge: CandidateJudge) -> np.ndarray:
    """Return values of the parameters that meet all requirements, or the best of the budget.

    Args:
        judge: measures candidates.

    Raises:
        MissingExtra: the package cma is not installed.
    """
    if find_spec("cma") is None:
        raise MissingExtra("cma", "tune", "dd.tune")
    space, budget = judge.request.space, judge.request.budget
    rng = np.random.default_rng(judge.request.seed)
    points = rng.uniform(size=(min(FIRST, max(budget, 1)), len(space.paths)))
    # the model itself may meet everything
    points[0] = np.clip(space.cube(space.present), 0, 1)
    losses_of_points = losses(judge.margins(space.values(points), "random points"))
    points, visited = points[np.argsort(losses_of_points, kind="stable")], np.zeros((0, len(space.paths)))
    while judge.best_margins.min() < 0 and judge.measured < budget:
        start = _next(points, visited, rng)
        options = {
            "popsize": POPULATION,
            "bounds": [0, 1],
            "seed": int(rng.integers(1, 2**31)),
            "verbose": -9,
            "maxiter": GENERATIONS,
        }
        strategy = _strategy()(_inside(start), SPREAD, options)
        while not strategy.stop() and judge.best_margins.min() < 0 and judge.measured < budget:
            cubes = np.array(strategy.ask())
            strategy.tell(list(cubes), losses(judge.margins(space.values(cubes), "search")).tolist())
        visited = np.vstack([visited, start, strategy.result.xfavorite])
    return judge.best


def _next(points: np.ndarray, visited: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return the best point that is far from those that were tried; a random one if there is none."""
    for point in points:
        if (np.abs(visited - point).max(-1, initial=0.0) > NEAR).all():
            return point
    return rng.uniform(size=points.shape[1])


def _inside(cube: np.ndarray) -> np.ndarray:
    return np.clip(cube, 0.01, 0.99)


def _strategy() -> Any:
    """Return the class of CMA-ES."""
    # start-up time: it brings scipy.stats, and the random points may suffice
    import cma

    return cma.CMAEvolutionStrategy
