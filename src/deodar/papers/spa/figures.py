"""The figures: success and Lp / Lo, example paths, path choice, velocity."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from deodar.analysis.statistics import wilson
from deodar.architectures.spa import maze, place
from deodar.experiments.rows import Row
from deodar.figures import _style
from deodar.papers.spa.cases import OBSTACLES
from deodar.papers.spa.route import NONE, NORTH, SOUTH, SWITCH
from deodar.papers.spa.runs import METHODS, Runs, between, count
from deodar.papers.spa.targets import MAZE
from deodar.papers.spa.trials import KEPT

ROUTES = {NORTH: "#009e73", SOUTH: "#0072b2", SWITCH: "#d55e00", NONE: "#999999"}
"""Colours of the routes, as the paper's: green, blue, red."""

LABELS = ("planner\nlow", "planner\nhigh", "carrot\nnone", "carrot\nlow", "carrot\nhigh")
EXAMPLES = 6
WINDOW = 10
"""Steps over which a velocity is taken."""

MOMENTS = (
    ("early planning", (30, 130)),
    ("late planning", (130, 210)),
    ("early execution", (230, 450)),
    ("late execution", (500, 700)),
)
Draw = Callable[[Runs], Figure | None]


def draw(runs: Runs) -> dict[str, Figure]:
    """Each figure of which there is something to show, by the name of the paper's."""
    made: dict[str, Draw] = {
        "figure-7-success": success,
        "figure-8-divergence": divergence,
        "figure-9-paths": paths,
        "figure-13-routes": routes,
        "figure-14-velocity": velocity,
        "figure-15-partial": lambda r: choice(r, "partial"),
        "figure-16-full": lambda r: choice(r, "full"),
    }
    with _style.style():
        drawn = {name: make(runs) for name, make in made.items()}
    return {name: figure for name, figure in drawn.items() if figure is not None}


def success(runs: Runs) -> Figure | None:
    """Share of successful runs with 95 % intervals, for both mazes."""
    counts = {
        m: [count(runs.of(f"{m}/{method}/{noise}"), lambda r: r["success"]) for method, noise in METHODS]
        for m in MAZE
    }
    if not any(n for found in counts.values() for _, n in found):
        return None
    figure, axes = _two()
    for ax, (m, found) in zip(axes, counts.items(), strict=True):
        for k, (hits, n) in enumerate(found):
            interval = wilson(hits, n)
            if interval is not None:
                ax.bar(k, hits / n, color=_style.COLORS[0 if k < 2 else 4], width=0.7)
                ax.plot([k, k], interval, color="black", linewidth=0.8)
                ax.text(k, 0.03, f"{hits}/{n}", ha="center", color="white", fontsize=6.5)
        ax.set_ylim(0, 1.02)
        _conditions(ax, MAZE[m], "share of runs that succeed")
    return figure


def divergence(runs: Runs) -> Figure | None:
    """Lp / Lo of all runs that succeed, for both mazes."""
    values = {m: [runs.divergences(f"{m}/{method}/{noise}") for method, noise in METHODS] for m in MAZE}
    if not any(len(v) for found in values.values() for v in found):
        return None
    figure, axes = _two()
    for ax, (m, found) in zip(axes, values.items(), strict=True):
        there = [k for k, v in enumerate(found) if len(v)]
        if there:
            ax.boxplot(
                [found[k] for k in there],
                positions=there,
                widths=0.6,
                sym=".",
                medianprops={"color": "black"},
            )
        ax.axhline(1.0, color=_style.THRESHOLD, linewidth=0.6, linestyle=":")
        _conditions(ax, MAZE[m], "Lp / Lo")
    return figure


def paths(runs: Runs) -> Figure | None:
    """Six pairs of the large maze, each with low (full line) and high noise (dashed)."""
    rows = [{r["trial"]: r for r in runs.of(f"large/planner/{noise}")} for noise in ("low", "high")]
    both = [k for k in sorted(rows[0]) if k in rows[1]][:EXAMPLES]
    if not both:
        return None
    figure = _style.figure(_style.SINGLE, _style.SINGLE)
    ax = figure.subplots()
    _ground(ax, "large")
    for n, k in enumerate(both):
        for found, line in zip(rows, ("-", "--"), strict=True):
            course = np.asarray(found[k]["path"])
            ax.plot(
                course[:, 0], course[:, 1], line, color=_style.COLORS[n % len(_style.COLORS)], linewidth=0.9
            )
        ax.plot(*rows[0][k]["path"][0], "o", color=_style.COLORS[n % len(_style.COLORS)], markersize=2.5)
        ax.plot(*rows[0][k]["goal"], "+", color="black", markersize=5)
    return figure


