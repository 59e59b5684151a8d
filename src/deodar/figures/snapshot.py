"""A variable at one time: a value, a curve, or a map."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from deodar.errors import RecordError, option
from deodar.figures import _color, _draw, _lines, _map, _style
from deodar.figures._moving import Changing, frames, limits, texts
from deodar.figures._view import TRIAL, View, other_kind, values

ACROSS = False


def snapshot(variable: xarray.DataArray, **view: Any) -> Figure:
    """Draw one variable at one time, by default the last.

    A value of a node is drawn over the swept parameter or the trials, a field of one dimension as a curve, a
    field of two dimensions as a map.

    Args:
        variable: a variable of a record, of up to two dimensions.
        view: see `dd.figures.View`: at, trial, where.
    """
    return _draw.alone(size, fill, variable, view)


def suits(view: View) -> bool:
    """Return whether this is the default kind for a variable."""
    return len(view.space) <= 2 and len(view.times) == 1


def size(view: View) -> tuple[float, float]:
    """Width and height, inches."""
    if len(view.space) == 2:
        return _style.SINGLE, min(5.0, 0.6 + 2.4 * _map.shape(view, *view.space))
    return _style.SINGLE, _style.PANEL


def fill(place: FigureBase, view: View) -> None:
    """Draw into a figure, or into a part of one."""
    paint(place.subplots(), view)


def paint(ax: Axes, view: View) -> None:
    """Draw into axes."""
    if len(view.space) > 2:
        raise RecordError(
            f"has {len(view.space)} axes; a snapshot has at most two",
            where=view.name,
            fix=other_kind("projection"),
        )
    k = view.instant()
    if len(view.space) == 2:
        _plane(ax, view, k)
    elif view.space:
        v = view.chosen()
        v = v.isel({view.time: k}) if view.time in v.dims else v
        _lines.curves(ax, v, view.points(view.space[0]), view.space[0], view)
        ax.set_xlabel(view.axis_label(view.space[0]))
        ax.set_ylabel(view.label())
    else:
        _values(ax, view, k)
    if len(view.times) > 1:
        _title(ax, view.time_label(view.times[k]))


def moving(ax: Axes, view: View, times: Sequence[float]) -> Changing | None:
    """Draw into axes, and return what changes from one of the times to the next; None for values of nodes."""
    if not view.space or view.time not in view.variable.dims:
        return None
    across = view.space[0]

    def part(k: int) -> xarray.DataArray:
        return view.one()[k] if len(view.space) == 2 else view.chosen().isel({view.time: k})

    low, high = limits(
        (values(part(view.nearest(t))) for t in times), view, view.threshold, 0.05 * (len(view.space) == 1)
    )
    paint(ax, dc.replace(view, at=[view.times[view.nearest(times[0])]], value_range=(low, high)))
    titles, note = texts([ax], ax, ax.get_title()), view.note() if len(view.space) == 2 else ""

    def show(time: float) -> None:
        k = view.nearest(time)
        if len(view.space) == 2:
            ax.get_images()[0].set_data(values(part(k)).T)
        else:
            for line, row in zip(lines, _lines.rows(part(k), across), strict=True):
                line.set_ydata(row)
        for title in titles:
            title.set_text(", ".join(t for t in (note, view.time_label(view.times[k])) if t))

    lines = [line for line in ax.get_lines() if line.get_label() != _lines.LEVEL]
    return Changing([*ax.get_images(), *lines, *frames([ax]), *titles], show)


def _plane(ax: Axes, view: View, k: int) -> None:
    shown = values(view.one()[k])
    colors = _color.of([shown], view, view.threshold)
    _map.paint(ax, shown, view, view.space[0], view.space[1], colors)
    _color.bar(ax.figure, colors, ax, view.label(), view.threshold)
    _title(ax, view.note())


def _values(ax: Axes, view: View, k: int) -> None:
    """Draw the values over the points of a sweep, each trial as a dot, with their mean; without a sweep, over
    the trials.
    """
    v = view.chosen()
    v = v.isel({view.time: k}) if view.time in v.dims else v
    swept = [d for d in view.sweeps if d in v.dims]
    color = _style.port_color(view.name)
    if len(swept) > 1:
        raise RecordError(
            f"was swept over {', '.join(swept)}; one of them is drawn",
            where=view.name,
            fix=option("Choose values:", "where", "PATH=VALUE", "{PATH: value}"),
        )
    if not swept:
        across = v[TRIAL].values if TRIAL in v.dims else np.zeros(1)
        ax.plot(across, np.atleast_1d(values(v)), "o", markersize=3, color=color)
        ax.set_xlabel("trial" if TRIAL in v.dims else "")
        ax.margins(x=0.05)
        if TRIAL not in v.dims:
            ax.set_xticks([])
    else:
        x = v[swept[0]].values
        rows = values(v.transpose(swept[0], ...)).reshape(len(x), -1)
        if rows.shape[1] > 1:
            ax.plot(x, rows, "o", markersize=2, alpha=0.35, color=color, markeredgewidth=0)
        label = f"mean of {rows.shape[1]} trials" if rows.shape[1] > 1 else None
        ax.plot(
            x,
            rows.mean(1, dtype=float),
            "o-",
            markersize=3.5,
            color=color,
            label=label,
        )
        ax.set_xlabel(swept[0])
        ax.margins(x=0.05)
        if label:
            ax.legend(loc="best")
    _lines.level(ax, view)
    _lines.limits(ax, view)
    ax.set_ylabel(view.label())


def _title(ax: Axes, text: str) -> None:
    """Write a short title with information that the axes do not show."""
    if text:
        ax.set_title(", ".join(t for t in (ax.get_title(), text) if t))
