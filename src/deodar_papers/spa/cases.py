"""Design: the conditions, and the start of each of their trials."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.architectures.follow_the_carrot import Carrot
from deodar.architectures.spa import CASE_3, MAZES, STEP_MS, maze, place
from deodar.codec import JsonObject
from deodar.worlds.arena.arena import Arena
from deodar_papers.spa.pairs import COUNT, HEADINGS, pairs, same

LIMIT = 3000
"""Most steps of a run (section 5.1)."""

RADIUS = 7.0
"""Distance from the goal within which a run succeeds, cm (published simulation)."""

STAY = 40
"""Steps near the goal after which a run ends: the published simulation counts 20 readings of the place, one
at every second step.
"""

QUICK = 20
"""Runs of a condition with --quick; also those of case 3 without an obstacle."""

NARRATIVE_RUNS, NARRATIVE_QUICK = 20, 6
"""Runs of the narrative of section 5.2; six are the fewest whose median has an interval."""

RUNS = 240
"""Runs of case 3 for each obstacle and level of noise."""

ONSETS, DURATIONS = (30, 700), (2, 500)
"""Interval from which both are drawn, in steps, without the ends (section 4)."""

DRAW = {"full": 3, "partial": 4}
"""Seeds of the draws; both levels of noise have the same."""

OBSTACLES = {
    "full": ("Maze_Wall1", (15.0, 40.0), (10.0, 20.0)),
    "partial": ("Maze_Wall3", (22.5, 40.0), (30.0, 15.0)),
}
"""For each obstacle its name in the world file, row and column of its middle, and its size along x and y, cm.
"""

NARRATIVE = (336, 400)
"""Onset and duration of the full obstacle in the run of figures 10 to 12.

The paper does not print its duration; it is longer than the robot waits.
"""

MOVES, GOES = 336, (85, 20)
"""Step at which the goal moves, and its new row and column.

A choice of deodar: the paper says that the goal may move, and shows no such run.
"""

CARROT = Carrot(speed=400.0, gain=400.0)
"""Neither number is published.

These succeed most often in the Z-maze among those of `TUNING`, whatever the contact: a claim checks it.
"""

WEAK = Carrot(speed=400.0, gain=50.0)
"""A gain so weak that the carrot cuts corners by far: with it and sticking contact the results in the large
maze resemble those of the paper.
"""

TUNING = tuple((speed, gain) for speed in (400.0, 800.0) for gain in (50.0, 100.0, 200.0, 400.0, 1000.0))


LIKE_LOW, REFLECTIONS = 1.0, (0.8, 1.0)
"""Other values of two choices of deodar or of the published code: the factor on the position input with high
noise (1, as with low noise; published code: 1.2), and the reflection of infrared light by walls (fitted: 0.6;
table of the sensors: 1).
"""

VARIED, VARIED_QUICK = 40, 10
"""Runs of such a condition in the large maze, where each takes long.

