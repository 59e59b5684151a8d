"""Values over time: a node, a motor variable, or a field at selected positions."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from deodar.errors import Fix, RecordError
from deodar.figures import _draw, _lines, _style
from deodar.figures._view import TRIAL, View, values

ACROSS = True
PLACE = "place"

SEARCHED = 2**28
"""Number of bytes in which the largest value is searched; of a larger variable, evenly spaced times."""

Sample = tuple[int, ...]
"""The number of a sample along each axis of a field."""


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
    v = view.chosen()
    if view.time not in v.dims:
        v = v.expand_dims(view.time)
    if view.space:
        found = _found(v, view)
        labels = {PLACE: [_words(view, place) for place in found]}
        begin = xarray.concat([v.isel({view.time: [0], **_index(view, k)}, drop=True) for k in found], PLACE)
        _lines.curves(ax, begin, view.times, view.time, view, labels, _reader(v, view, found))
    else:
        _lines.curves(ax, v, view.times, view.time, view)
    ax.set_xlabel(view.axis_label(view.time))
    ax.set_ylabel(view.label())


def _found(v: xarray.DataArray, view: View) -> list[Sample]:
    """Return the selected samples of the field, by default that of its largest value."""
    if view.places is not None:
        return [_nearest(view, np.atleast_1d(np.asarray(p, float))) for p in view.places]
    part = v.isel({view.time: slice(None, None, 1 + v.nbytes // SEARCHED)})
    others = [d for d in v.dims if d not in view.space]
    top = part.copy(data=values(part)).max(others).transpose(*view.space).values
    return [tuple(map(int, np.unravel_index(int(np.argmax(top)), top.shape)))]


def _words(view: View, place: Sample) -> str:
    """Return a position in words, with its units."""
    points = [
        (view.short(d), view.points(d)[i], view.unit(d)) for d, i in zip(view.space, place, strict=True)
    ]
    return ", ".join(f"{name} = {point:g} {unit}".strip() for name, point, unit in points)


def _index(view: View, place: Sample) -> dict[str, int]:
    return dict(zip(view.space, place, strict=True))


def _reader(v: xarray.DataArray, view: View, found: list[Sample]) -> _lines.ReadPart:
    """Return the function that reads the samples over time: (samples, sweeps, trials, times).

    The smallest block that contains all samples is read at once, because files keep values that are near to
    each other in one piece.
    """
    low = [min(k) for k in zip(*found, strict=True)]
    around = {
        d: slice(a, max(k) + 1) for d, a, k in zip(view.space, low, zip(*found, strict=True), strict=True)
    }
    others = [d for d in v.dims if d not in (TRIAL, view.time, *view.space)]
    order = [*others, *([TRIAL] if TRIAL in v.dims else []), view.time, *view.space]
    near = v.isel(around).transpose(*order)

    def read(part: slice) -> np.ndarray:
        block = values(near.isel({view.time: part}))
        return np.stack([block[(..., *(np.subtract(k, low)))] for k in found])

    return read


def _nearest(view: View, place: np.ndarray) -> Sample:
    if len(place) != len(view.space):
        raise RecordError(
            f"a place has {len(view.space)} numbers ({', '.join(view.space)}), not {len(place)}",
            where=view.name,
            fix=Fix("For example places=[(30, 5)]", "For example --place 30,5"),
        )
    for d, p in zip(view.space, place, strict=True):
        low, high = view.extent(d)
        if not low <= p <= high:
            raise RecordError(f"{p:g} lies outside {d}, which goes from {low:g} to {high:g}", where=view.name)
    return tuple(int(np.abs(view.points(d) - p).argmin()) for d, p in zip(view.space, place, strict=True))
