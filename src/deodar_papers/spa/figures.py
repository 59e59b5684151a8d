"""Figures: success and Lp / Lo, example paths, path choice, velocity."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from deodar.analysis.robot_paths import speeds
from deodar.architectures.spa import maze, place
from deodar.experiments.rows import Row
from deodar.figures._style import COLORS, ROUTES
from deodar_papers.figures.comparison import boxes_figure, shares_figure
from deodar_papers.figures.routes import (
    Panel,
    Speeds,
    StyledPath,
    choice_figure,
    paths_figure,
    routes_figure,
    speeds_figure,
)
from deodar_papers.spa.cases import OBSTACLES
from deodar_papers.spa.condition_runs import METHODS, Runs, between, count
from deodar_papers.spa.route import NONE, NORTH, SOUTH, SWITCH
from deodar_papers.spa.targets import MAZE
from deodar_papers.spa.trials import KEPT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WAYS: dict[str, str] = dict(zip((NORTH, SOUTH, SWITCH, NONE), ROUTES, strict=True))
"""Colours of the routes, as the paper's: green, blue, red; grey for none."""

LABELS = ("planner\nlow", "planner\nhigh", "carrot\nnone", "carrot\nlow", "carrot\nhigh")
EXAMPLES = 6
WINDOW = 10
"""Number of steps over which a velocity is computed."""

MOMENTS = (
    ("early planning", (30, 130)),
    ("late planning", (130, 210)),
    ("early execution", (230, 450)),
    ("late execution", (500, 700)),
)


def draw(runs: Runs) -> dict[str, Figure]:
    """Draw each figure that has data, by the name of the paper's figure."""
    made: dict[str, Callable[[Runs], Figure | None]] = {
        "figure-7-success": success,
        "figure-8-divergence": divergence,
        "figure-9-paths": paths,
        "figure-13-routes": routes,
        "figure-14-velocity": velocity,
        "figure-15-partial": lambda r: choice(r, "partial"),
        "figure-16-full": lambda r: choice(r, "full"),
    }
    drawn = {name: make(runs) for name, make in made.items()}
    return {name: figure for name, figure in drawn.items() if figure is not None}


def success(runs: Runs) -> Figure | None:
    """Draw the share of successful runs with 95 % intervals, for both mazes."""
    counts = {
        title: [count(runs.of(f"{m}/{method}/{noise}"), lambda r: r["success"]) for method, noise in METHODS]
        for m, title in MAZE.items()
    }
    if not any(n for found in counts.values() for _, n in found):
        return None
    return shares_figure(counts, LABELS, 2, "share of runs that succeed")


def divergence(runs: Runs) -> Figure | None:
    """Draw Lp / Lo of all successful runs, for both mazes."""
    values = {
        title: [runs.divergences(f"{m}/{method}/{noise}") for method, noise in METHODS]
        for m, title in MAZE.items()
    }
    if not any(len(v) for found in values.values() for v in found):
        return None
    return boxes_figure(values, LABELS, 1.0, "Lp / Lo")


def paths(runs: Runs) -> Figure | None:
    """Draw six pairs of the large maze, each with low (full line) and high noise (dashed)."""
    rows = [{r["trial"]: r for r in runs.of(f"large/planner/{noise}")} for noise in ("low", "high")]
    both = [k for k in sorted(rows[0]) if k in rows[1]][:EXAMPLES]
    styled = [
        StyledPath(np.asarray(found[k]["path"]), COLORS[n % len(COLORS)], dashed, found[k]["goal"])
        for n, k in enumerate(both)
        for found, dashed in zip(rows, (False, True), strict=True)
    ]
    return paths_figure(maze("large", "none"), styled) if styled else None


def routes(runs: Runs) -> Figure | None:
    """Draw all paths of case 3 by their route."""
    if not any(runs.of(f"{o}/planner/{n}") for o in ("partial", "full") for n in ("low", "high")):
        return None
    panels = [_routes(runs, obstacle, noise) for noise in ("high", "low") for obstacle in ("partial", "full")]
    return routes_figure(maze("z", "none"), panels)


def _routes(runs: Runs, obstacle: str, noise: str) -> Panel:
    rows = runs.kept(obstacle, noise)
    found = {way: between(rows, route=way) for way in WAYS}
    counted = ", ".join(f"{way} {len(taken)}" for way, taken in found.items() if taken)
    styled = [StyledPath(np.asarray(row["path"]), WAYS[way]) for way, taken in found.items() for row in taken]
    _, middle, size = OBSTACLES[obstacle]
    title = f"{obstacle} obstacle, {noise} noise: {counted or 'no runs'}"
    return Panel(title, styled, (*place(*middle), *size))


def velocity(runs: Runs) -> Figure | None:
    """Draw the velocity over time of the first run of each obstacle that appears at four moments; grey: while
    the obstacle is present; full line: low noise, dashed: high noise.
    """
    panels = [
        _velocity(runs, obstacle, words, window)
        for words, window in MOMENTS
        for obstacle in ("partial", "full")
    ]
    return (
        speeds_figure(panels, "speed (cm a step)", "steps of 64 ms")
        if any(p.curves for p in panels)
        else None
    )


def _velocity(runs: Runs, obstacle: str, words: str, window: tuple[int, int]) -> Speeds:
    low, high = (_first(runs, obstacle, noise, window) for noise in ("low", "high"))
    curves = [(*_speed(row), WAYS[row["route"]], row is high) for row in (low, high) if row is not None]
    shaded = None if low is None else (low["onset"], low["onset"] + low["duration"])
    return Speeds(f"{obstacle}, {words}", curves, shaded)


def _speed(row: Row) -> tuple[np.ndarray, np.ndarray]:
    """Return steps and cm a step."""
    steps, over = KEPT * np.arange(len(row["path"])), WINDOW // KEPT
    return steps[over:], speeds(row["path"], steps, over)


def choice(runs: Runs, obstacle: str) -> Figure | None:
    """Draw onset and duration of each run of an obstacle at low noise; colour: route, size: path length."""
    rows = runs.kept(obstacle, "low")
    if not rows:
        return None
    groups = {
        way: (colour, [(r["onset"], r["duration"], 0.1 * r["length"]) for r in between(rows, route=way)])
        for way, colour in WAYS.items()
    }
    there = {way: group for way, group in groups.items() if group[1]}
    return choice_figure(there, (720, 520), ("onset (steps)", "duration (steps)"))


def _first(runs: Runs, obstacle: str, noise: str, window: tuple[int, int]) -> Row | None:
    """Return the first run whose obstacle came in the window and lasted for 150 steps or more."""
    found = between(runs.kept(obstacle, noise), window, (150, 1000))
    return found[0] if found else None
