"""The projection of a field of several dimensions onto one or two axes: maximum or integral."""

from __future__ import annotations

import dataclasses as dc
import itertools
from collections.abc import Sequence
from typing import Any, cast

import matplotlib
import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from deodar.errors import RecordError
from deodar.figures import _color, _draw, _lines, _map, _style
from deodar.figures._moving import Changing, frames, limits, texts
from deodar.figures._view import View, other_kind, values

ACROSS = False


def projection(variable: xarray.DataArray, **view: Any) -> Figure:
    """Draw a field of two or more dimensions at one time, projected onto axes.

    Without `axes`, every pair of axes has a panel.

    Args:
        variable: a variable of a record.
        view: see `dd.figures.View`: at, trial, where, axes, reduce.
    """
    return _draw.alone(size, fill, variable, view)


def suits(view: View) -> bool:
    """Return whether this is the default kind for a variable."""
    return len(view.space) > 2


def size(view: View) -> tuple[float, float]:
    """Width and height, inches."""
    pairs = _onto(view)
    if len(pairs) == 1:
        flat = len(pairs[0]) == 1
        return _style.SINGLE, _style.PANEL if flat else min(5.0, 0.6 + 2.4 * _map.shape(view, *pairs[0]))
    rows, _ = _grid(len(pairs))
    return _style.DOUBLE, 0.5 + rows * 2.1


def fill(place: FigureBase, view: View) -> None:
    """Draw into a figure, or into a part of one."""
    pairs, k = _onto(view), view.instant()
    shown = view.one()[k]
    shown = shown.copy(data=values(shown))
    planes = [_project(shown, onto, view) for onto in pairs]
    rows, columns = _grid(len(pairs))
    grid = list(place.subplots(rows, columns, squeeze=False).flat)
    threshold = _threshold(view)
    colors = _color.of(planes, view, threshold)
    for ax, onto, plane in zip(grid, pairs, planes, strict=False):
        _panel(ax, view, onto, plane, colors, threshold)
    title = _title(view, k)
    if len(pairs[0]) == 2:
        _color.bar(place, colors, grid if len(grid) > 1 else grid[0], _label(view, pairs), threshold)
    if title and len(grid) == 1:
        grid[0].set_title(title)
    elif title:
        place.suptitle(title, fontsize=matplotlib.rcParams["axes.titlesize"])


def moving(place: FigureBase, view: View, times: Sequence[float]) -> Changing | None:
    """Draw into a figure, and return what changes from one of the times to the next."""
    if view.time not in view.variable.dims:
        return None

    def planes(k: int) -> list[np.ndarray]:
        shown = view.one()[k]
        shown = shown.copy(data=values(shown))
        return [_project(shown, onto, view) for onto in _onto(view)]

    found = (plane for t in times for plane in planes(view.nearest(t)))
    low, high = limits(found, view, _threshold(view), 0.05 * (len(_onto(view)[0]) == 1))
    first = view.times[view.nearest(times[0])]
    fill(place, dc.replace(view, at=[first], value_range=(low, high)))
    axes = [ax for ax in cast(Any, place).axes if ax.get_label() != "<colorbar>"]
    written = texts(axes, place, _title(view, view.nearest(times[0])))

    def show(time: float) -> None:
        k = view.nearest(time)
        for ax, plane in zip(axes, planes(k), strict=False):
            if plane.ndim == 2:
                ax.get_images()[0].set_data(plane.T)
            else:
                ax.get_lines()[0].set_ydata(plane)
        for text in written:
            text.set_text(_title(view, k))

    inside = [artist for ax in axes for artist in (*ax.get_images(), *ax.get_lines())]
    return Changing([*inside, *frames(axes), *written], show)


def _threshold(view: View) -> float | None:
    return view.threshold if view.reduce == "maximum" else None


def _title(view: View, k: int) -> str:
    """Return the time and the note of a projection."""
    time = view.time_label(view.times[k]) if len(view.times) > 1 else ""
    return ", ".join(t for t in (time, view.note()) if t)


def _panel(
    ax: Axes, view: View, onto: tuple[str, ...], values: np.ndarray, colors: Any, threshold: float | None
) -> None:
    if len(onto) == 2:
        _map.paint(ax, values, view, onto[0], onto[1], colors)
        return
    ax.plot(view.points(onto[0]), values, color=_style.port_color(view.name))
    if threshold is not None:
        _lines.level(ax, view)
    _lines.limits(ax, view)
    ax.set_xlabel(view.axis_label(onto[0]))
    ax.set_ylabel(_label(view, [onto]))


def _onto(view: View) -> list[tuple[str, ...]]:
    space = view.space
    if len(space) < 2:
        raise RecordError(
            f"has {len(space)} axes; a projection needs two or more",
            where=view.name,
            fix=other_kind("snapshot"),
        )
    if view.axes is None:
        return list(itertools.combinations(space, 2))
    if not 1 <= len(view.axes) <= 2 or len(set(view.axes)) < len(view.axes):
        raise RecordError(
            f"a projection goes onto one axis or two, not {', '.join(view.axes) or 'none'}", where=view.name
        )
    return [tuple(view.axes)]


def _project(values: xarray.DataArray, onto: tuple[str, ...], view: View) -> np.ndarray:
    away = [d for d in view.space if d not in onto]
    if view.reduce == "maximum":
        return values.max(away).transpose(*onto).values
    cell = np.prod([np.ptp(view.extent(d)) / values.sizes[d] for d in away])
    return values.sum(away, dtype=np.float64).transpose(*onto).values * float(cell)


def _label(view: View, pairs: list[tuple[str, ...]]) -> str:
    if "value" in (view.labels or {}):
        return view.label()
    away = [d for d in view.space if d not in pairs[0]]
    over = f" over {', '.join(map(str, away))}" if len(pairs) == 1 and away else ""
    return (
        f"{view.reduce}{over} of {view.label()}"
        if len(pairs) == 1 and away
        else f"{view.reduce} of {view.label()}"
    )


def _grid(n: int) -> tuple[int, int]:
    columns = min(n, 3)
    return -(-n // columns), columns
