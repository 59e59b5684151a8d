"""Values over time: a node, a motor variable, or a field at selected positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from deodar import renamed
from deodar.errors import RecordError
from deodar.figures import _draw, _lines, _style
from deodar.figures._view import TIME, View

ACROSS = True
PLACE = "place"


def time_course(variable: xarray.DataArray, **view: Any) -> Figure:
    """Draw one variable over time; several trials are thin lines with their mean, sweep points are colours.

    Args:
        variable: a variable of a record.
        view: see `dd.figures.View`: trial, where, places.
    """
    return _draw.alone(size, fill, variable, view)


def suits(view: View) -> bool:
    """Return whether this is the default kind for a variable."""
    return not view.space and len(view.times) > 1


def size(view: View) -> tuple[float, float]:
    """Width and height, inches."""
    return _style.SINGLE, _style.PANEL


def fill(place: FigureBase, view: View) -> None:
    """Draw into a figure, or into a part of one."""
    paint(place.subplots(), view)


def paint(ax: Axes, view: View) -> None:
    """Draw into axes."""
    v, labels = view.chosen(), None
    if TIME not in v.dims:
        v = v.expand_dims(TIME)
    if view.space:
        v, labels = _at_places(v, view)
    _lines.curves(ax, v, view.times, TIME, view, labels)
    ax.set_xlabel(view.axis_label(TIME))
    ax.set_ylabel(view.label())


def _at_places(v: xarray.DataArray, view: View) -> tuple[xarray.DataArray, dict[str, Any]]:
    """Return the field at the selected positions, by default that of its largest value, as a dimension."""
    space = view.space
    if view.places is None:
        others = [d for d in v.dims if d not in space]
        top = v.max(others) if others else v
        found = [np.unravel_index(int(np.argmax(top.transpose(*space).values)), [v.sizes[d] for d in space])]
    else:
        found = [_nearest(view, np.atleast_1d(np.asarray(p, float))) for p in view.places]
    chosen = xarray.concat(
        [v.isel(dict(zip(space, map(int, k), strict=True)), drop=True) for k in found], dim=PLACE
    )
    labels = [
        ", ".join(
            f"{view.axis_label(d).split(' (')[0]} = {view.points(d)[i]:g}"
            for d, i in zip(space, k, strict=True)
        )
        for k in found
    ]
    return chosen, {PLACE: labels}


def _nearest(view: View, place: np.ndarray) -> tuple[int, ...]:
    if len(place) != len(view.space):
        raise RecordError(
            f"a place has {len(view.space)} numbers ({', '.join(view.space)}), not {len(place)}",
            where=view.name,
            fix="For example --place 30,5",
        )
    for d, p in zip(view.space, place, strict=True):
        low, high = view.extent(d)
        if not low <= p <= high:
            raise RecordError(f"{p:g} lies outside {d}, which goes from {low:g} to {high:g}", where=view.name)
    return tuple(int(np.abs(view.points(d) - p).argmin()) for d, p in zip(view.space, place, strict=True))


if not TYPE_CHECKING:
    __getattr__ = renamed.left(__name__)
