"""The required claims: what a faithful run of the three cases gives."""

from __future__ import annotations

import numpy as np

from deodar.analysis.claims import Claim
from deodar.analysis.statistics import decided, mean_interval, median_interval, ratio_interval, rounded, share
from deodar.papers.spa.route import NORTH, SOUTH, SWITCH
from deodar.papers.spa.runs import LONG, SOURCE, Runs, between, count, numbers

PLAN, PLAN_SLACK = 210.0, 0.1
SUCCESS = {("z", "low"): 0.95, ("z", "high"): 0.95, ("large", "low"): 0.90, ("large", "high"): 0.85}
DIVERGENCE = (1.05, 1.2)
ALIKE = 0.05
"""By how much the medians of Lp / Lo at both levels of noise may differ."""

MAZE = {"z": "Z-maze", "large": "large maze"}
EARLY, MIDDLE, LATE = (0, 129), (200, 450), (501, 1000)
ROUTES = (
    ("full", "an obstacle before t = 130 that lasts more than 100 steps sends the robot south", EARLY, (101, 1000), SOUTH, 0.90, 0.90),
    ("full", "an obstacle at t = 200 to 450 that lasts 200 to 500 steps sends it north, then south", MIDDLE, (200, 500), SWITCH, 0.70, 0.70),
    ("full", "an obstacle after t = 500 leaves it on the north route", LATE, (0, 1000), NORTH, 0.95, 0.90),
    ("partial", "an obstacle before t = 130 sends the robot south, however long it lasts", EARLY, (0, 1000), SOUTH, 0.85, 0.85),
    ("partial", "an obstacle at t = 200 to 450 leaves it on the north route", MIDDLE, (0, 1000), NORTH, 0.90, 0.90),
)
"""Obstacle, claim, onset, duration, route, least share at low and at high noise."""


def claims(runs: Runs) -> list[Claim]:
    """One claim for each maze, obstacle and level of noise."""
    return [_plan(runs), *_success(runs), *_divergence(runs), *_alike(runs), *_routes(runs)]


def _plan(runs: Runs) -> Claim:
    steps = numbers(runs.of("free/planner/low"), "plan")
    value, interval = float(np.median(steps)) if len(steps) else None, median_interval(steps)
    low, high = PLAN * (1 - PLAN_SLACK), PLAN * (1 + PLAN_SLACK)
    name = "case 3 without an obstacle, low noise: the plan is complete at a median of about 210 steps"
    holds = decided(value, interval, len(steps), low, high, runs.quick)
    return Claim(name, value, f"{low:g} to {high:g}", holds, "required", f"{SOURCE}, section 5.2", len(steps), interval)


def _success(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for (maze, noise), least in SUCCESS.items():
        hits, n = count(runs.of(f"{maze}/planner/{noise}"), lambda r: r["success"])
        name = f"{MAZE[maze]}, {noise} noise: the planner reaches the goal"
        out.append(share(name, hits, n, least, source=f"{SOURCE}, figure 7", quick=runs.quick))
    return out


def _divergence(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for maze, noise in SUCCESS:
        values = runs.divergences(f"{maze}/planner/{noise}")
        value, interval = round(float(values.mean()), 4) if len(values) else None, rounded(mean_interval(values))
        name = f"{MAZE[maze]}, {noise} noise: mean Lp / Lo over pairs with Lo > {LONG:g} cm"
        holds = decided(value, interval, len(values), *DIVERGENCE, runs.quick)
        out.append(Claim(name, value, "{} to {}".format(*DIVERGENCE), holds, "required", f"{SOURCE}, figure 8", len(values), interval))
    return out


def _alike(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for maze in MAZE:
        low, high = (runs.divergences(f"{maze}/planner/{noise}") for noise in ("low", "high"))
        n = min(len(low), len(high))
        value = round(float(np.median(high) / np.median(low)), 4) if n else None
        interval = rounded(ratio_interval(high, low)) if n else None
        name = f"{MAZE[maze]}: the medians of Lp / Lo at high and low noise differ by at most {ALIKE:.0%}"
        holds = decided(value, interval, n, 1 - ALIKE, 1 + ALIKE, runs.quick)
        out.append(Claim(name, value, f"{1 - ALIKE:g} to {1 + ALIKE:g}", holds, "required", f"{SOURCE}, figure 8", n, interval))
    return out


def _routes(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for obstacle, says, onset, duration, way, *least in ROUTES:
        for noise, at_least in zip(("low", "high"), least, strict=True):
            rows = between(runs.kept(obstacle, noise), onset, duration)
            hits, n = count(rows, lambda r, way=way: r["route"] == way)
            name = f"case 3, {obstacle} obstacle, {noise} noise: {says}"
            out.append(share(name, hits, n, at_least, source=f"{SOURCE}, figures 13, 15 and 16", quick=runs.quick))
    return out
