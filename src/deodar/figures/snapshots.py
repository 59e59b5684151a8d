"""A field at several times, side by side on one scale."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
import xarray
from matplotlib.figure import Figure, FigureBase

from deodar.errors import RecordError
from deodar.figures import _color, _draw, _lines, _map, _style
from deodar.figures._view import View, other_kind, values

ACROSS = False
MOST = 4
"""Default number of times."""

MOST_ASKED = 24
ROW = 6


def snapshots(variable: xarray.DataArray, **view: Any) -> Figure:
    """Draw a field of one or two dimensions at several times, by default four from the first record to the
    last.

    Args:
        variable: a variable of a record.
        view: see `dd.figures.View`: at, trial, where.
    """
    return _draw.alone(size, fill, variable, view)


def suits(view: View) -> bool:
    """Return whether this is the default kind for a variable."""
    return len(view.space) == 2 and len(view.times) > 1


def size(view: View) -> tuple[float, float]:
    """Width and height, inches."""
    rows, columns = _grid(len(_steps(view)))
    shape = _map.shape(view, *view.space) if len(view.space) == 2 else 0.9
    wide = (_style.DOUBLE - 1.1) / max(columns, 3)
    return _style.DOUBLE if columns > 2 else 1.1 + columns * wide, min(
        9.0, 0.7 + rows * (wide * shape + 0.25)
    )


def fill(place: FigureBase, view: View) -> None:
    """Draw into a figure, or into a part of one."""
    if len(view.space) not in (1, 2):
        fix = other_kind("projection" if view.space else "time_course")
        raise RecordError(
            f"has {len(view.space)} axes; a sequence of snapshots has one or two", where=view.name, fix=fix
        )
    steps = _steps(view)
    rows, columns = _grid(len(steps))
    grid = place.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    planes = values(view.one()[steps])
    colors = _color.of([planes], view, view.threshold)
    for ax, k, shown in zip(grid.flat, steps, planes, strict=False):
        if len(view.space) == 2:
            _map.paint(ax, shown, view, view.space[0], view.space[1], colors)
        else:
            ax.plot(view.points(view.space[0]), shown, color=_style.port_color(view.name))
            _lines.level(ax, view)
            _lines.limits(ax, view)
            ax.set_xlabel(view.axis_label(view.space[0]))
            ax.set_ylabel(view.label())
        ax.set_title(view.time_label(view.times[k]))
    for ax in list(grid.flat)[len(steps) :]:
        ax.set_visible(False)
    for ax in grid.flat:
        ax.label_outer()
    if len(view.space) == 2:
        _color.bar(place, colors, list(grid.flat), view.label(), view.threshold)
    if view.note():
        place.suptitle(view.note(), fontsize=matplotlib.rcParams["axes.titlesize"])


def _steps(view: View) -> list[int]:
    n = len(view.times)
    steps = view.steps(np.unique(np.linspace(0, n - 1, min(MOST, n)).round().astype(int)).tolist())
    if len(steps) > MOST_ASKED:
        raise RecordError(
            f"{len(steps)} times are too many for one figure",
            where=view.name,
            fix=f"Give at most {MOST_ASKED}",
        )
    return steps


def _grid(n: int) -> tuple[int, int]:
    rows = -(-n // ROW)
    return rows, -(-n // rows)
