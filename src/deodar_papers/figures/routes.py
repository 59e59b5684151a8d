"""Many runs through a maze: their paths, speeds, and chosen routes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from deodar.figures import _style, maze
from deodar.worlds.arena.arena import Arena

LINES = {False: "-", True: "--"}
FLOATS = list[tuple[float, ...]]


@dataclass(frozen=True)
class StyledPath:
    """A path and its line style.

    Attributes:
        path: x and y over time, (steps, 2), in the unit of the arena.
        colour: colour of the line.
        dashed: whether the line is dashed.
        goal: x and y of a goal to mark, with the start; None: neither is marked.
    """

    path: np.ndarray
    colour: str
    dashed: bool = False
    goal: Sequence[float] | None = None


@dataclass(frozen=True)
class Panel:
    """Paths in one picture of the maze.

    Attributes:
        title: title above the panel.
        paths: the paths.
        obstacle: x and y of the middle, width and height of an obstacle; None: no obstacle.
    """

    title: str
    paths: Sequence[StyledPath]
    obstacle: tuple[float, float, float, float] | None = None


@dataclass(frozen=True)
class Speeds:
    """Speeds over time in one panel.

    Attributes:
        title: title above the panel.
        curves: for each run the steps, its speeds, a colour, and whether the line is dashed.
        shaded: first and last step with the obstacle; None: not shown.
    """

    title: str
    curves: Sequence[tuple[np.ndarray, np.ndarray, str, bool]] = field(default=())
    shaded: tuple[float, float] | None = None


def paths_figure(arena: Arena, paths: Sequence[StyledPath]) -> Figure:
    """Draw several paths in one maze, with start and goal."""
    with _style.style():
        figure = _style.figure(_style.SINGLE, _style.SINGLE)
        _paint(figure.subplots(), arena, paths, _style.MEDIUM, 1.0)
    return figure


def routes_figure(arena: Arena, panels: Sequence[Panel]) -> Figure:
    """Draw many paths in the same maze, two panels in a row."""
    rows = -(-len(panels) // 2)
    with _style.style():
        figure = _style.figure(_style.DOUBLE, _style.DOUBLE * rows / 2)
        grid: Any = figure.subplots(rows, 2, squeeze=False)
        for ax, panel in zip(grid.flat, panels, strict=False):
            if panel.obstacle is not None:
                x, y, w, h = panel.obstacle
                outline = Rectangle((x - w / 2, y - h / 2), w, h, **_style.OUTLINE)
                ax.add_patch(outline)
            _paint(ax, arena, panel.paths, _style.THIN, 0.6)
            ax.set_title(panel.title)
    return figure


def speeds_figure(panels: Sequence[Speeds], unit: str, step: str) -> Figure:
    """Draw speeds over time, two panels in a row.

    Args:
        panels: the panels.
        unit: label of the speeds.
        step: label of the steps.
    """
    rows = -(-len(panels) // 2)
    with _style.style():
        figure = _style.figure(_style.DOUBLE, 1.25 * rows + 0.4)
        grid: Any = figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False)
        for ax, panel in zip(grid.flat, panels, strict=False):
            for steps, speeds, colour, dashed in panel.curves:
                ax.plot(steps, speeds, LINES[dashed], color=colour, linewidth=_style.MEDIUM)
            if panel.shaded is not None:
                ax.axvspan(*panel.shaded, color=_style.COLOR.window, linewidth=0)
            ax.set_title(panel.title)
        for ax in grid[-1]:
            ax.set_xlabel(f"time ({step})")
        for ax in grid[:, 0]:
            ax.set_ylabel(unit)
    return figure


def choice_figure(
    groups: Mapping[str, tuple[str, FLOATS]], limits: tuple[float, float], labels: tuple[str, str]
) -> Figure:
    """Draw runs as points in the colours of their routes.

    Args:
        groups: for each route its colour, and x, y and size of each run.
        limits: ends of both axes.
        labels: labels of both axes.
    """
    with _style.style():
        figure = _style.figure(_style.SINGLE, 2.8)
        ax = figure.subplots()
        for way, (colour, found) in groups.items():
            x, y, size = zip(*found, strict=True)
            ax.scatter(x, y, size, color=colour, linewidth=0, label=f"{way} ({len(found)})")
        ax.set_xlim(0, limits[0])
        ax.set_ylim(0, limits[1])
        ax.set_xlabel(labels[0])
        ax.set_ylabel(labels[1])
        figure.legend(loc="outside upper center", ncols=4)
    return figure


def _paint(ax: Axes, arena: Arena, paths: Sequence[StyledPath], width: float, alpha: float) -> None:
    maze.walls(ax, arena, arena.objects.permanent())
    maze.labels(ax, arena)
    for c in paths:
        ax.plot(*c.path[:, :2].T, LINES[c.dashed], color=c.colour, linewidth=width, alpha=alpha)
        if c.goal is not None:
            ax.plot(*c.path[0, :2], "o", color=c.colour, markersize=_style.DOT)
            ax.plot(*c.goal, "+", color=_style.COLOR.goal, markersize=_style.CROSS, markeredgewidth=1.2)
