"""A robot that plans and drives: its path, the motivation fields when the plan was complete and later, and
activation over time.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from deodar.architectures.spa import DIRECTIONS
from deodar.figures import maze
from deodar.figures._style import (
    COLOR,
    COLORS,
    CROSS,
    DIVERGING,
    DOUBLE,
    MEDIUM,
    SMALL,
    THIN,
    THRESHOLD_LINE,
    style,
)
from deodar.figures._style import figure as sheet
from deodar.worlds.arena.arena import Arena

COLOUR = dict(zip(DIRECTIONS, COLORS, strict=False))
BEFORE = 20
"""Number of steps before the robot is on the southern route at which the second plan is shown."""

RANGE = 10.0
"""Activation at both ends of the colour scale; inhibition by walls exceeds it."""


class DrawnRun(Protocol):
    """A run of the planner, and the steps of its events; None: the event did not occur."""

    @property
    def record(self) -> xarray.Dataset: ...
    @property
    def arena(self) -> Arena: ...
    @property
    def planned(self) -> int | None: ...
    @property
    def south(self) -> int | None: ...
    @property
    def arrived(self) -> int | None: ...
    @property
    def obstacle_at(self) -> int | None: ...
    @property
    def every(self) -> int: ...
    @property
    def goal(self) -> np.ndarray: ...
    @property
    def sites(self) -> Sequence[tuple[float, float]]: ...
    @property
    def path(self) -> np.ndarray: ...


def plan_figure(result: DrawnRun) -> Figure:
    """Draw the path (as figure 11 of the paper), motivation fields at two times (figure 12), and motivation
    at four positions over time (figure 10).
    """
    r, changed = result, result.obstacle_at is not None
    with style():
        out = sheet(DOUBLE, 6.6 if changed else 4.4)
        halves: Any = out.subfigures(2, 1, height_ratios=(1.0, 1.5 if changed else 0.6))
        places: Any = halves[0].subfigures(1, 3, width_ratios=(1.12, 1.0, 1.0))
        _path(places[0].subplots(), r)
        before = None if r.south is None else r.south - BEFORE
        later = ("another plan", before) if changed else ("at the goal", r.arrived)
        for place, (what, step) in zip(places[1:], (("plan complete", r.planned), later), strict=True):
            place.suptitle(f"{what}, step {step}" if step is not None else f"{what}: never", fontsize=8)
            for axes, name in zip(place.subplots(2, 2).flat, DIRECTIONS, strict=True):
                _motivation(axes, r, name, step)
                axes.set_title(name, color=COLOUR[name], fontweight="bold", pad=2)
        _courses(halves[1], r)
    return out


def _path(axes: Axes, r: DrawnRun) -> None:
    maze.walls(axes, r.arena, (t for t in r.arena.layout.objects))
    for item in r.arena.objects.all():
        if r.obstacle_at is not None and item.name == "obstacle":
            look = {"facecolor": COLOR.obstacle, "edgecolor": COLOR.obstacle_edge, "linewidth": 0.6}
            place = maze.box(r.arena, item, **look)
            axes.add_patch(place)
            x, y = place.get_center()
            axes.text(x, y, f"from\n{r.obstacle_at}", ha="center", va="center", fontsize=SMALL)
    axes.plot(*r.path[:, :2].T, color=COLORS[0])
    axes.plot(*r.path[:: 100 // r.every, :2].T, ".", color=COLORS[0], markersize=4)
    for number, site in enumerate(r.sites, 1):
        axes.plot(*site, "x", color=COLORS[1], markersize=5)
        axes.annotate(
            f"{number}",
            site,
            xytext=(5, -3),
            textcoords="offset points",
            fontsize=8,
            color=COLORS[1],
            fontweight="bold",
        )
    axes.plot(*r.goal, "+", color=COLOR.goal, markersize=CROSS, markeredgewidth=1.8)
    axes.set_title("path, a dot every 100 steps")
    maze.labels(axes, r.arena)


def _motivation(axes: Axes, r: DrawnRun, name: str, step: int | None) -> None:
    axes.axis("off")
    if step is None:
        return
    u = r.record[f"{name}.motivation.activation"].isel(time=step // r.every)
    x, y = u["x"].values, u["y"].values
    extent = (x[0] - 0.5, x[-1] + 0.5, y[0] - 0.5, y[-1] + 0.5)
    axes.imshow(u.values.T, extent=extent, cmap=DIVERGING, vmin=-RANGE, vmax=RANGE)
    axes.contour(x, y, u.values.T, levels=[0.0], colors="black", linewidths=0.4)
    axes.plot(
        *r.record["pose.output"].values[step // r.every, :2],
        "o",
        markerfacecolor="white",
        markeredgecolor="black",
        markersize=3.5,
    )
    axes.plot(*r.goal, "+", color="white", markersize=5)
    left, low, right, high = maze.borders(r.arena)
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)


def _courses(place: Any, r: DrawnRun) -> None:
    rows = place.subplots(len(r.sites) + 1, 1, sharex=True, squeeze=False)[:, 0]
    times = r.record["time"].values
    for number, (axes, (x, y)) in enumerate(zip(rows, r.sites, strict=False), 1):
        for name in DIRECTIONS:
            here = r.record[f"{name}.motivation.activation"].sel(x=x, y=y, method="nearest").values
            axes.plot(times, here, color=COLOUR[name], linewidth=MEDIUM, label=name)
        axes.axhline(0, **THRESHOLD_LINE)
        axes.set_ylabel(f"location {number}")
    for name in DIRECTIONS:
        rows[-1].plot(
            times,
            r.record[f"{name}.strongest.output"].values,
            color=COLOUR[name],
            linewidth=MEDIUM,
            label=name,
        )
    rows[-1].set_ylabel("intention")
    rows[-1].set_xlabel("time (steps of 64 ms)")
    rows[0].legend(loc="upper left", bbox_to_anchor=(1.0, 1.1))
    below = "largest output of the intention fields"
    rows[0].set_title(
        f"activation of the motivation fields at {len(r.sites)} places; below: {below}" if r.sites else below,
        pad=12,
    )
    for axes in rows:
        for step, words in (
            (r.planned, "planned"),
            (r.obstacle_at, "obstacle"),
            (r.arrived, "arrived"),
        ):
            if step is not None:
                axes.axvline(step, color=COLOR.moment, linewidth=THIN)
                if axes is rows[-1]:
                    axes.text(
                        step,
                        1.02,
                        f" {words}",
                        fontsize=SMALL,
                        color=COLOR.threshold,
                        va="bottom",
                        ha="left",
                        transform=axes.get_xaxis_transform(),
                    )
    rows[0].set_xlim(0, times[-1] if r.arrived is None else min(times[-1], r.arrived + 50))