Of 40 runs that all succeed the 95 % interval begins at 0.912, so that a difference of 0.1 from 100 of 100 is
excluded; of 40 runs of which half succeed it is 0.35 to 0.65.
"""


@dataclass(frozen=True)
class Condition:
    """A condition: runs that differ in their pairs or draws and in their noise.

    Attributes:
        name: maze or obstacle, method, noise: keys of rows begin with it.
        maze: z or large.
        method: planner or carrot.
        noise: none, low or high.
        trials: numbers of its runs.
        left_out: numbers of the omitted runs, whose start is their goal.
        obstacle: full, partial or none.
        carrot: parameters of the carrot.
        contact: slide or stick.
        factor: factor on the position input; None: that of the level of noise.
        reflection: share of infrared light that walls reflect; None: that of the arena.
        many_starts: whether each run has its own pair; otherwise all have that of case 3.
    """

    name: str
    maze: str
    method: str
    noise: str
    trials: tuple[int, ...]
    left_out: tuple[int, ...] = ()
    obstacle: str = ""
    carrot: Carrot | None = None
    contact: str = "slide"
    factor: float | None = None
    reflection: float | None = None
    many_starts: bool = True

    @property
    def terms(self) -> dict[str, str | float]:
        """Return the terms of the planner that differ from the published ones, by name."""
        stick = {"contact": self.contact} if self.contact != "slide" else {}
        return stick | {
            name: value
            for name, value in (("factor", self.factor), ("reflection", self.reflection))
            if value is not None
        }

    def key(self, trial: int) -> str:
        """The key of a row."""
        return f"{self.name}/{trial:03}"


@functools.lru_cache(maxsize=2)
def conditions(quick: bool) -> dict[str, Condition]:
    """All conditions by name, those of short runs first."""
    out: list[Condition] = []
    varied: list[Condition] = []
    for name in MAZES:
        left = same(name)
        numbers = tuple(k for k in range(COUNT) if k not in left)[: QUICK if quick else COUNT]
        out += _carrots(name, numbers, tuple(left))
        out += [
            Condition(f"{name}/planner/{noise}", name, "planner", noise, numbers, tuple(left))
            for noise in ("low", "high")
        ]
        varied += _varied(
            name, numbers if name == "z" else numbers[: VARIED_QUICK if quick else VARIED], tuple(left)
        )
    out += _narrated(quick)
    small = [c for c in out if c.method == "carrot" or c.name.startswith(("free", "narrative", "moved"))]
    return {c.name: c for c in [*small, *(c for c in out if c not in small), *varied]}


def _carrots(name: str, numbers: tuple[int, ...], left: tuple[int, ...]) -> list[Condition]:
    """Return the followers of a carrot, in the Z-maze also those of its tuning."""
    kinds = [
        (f"{what}/{noise}", noise, carrot, contact)
        for what, carrot, contact in (
            ("carrot", CARROT, "slide"),
            ("sticking-carrot", CARROT, "stick"),
            ("weak-carrot", WEAK, "stick"),
        )
        for noise in ("none", "low", "high")
    ]
    if name == "z":
        kinds += [
            (f"tuning/{speed:g}-{gain:g}-{contact}", "low", Carrot(speed, gain), contact)
            for speed, gain in TUNING
            for contact in ("slide", "stick")
        ]
    return [
        Condition(f"{name}/{what}", name, "carrot", noise, numbers, left, carrot=carrot, contact=contact)
        for what, noise, carrot, contact in kinds
    ]


def _narrated(quick: bool) -> list[Condition]:
    """Return the planner in the Z-maze from one start: free, carried, and with obstacles."""
    few = tuple(range(QUICK))
    narrated = tuple(range(NARRATIVE_QUICK if quick else NARRATIVE_RUNS))
    drawn = few if quick else tuple(range(RUNS))
    kinds = [("free", few, ""), ("moved", few, ""), ("narrative", narrated, "narrative")]
    kinds += [(what, drawn, what) for what in DRAW]
    return [
        Condition(
            f"{what}/planner/{noise}", "z", "planner", noise, runs, obstacle=obstacle, many_starts=False
        )
        for noise in ("low", "high")
        for what, runs, obstacle in kinds
    ]


def _varied(name: str, numbers: tuple[int, ...], left: tuple[int, ...]) -> list[Condition]:
    """Return the planner with sticking contact, with the same position input at both levels of noise, and
    with walls that reflect better.
    """
    out = [
        Condition(f"{name}/sticking-planner/{noise}", name, "planner", noise, numbers, left, contact="stick")
        for noise in ("low", "high")
    ]
    out.append(
        Condition(
            f"{name}/factor-{LIKE_LOW}-planner/high", name, "planner", "high", numbers, left, factor=LIKE_LOW
        )
    )
    return out + [
        Condition(f"{name}/reflection-{r}-planner/low", name, "planner", "low", numbers, left, reflection=r)
        for r in REFLECTIONS
    ]


@functools.lru_cache(maxsize=4)
def windows(obstacle: str) -> np.ndarray:
    """Return onset and duration in steps of the obstacle in each run, (runs, 2)."""
    if obstacle == "narrative":
        return np.tile(np.asarray([NARRATIVE]), (NARRATIVE_RUNS, 1))
    draw = np.random.default_rng(DRAW[obstacle])
    return np.stack([draw.integers(low + 1, high, size=RUNS) for low, high in (ONSETS, DURATIONS)], axis=1)


def world(condition: Condition) -> Arena:
    """Return the arena of a condition, for all its trials."""
    others: dict[str, Any] = {"contact": condition.contact}
    if condition.reflection is not None:
        others["reflection"] = condition.reflection
    if condition.many_starts:
        starts, goals = pairs(condition.maze)
        return maze(condition.maze, condition.noise, starts, goals, **others)
    arena = maze(
        condition.maze,
        condition.noise,
        (*place(*CASE_3[0]), HEADINGS[condition.maze]),
        place(*CASE_3[1]),
        **others,
    )
    if condition.obstacle:
        name, middle, size = OBSTACLES["full" if condition.obstacle == "narrative" else condition.obstacle]
        times = windows(condition.obstacle)
        arena.place(
            name, place(*middle), size, windows=STEP_MS * np.stack([times[:, 0], times.sum(axis=1)], axis=1)
        )
    return arena


def design(quick: bool) -> JsonObject:
    """Return the settings of the design, as plain data."""
    found = conditions(quick).values()
    numbers = {
        "limit": LIMIT,
        "radius": RADIUS,
        "stay": STAY,
        "obstacles": [[k, *map(str, v)] for k, v in OBSTACLES.items()],
        "moves": [MOVES, *GOES],
    }
    draws = {
        "draws": {what: windows(what).tolist() for what in DRAW},
        "pairs": {name: [p.tolist() for p in pairs(name)] for name in MAZES},
    }
    own = {
        "runs": {c.name: len(c.trials) for c in found},
        "carrots": {c.name: str(c.carrot) for c in found if c.carrot},
        "planners": {c.name: c.terms for c in found if c.terms and not c.carrot},
    }
    return {**own, **numbers, **draws}