def routes(runs: Runs) -> Figure | None:
    """All paths of case 3 by the route that they took."""
    if not any(runs.of(f"{o}/planner/{n}") for o in ("partial", "full") for n in ("low", "high")):
        return None
    figure = _style.figure(_style.DOUBLE, _style.DOUBLE)
    grid = figure.subplots(2, 2)
    for across, obstacle in enumerate(("partial", "full")):
        for down, noise in enumerate(("high", "low")):
            ax = grid[down, across]
            _ground(ax, "z")
            _, middle, (w, h) = OBSTACLES[obstacle]
            x, y = place(*middle)
            ax.add_patch(
                Rectangle(
                    (x - w / 2, y - h / 2),
                    w,
                    h,
                    facecolor="none",
                    edgecolor="black",
                    linewidth=0.7,
                    linestyle="--",
                )
            )
            rows = runs.kept(obstacle, noise)
            for way, colour in ROUTES.items():
                for row in between(rows, route=way):
                    course = np.asarray(row["path"])
                    ax.plot(course[:, 0], course[:, 1], color=colour, linewidth=0.4, alpha=0.6)
            found = [
                f"{way} {sum(r['route'] == way for r in rows)}"
                for way in ROUTES
                if any(r["route"] == way for r in rows)
            ]
            ax.set_title(f"{obstacle} obstacle, {noise} noise: {', '.join(found) or 'no runs'}")
    return figure


def velocity(runs: Runs) -> Figure | None:
    """Velocity over time of the first run of each obstacle that appears at four moments; grey: while it is
    there.
    """
    chosen = [
        (o, words, [_first(runs, o, n, window) for n in ("low", "high")])
        for words, window in MOMENTS
        for o in ("partial", "full")
    ]
    if not any(row is not None for _, _, rows in chosen for row in rows):
        return None
    figure = _style.figure(_style.DOUBLE, 1.25 * len(MOMENTS) + 0.4)
    grid = figure.subplots(len(MOMENTS), 2, sharex=True, sharey=True)
    for ax, (obstacle, words, rows) in zip(grid.ravel(), chosen, strict=True):
        for row, line in zip(rows, ("-", "--"), strict=True):
            if row is None:
                continue
            course = np.asarray(row["path"])
            over = WINDOW // KEPT
            speed = np.linalg.norm(course[over:] - course[:-over], axis=1) / WINDOW
            ax.plot(
                KEPT * np.arange(over, len(course)), speed, line, color=ROUTES[row["route"]], linewidth=0.8
            )
            if line == "-":
                ax.axvspan(row["onset"], row["onset"] + row["duration"], color="#dddddd", linewidth=0)
        ax.set_title(f"{obstacle}, {words}", fontsize=7)
    for ax in grid[-1]:
        ax.set_xlabel("time (steps of 64 ms)")
    for ax in grid[:, 0]:
        ax.set_ylabel("cm a step")
    return figure


def choice(runs: Runs, obstacle: str) -> Figure | None:
    """Onset and duration of each run of an obstacle at low noise; colour: route, size: path length."""
    rows = runs.kept(obstacle, "low")
    if not rows:
        return None
    figure = _style.figure(_style.SINGLE, 2.8)
    ax = figure.subplots()
    for way, colour in ROUTES.items():
        found = between(rows, route=way)
        if found:
            size = [0.1 * r["length"] for r in found]
            ax.scatter(
                [r["onset"] for r in found],
                [r["duration"] for r in found],
                size,
                color=colour,
                linewidth=0,
                label=f"{way} ({len(found)})",
            )
    ax.set_xlim(0, 720)
    ax.set_ylim(0, 520)
    ax.set_xlabel("onset (steps)")
    ax.set_ylabel("duration (steps)")
    figure.legend(loc="outside upper center", ncols=4)
    return figure


def _first(runs: Runs, obstacle: str, noise: str, window: tuple[int, int]) -> Row | None:
    """The first run whose obstacle came in the window and lasted for 150 steps or more."""
    found = between(runs.kept(obstacle, noise), window, (150, 1000))
    return found[0] if found else None


def _two() -> tuple[Figure, Sequence[Axes]]:
    figure = _style.figure(_style.DOUBLE, 2.4)
    axes: Any = figure.subplots(1, 2)
    return figure, list(axes)


def _conditions(ax: Axes, title: str, what: str) -> None:
    ax.set_xticks(range(len(LABELS)), LABELS)
    ax.set_xlim(-0.6, len(LABELS) - 0.4)
    ax.set_title(title)
    ax.set_ylabel(what)


def _ground(ax: Axes, name: str) -> None:
    arena = maze(name, "none")
    left, low, right, high = (v / arena.scale for v in arena.layout.border)
    for thing in arena.furniture.standing():
        x0, y0, x1, y1 = (v / arena.scale for v in thing.box)
        ax.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, facecolor="#bbbbbb", linewidth=0))
    ax.set_xlim(left, right)
    ax.set_ylim(low, high)
    ax.set_aspect("equal")
    ax.set_xlabel("x (cm)")
    ax.set_ylabel("y (cm)")
    for spine in ax.spines.values():
        spine.set_visible(True)
