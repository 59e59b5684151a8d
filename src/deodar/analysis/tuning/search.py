"""The search for a candidate that meets all requirements, and its way to the middle of their region."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np

from deodar.analysis.tuning.judge import CandidateJudge, losses
from deodar.errors import MissingExtra
from deodar.summary import Summarised, Summary

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


# ----------------------------------------------------------------------------------- the middle of the region


POINTS = 96
"""Random points of a step of centring."""

ROUNDS = 10
"""Steps of centring."""

SPREAD_OF_FIRST = 0.02
"""Standard deviation of the first points, a relative change of all parameters."""

WANTED = 0.37
"""Share of the points that is to meet all requirements: 1 / e, at which the volume is found fastest."""

GROWTH = 1.4
"""Factor by which the cloud of points grows or shrinks."""

WIDEST = 0.5
"""Largest relative change that is tried."""

CERTAIN = 512
"""Random points of the final size."""

DRAWN = 64
"""Most points that are drawn at once."""

LEAST = 1e-5
"""Half width below which the size counts as 0."""

SECTIONS, DEPTH = 8, 2
"""Points of a search along one parameter in each direction, and how many times it is refined."""


def centred(
    judge: CandidateJudge, values: np.ndarray, first: float = SPREAD_OF_FIRST, rounds: int = ROUNDS
) -> np.ndarray:
    """Return values near the middle of the region around some that meet all requirements.

    A cloud of random points has the mean and covariance of those of its points that met all requirements in
    the step before, and grows while many of its points do: Gaussian adaptation.

    Args:
        judge: measures candidates.
        values: values that meet all requirements.
        first: standard deviation of the first cloud, a relative change of all parameters.
        rounds: number of steps.

    Reference:
        Kjellström & Taxén (1981), Stochastic optimization in system design, IEEE Transactions on Circuits and
        Systems 28, 702-715.
    """
    space, n = judge.request.space, values.size
    rng = np.random.default_rng([judge.request.seed, 1])
    middle, cloud = values, first**2 * np.eye(n)
    for number in range(rounds + 1):
        moves = rng.standard_normal((POINTS, n)) @ np.linalg.cholesky(cloud).T
        moves = np.clip(moves, -WIDEST, WIDEST)
        moves[0] = 0.0
        points = np.clip(space.moved(middle, moves), space.low, space.high)
        met = judge.margins(points[:1] if number == rounds else points, "middle").min(-1) >= 0
        if not met[0]:
            # the region is not convex: back, and nearer
            middle, cloud = values, cloud / GROWTH**2
            continue
        values = middle
        inside = points[met] if number < rounds else points[:1]
        if len(inside) <= 2 * n:
            cloud = cloud / GROWTH**2
            continue
        relative = (inside - middle) / space.units(middle)
        spread = np.cov(relative.T).reshape(n, n) + 1e-12 * np.eye(n)
        size = GROWTH if met.mean() > WANTED else 1 / GROWTH
        # an accepted cloud has less variance than the one that was drawn
        change = np.exp((np.linalg.slogdet(cloud)[1] - np.linalg.slogdet(spread)[1]) / n)
        cloud = size * (0.5 * cloud + 0.5 * change * spread)
        middle = inside.mean(0)
    return values


@dataclass(frozen=True, repr=False)
class RegionSize(Summarised):
    """How far parameters may move while all requirements stay met.

    Attributes:
        together: largest relative change that all parameters may have at once, each in either direction.
        alone: for each parameter its largest relative change downwards and upwards, the others unchanged.
        points: number of random points within `together`, all of which meet all requirements.
    """

    together: float
    alone: tuple[tuple[float, float], ...]
    points: int

    def _summary(self) -> Summary:
        tried = [("random points within, all meet the requirements", self.points)]
        return Summary(f"All parameters may move by {self.together:.1%} at once", tried)


def region_size(judge: CandidateJudge, values: np.ndarray) -> RegionSize:
    """Return the size of the region around values that meet all requirements.

    Args:
        judge: measures candidates.
        values: the values.
    """
    alone = _alone(judge, values)
    half = min(min(pair) for pair in alone)
    return RegionSize(together(judge, values, half, CERTAIN), alone, CERTAIN)


def together(judge: CandidateJudge, values: np.ndarray, half: float, points: int) -> float:
    """Return the largest half width, up to `half`, of a box in which all of some random points are met.

    Points of a box that lie inside a smaller one are random points of that one.
    """
    rng = np.random.default_rng([judge.request.seed, 2])
    inside = np.zeros(0)
    while inside.size < points and half > LEAST:
        n = min(DRAWN, -(-(points - inside.size) // judge.lanes) * judge.lanes)
        moves = half * rng.uniform(-1, 1, (n, values.size))
        reach = np.abs(moves).max(-1)
        met = judge.margins(judge.request.space.moved(values, moves), "region").min(-1) >= 0
        if not met.all():
            half = float(reach[~met].min()) * (1 - 1e-9)
        inside = np.concatenate([inside, reach[met]])
        inside = inside[inside <= half]
    return half if half > LEAST else 0.0


def _alone(judge: CandidateJudge, values: np.ndarray) -> tuple[tuple[float, float], ...]:
    """Return the largest change of each parameter alone, downwards and upwards, up to `WIDEST`."""
    n = values.size
    directions = np.concatenate([-np.eye(n), np.eye(n)])
    low, high = np.zeros(2 * n), np.full(2 * n, WIDEST)
    for _ in range(DEPTH):
        parts = np.linspace(0, 1, SECTIONS + 1)[1:]
        trial = low[:, None] + (high - low)[:, None] * parts
        moves = (trial[..., None] * directions[:, None, :]).reshape(-1, n)
        inside = judge.margins(judge.request.space.moved(values, moves), "region").min(-1) >= 0
        met = inside.reshape(2 * n, SECTIONS)
        reached = np.where(met.all(-1), SECTIONS, (~met).argmax(-1))
        edges = np.concatenate([low[:, None], trial], axis=1)
        low, high = (
            edges[np.arange(2 * n), reached],
            edges[np.arange(2 * n), np.minimum(reached + 1, SECTIONS)],
        )
    return tuple((float(low[k]), float(low[n + k])) for k in range(n))
