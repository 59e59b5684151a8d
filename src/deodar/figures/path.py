"""Paths of a vehicle in an arena, seen from above, as a figure or as a GIF."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from deodar.errors import RecordError
from deodar.figures import _draw, _style, maze
from deodar.figures._moving import Changing, frames
from deodar.figures._view import View, values
from deodar.model import output
from deodar.model.unit import unit_seconds
from deodar.worlds._base import World
from deodar.worlds.arena.arena import Arena
from deodar.worlds.arena.view import FLOOR

ACROSS = False
MOST_FRAMES = 600
FINER = 3
"""Number of drawn pixels per shown pixel along each side, for smooth edges."""


def path_figure(variable: xarray.DataArray, arena: World | None = None, **view: Any) -> Figure:
    """Draw paths: x across, y upwards, one line for each trial and each point of a sweep.

    Args:
        variable: recorded reading of a sensor `place` or `pose`: x and y, or x, y and heading.
        arena: the arena of the record, whose present walls and obstacles are drawn; none: the path alone.
        view: see `dd.figures.View`: trial, where.
    """
    return _draw.alone(size, fill, variable, {"world": arena, **view})


def suits(view: View) -> bool:
    """Return whether this is the default kind for a variable: never, as two samples need not be a
    position.
    """
    return False


def size(view: View) -> tuple[float, float]:
    """Width and height, inches."""
    if view.world is None:
        return _style.SINGLE, _style.SINGLE
    left, low, right, high = maze.borders(_arena(view.world))
    return _style.SINGLE, min(6.0, 0.5 + (_style.SINGLE - 0.5) * (high - low) / (right - left))


def fill(place: FigureBase, view: View) -> None:
    """Draw into a figure, or into a part of one."""
    paint(place.subplots(), view)


def paint(ax: Axes, view: View) -> None:
    """Draw into axes."""
    _paths(ax, view)


def moving(ax: Axes, view: View, times: Sequence[float]) -> Changing:
    """Draw into axes, and return what changes from one of the times to the next: the paths grow."""
    drawn = _paths(ax, view)
    title = ax.set_title(view.time_label(times[0]))

    def show(time: float) -> None:
        k = view.nearest(time)
        for path in drawn:
            path.show(k)
        title.set_text(view.time_label(view.times[k]))

    return Changing([*(artist for path in drawn for artist in path.artists()), *frames([ax]), title], show)


@dc.dataclass(frozen=True)
class DrawnPath:
    """The lines of one path, and the vehicle at its end (none without an arena)."""

    points: np.ndarray
    line: Line2D
    vehicle: Circle | None
    heading: Line2D | None

    def artists(self) -> list[Artist]:
        """Return what moves."""
        return [a for a in (self.line, self.vehicle, self.heading) if a is not None]

    def show(self, k: int) -> None:
        """Show the path up to a record."""
        self.line.set_data(*self.points[: k + 1, :2].T)
        x, y = self.points[k, :2]
        if self.vehicle is not None:
            self.vehicle.set_center((x, y))
            if self.heading is not None:
                angle, radius = self.points[k, 2], self.vehicle.get_radius()
                self.heading.set_data([x, x + radius * math.cos(angle)], [y, y + radius * math.sin(angle)])


def _paths(ax: Axes, view: View) -> list[DrawnPath]:
    arena, drawn = view.world, list[DrawnPath]()
    if arena is not None:
        _ground(ax, _arena(arena))
    for k, points in enumerate(_lines(view)):
        colour = _style.COLORS[k % len(_style.COLORS)]
        (line,) = ax.plot(points[:, 0], points[:, 1], color=colour, linewidth=_style.THICK)
        ax.plot(*points[0, :2], "o", color=_style.COLOR.start, markersize=_style.DOT)
        vehicle = heading = None
        if arena is not None:
            radius = _arena(arena).vehicle.radius / _arena(arena).scale
            vehicle = Circle((0, 0), radius, fill=False, edgecolor=colour, linewidth=_style.MEDIUM)
            ax.add_patch(vehicle)
            if points.shape[1] > 2:
                (heading,) = ax.plot([], [], color=colour, linewidth=_style.MEDIUM)
        drawn.append(DrawnPath(points, line, vehicle, heading))
        drawn[-1].show(len(points) - 1)
    ax.set_aspect("equal")
    unit = f" ({arena.unit})" if isinstance(arena, Arena) else ""
    labels = view.labels or {}
    ax.set_xlabel(labels.get("x", f"x{unit}"))
    ax.set_ylabel(labels.get("y", f"y{unit}"))
    if arena is None:
        ax.margins(0.05)
    return drawn


def animate_path(
    variable: xarray.DataArray | View,
    file: str | Path,
    arena: World,
    width: int = 480,
    stride: int = 1,
    speed: float = 1.0,
    force: bool = False,
) -> Path:
    """Write a GIF of paths as they grow.

    Args:
        variable: recorded reading of a sensor `place` or `pose`; a `dd.figures.View` of it draws one
            trial, or one point of a sweep.
        file: path of the GIF; it ends in .gif.
        arena: the arena of the record.
        width: width in pixels.
        stride: number of records from one frame to the next.
        speed: time of the record divided by time of the video.
        force: whether to replace an existing file.
    """
    # start-up time
    from PIL import Image, ImageDraw

    path, looked = Path(file), variable if isinstance(variable, View) else View(variable)
    if path.suffix.lower() != ".gif":
        raise RecordError(
            f"the name ends in {path.suffix!r}; a video of a path is a GIF",
            where=str(path),
            fix="End it in .gif",
        )
    here = _arena(arena)
    output.claim(path, force)
    lines, times = _lines(looked), looked.times[::stride]
    if not 2 <= len(times) <= MOST_FRAMES:
        raise RecordError(
            f"makes {len(times)} frames; a video has 2 to {MOST_FRAMES}",
            where=looked.name,
            fix="Choose another stride=",
        )
    left, low, right, high = maze.borders(here)
    scale = width * FINER / (right - left)
    height = round((high - low) * scale / FINER)

    def at(x: float, y: float) -> tuple[float, float]:
        return (x - left) * scale, (high - y) * scale

    ground = Image.new("RGB", (width * FINER, height * FINER), _rgb(FLOOR))
    pen = ImageDraw.Draw(ground)
    for item in here.objects.permanent():
        x0, y0, x1, y1 = (v / here.scale for v in item.box)
        pen.rectangle([*at(x0, y1), *at(x1, y0)], fill=_rgb(item.color))
    radius = here.vehicle.radius / here.scale
    frames: list[Image.Image] = []
    for k in range(0, len(looked.times), stride):
        frame = ground.copy()
        pen = ImageDraw.Draw(frame)
        for n, line in enumerate(lines):
            colour = _style.COLORS[n % len(_style.COLORS)]
            if k:
                pen.line(
                    [at(x, y) for x, y in line[: k + 1, :2]], fill=colour, width=2 * FINER, joint="curve"
                )
            x, y = line[k, :2]
            pen.ellipse(
                [*at(x - radius, y + radius), *at(x + radius, y - radius)], outline=colour, width=2 * FINER
            )
            if line.shape[1] > 2:
                ahead = x + radius * math.cos(line[k, 2]), y + radius * math.sin(line[k, 2])
                pen.line([at(x, y), at(*ahead)], fill=colour, width=2 * FINER)
        frames.append(frame.resize((width, height), Image.Resampling.BOX))
    coords = looked.variable.coords
    time = looked.time
    unit = str(coords[time].attrs.get("units", "ms")) if time in coords else "ms"
    step = 1e3 * unit_seconds(unit) * float(np.diff(times).mean()) / speed
    output.write(
        path,
        lambda beside: frames[0].save(
            beside, format="GIF", save_all=True, append_images=frames[1:], duration=max(20, step), loop=0
        ),
    )
    return path


def _ground(ax: Axes, arena: Arena) -> None:
    ax.set_facecolor(FLOOR)
    for item in arena.objects.permanent():
        ax.add_patch(maze.box(arena, item, facecolor=item.color, linewidth=0))
    if arena.goals is not None:
        for x, y in arena.goals / arena.scale:
            ax.plot(x, y, "+", color=_style.COLOR.goal, markersize=_style.CROSS, markeredgewidth=1.5)
    maze.frame(ax, arena)


def _lines(view: View) -> list[np.ndarray]:
    """Return paths (times, 2 or 3), one for each selected trial and point of a sweep."""
    v = view.chosen()
    if len(view.space) != 1 or v.sizes[view.space[0]] not in (2, 3) or view.time not in v.dims:
        raise RecordError(
            "is not a path (x, y and perhaps a heading over time)",
            where=view.name,
            fix="Record a Sensor of place or pose",
        )
    rest = [d for d in v.dims if d not in (view.time, view.space[0])]
    rows = values(v.transpose(*rest, view.time, view.space[0]))
    return list(rows.reshape(-1, *rows.shape[-2:]))


def _arena(world: World) -> Arena:
    if not isinstance(world, Arena):
        raise RecordError(f"a path is drawn into an arena, not into a {type(world).__name__}")
    return world


def _rgb(colour: Sequence[float]) -> tuple[int, int, int]:
    r, g, b = (round(255 * c) for c in colour)
    return r, g, b
