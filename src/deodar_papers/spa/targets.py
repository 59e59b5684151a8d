"""Required claims: results of a faithful run of the three cases from which no setting was inferred."""

from __future__ import annotations

import numpy as np

from deodar.analysis.claims import Claim
from deodar.analysis.statistics import mean_interval, ratio_interval
from deodar_papers.spa.condition_runs import LONG, SOURCE, Runs, between
from deodar_papers.spa.route import NORTH, SOUTH, SWITCH
from deodar_papers.spa.sentence import ALIKE, REFLECTION, START, Sentence

SUCCESS = {("z", "low"): 0.95, ("z", "high"): 0.95, ("large", "low"): 0.90, ("large", "high"): 0.85}
"""Least shares of successful runs.

A choice of deodar: the only numbers of the paper are in figure 7, not in its text.
"""

DIVERGENCE = (1.05, 1.2)
"""Bounds of the mean Lp / Lo, from a prototype: the only numbers of the paper are in figure 8."""

MAZE = {"z": "Z-maze", "large": "large maze"}
EARLY, MIDDLE, LATE = (0, 129), (200, 450), (501, 1000)
"""Onsets.

Those of the paper, narrowed to the range in which a prototype clearly chose one route; `sentences` has those
of the paper.
"""

ROUTES = (
    (
        "full",
        "an obstacle before t = 130 that lasts more than 100 steps sends the robot south",
        EARLY,
        (101, 1000),
        SOUTH,
        0.90,
        0.90,
    ),
    (
        "full",
        "an obstacle at t = 200 to 450 that lasts 200 to 500 steps sends it north, then south",
        MIDDLE,
        (200, 500),
        SWITCH,
        0.70,
        0.70,
    ),
    ("full", "an obstacle after t = 500 leaves it on the north route", LATE, (0, 1000), NORTH, 0.95, 0.90),
    (
        "partial",
        "an obstacle before t = 130 sends the robot south, however long it lasts",
        EARLY,
        (0, 1000),
        SOUTH,
        0.85,
        0.85,
    ),
    (
        "partial",
        "an obstacle at t = 200 to 450 leaves it on the north route",
        MIDDLE,
        (0, 1000),
        NORTH,
        0.90,
        0.90,
    ),
)
"""Obstacle, claim, onset, duration, route, least share at low and at high noise."""


def claims(runs: Runs) -> list[Claim]:
    """Return one claim for each maze, obstacle and level of noise.

    Success in the large maze is reported only: `reflection` was fitted to it.
    """
    return [*_success(runs), *_divergence(runs), *_alike(runs), *_routes(runs)]


def _success(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for (maze, noise), least in SUCCESS.items():
        text, source = f"{MAZE[maze]}, {noise} noise: the planner reaches the goal", f"{SOURCE}, figure 7"
        fitted = maze == "large"
        said = Sentence(
            "5.1",
            text,
            "ours",
            REFLECTION if fitted else "",
            fitted,
            "reported" if fitted else "required",
            source,
        )
        out.append(said.share(runs.of(f"{maze}/planner/{noise}"), lambda r: r["success"], least, runs.quick))
    return out


def _divergence(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for maze, noise in SUCCESS:
        values = runs.divergences(f"{maze}/planner/{noise}")
        text = f"{MAZE[maze]}, {noise} noise: mean Lp / Lo over pairs with Lo > {LONG:g} cm"
        said = Sentence(
            "5.1",
            text,
            "ours",
            REFLECTION if maze == "large" else "",
            kind="required",
            source=f"{SOURCE}, figure 8",
        )
        value = float(values.mean()) if len(values) else None
        out.append(
            said.bounds(
                value,
                len(values),
                DIVERGENCE,
                "{} to {}".format(*DIVERGENCE),
                mean_interval(values),
                runs.quick,
            )
        )
    return out


def _alike(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for maze in MAZE:
        low, high = runs.both(f"{maze}/planner/low", f"{maze}/planner/high")
        value = float(np.median(high) / np.median(low)) if len(low) else None
        text = (
            f"{MAZE[maze]}: the medians of Lp / Lo at high and low noise are equal within {ALIKE:.0%}, pair"
            " by pair"
        )
        said = Sentence(
            "5.1",
            text,
            "ours",
            REFLECTION if maze == "large" else "",
            kind="required",
            source=f"{SOURCE}, figure 8",
        )
        out.append(said.equal(value, ratio_interval(high, low, paired=True), len(low), 1 - ALIKE, 1 + ALIKE))
    return out


def _routes(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for obstacle, says, onset, duration, way, *least in ROUTES:
        for noise, at_least in zip(("low", "high"), least, strict=True):
            rows = between(runs.kept(obstacle, noise), onset, duration)
            text = f"case 3, {obstacle} obstacle, {noise} noise: {says}"
            said = Sentence(
                "5.2",
                text,
                "ours",
                START,
                kind="required",
                source=f"{SOURCE}, section 5.2 and figures 13, 15 and 16",
            )
            out.append(said.share(rows, lambda r, way=way: r["route"] == way, at_least, runs.quick))
    return out
