"""A robot that plans and drives: its path, the motivation fields when the plan was complete and later, and
activation over time; and a video of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image, ImageDraw

from deodar.architectures.spa import DIRECTIONS
from deodar.figures import maze
from deodar.figures._style import (
    ACTIVATION,
    COLOR,
    COLORS,
    CROSS,
    DOUBLE,
    MEDIUM,
    SMALL,
    THIN,
    THRESHOLD_LINE,
    style,
)
from deodar.figures._style import figure as sheet
from deodar.model import output
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
    axes.imshow(u.values.T, extent=extent, cmap=ACTIVATION, vmin=-RANGE, vmax=RANGE)
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


SCALE = 4
"""Pixels of a cell."""

BETWEEN = 10
"""Steps between two frames."""

SHOWN_MS = 80
"""Duration of a frame, ms: the video is eight times faster than the robot."""

TONES = 64
"""Colours of a frame: fewer make a smaller file."""

FULL = 8.0
"""Activation at which a colour is fully saturated."""

FLOOR, WALL, OBSTACLE, ROBOT = (250, 250, 248), (70, 70, 74), (215, 185, 135), (20, 20, 20)


def save_animation(result: DrawnRun, file: str | Path) -> Path:
    """Write a GIF: each position in the colours of the behaviours that are motivated there, with the path,
    the robot, walls and goal.
    """
    path = output.claim(file)
    last = len(result.path)
    frames = [_frame(result, k) for k in range(0, last, max(1, BETWEEN // result.every))]
    output.write(
        path,
        lambda beside: frames[0].save(
            beside, format="GIF", save_all=True, append_images=frames[1:], duration=SHOWN_MS, loop=0
        ),
    )
    return path


def _frame(r: DrawnRun, k: int) -> Image.Image:
    x, y = r.record["x"].values, r.record["y"].values
    fields = np.stack([r.record[f"{name}.motivation.activation"].values[k] for name in DIRECTIONS])
    colours = np.array([_rgb(COLOUR[name]) for name in DIRECTIONS], float)
    parts = np.clip(fields, 0.0, FULL) ** 2  # the colours of equally motivated behaviours mix
    mixed = np.einsum("nij,nc->ijc", parts, colours) / np.maximum(parts.sum(axis=0), 1e-6)[..., None]
    share = np.clip(fields.max(axis=0) / FULL, 0.0, 1.0)[..., None] * 0.8
    cells = (1 - share) * np.array(FLOOR) + share * mixed
    image = Image.fromarray(np.clip(np.flipud(cells.transpose(1, 0, 2)), 0, 255).astype(np.uint8))
    image = image.resize((len(x) * SCALE, len(y) * SCALE), Image.Resampling.NEAREST)
    pen = ImageDraw.Draw(image)

    def at(px: float, py: float) -> tuple[float, float]:
        return (px - x[0] + 0.5) * SCALE, (y[-1] + 0.5 - py) * SCALE

    _objects(pen, r, k, at)
    pose = r.record["pose.output"].values
    pen.line([at(*p) for p in pose[: k + 1, :2]] if k else [at(*pose[0, :2])] * 2, fill=ROBOT, width=2)
    px, py, heading = (float(v) for v in pose[k])
    radius = r.arena.vehicle.radius * 100
    pen.ellipse(
        [*at(px - radius, py + radius), *at(px + radius, py - radius)],
        fill=(255, 255, 255),
        outline=ROBOT,
        width=2,
    )
    pen.line(
        [at(px, py), at(px + radius * math.cos(heading), py + radius * math.sin(heading))],
        fill=ROBOT,
        width=3,
    )
    gx, gy = r.goal
    for dx, dy in ((3, 0), (0, 3)):
        pen.line([at(gx - dx, gy - dy), at(gx + dx, gy + dy)], fill=ROBOT, width=3)
    for n, name in enumerate(DIRECTIONS):
        pen.rectangle((22 + 70 * n, 6, 30 + 70 * n, 14), fill=_rgb(COLOUR[name]))
        pen.text((34 + 70 * n, 3), name, fill=(255, 255, 255), font_size=12)
    pen.text((image.width - 76, 3), f"step {k * r.every}", fill=(255, 255, 255), font_size=12)
    return image.quantize(TONES, dither=Image.Dither.NONE)


def _objects(pen: Any, r: DrawnRun, k: int, at: Any) -> None:
    border = [100 * v for v in r.arena.layout.border]
    (width, height), (x0, y0), (x1, y1) = pen.im.size, at(border[0], border[3]), at(border[2], border[1])
    for side in ((0, 0, x0, height), (x1, 0, width, height), (0, 0, width, y0), (0, y1, width, height)):
        pen.rectangle(side, fill=WALL)
    for item in r.arena.objects.all():
        comes = r.obstacle_at is not None and item.name == "obstacle"
        if not comes or k * r.every > (r.obstacle_at or 0):
            left, low, right, high = (100 * v for v in item.box)
            pen.rectangle([*at(left, high), *at(right, low)], fill=OBSTACLE if comes else WALL)


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
