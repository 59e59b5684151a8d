"""A field of one dimension over time."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from deodar.errors import RecordError
from deodar.figures import _color, _draw, _style
from deodar.figures._view import View, other_kind, values

ACROSS = True
MOST_TIMES = 4000
"""Most times of a map; of a longer record, evenly spaced ones."""


def space_time(variable: xarray.DataArray, **view: Any) -> Figure:
    """Draw a field of one dimension: time across, the dimension upwards, the value as colour.

    Args:
        variable: a variable of a record.
        view: see `dd.figures.View`: trial, where.
    """
    return _draw.alone(size, fill, variable, view)


def suits(view: View) -> bool:
    """Return whether this is the default kind for a variable."""
    return len(view.space) == 1 and len(view.times) > 1


def size(view: View) -> tuple[float, float]:
    """Width and height, inches."""
    return _style.SINGLE, _style.PANEL + 0.2


def fill(place: FigureBase, view: View) -> None:
    """Draw into a figure, or into a part of one."""
    paint(place.subplots(), view)


def paint(ax: Axes, view: View) -> None:
    """Draw into axes."""
    if len(view.space) != 1 or len(view.times) < 2:
        what = (
            f"has {len(view.space)} axes; space-time needs one"
            if len(view.space) != 1
            else "was recorded at one time only"
        )
        raise RecordError(
            what,
            where=view.name,
            fix=other_kind("snapshot" if len(view.space) < 3 else "projection"),
        )
    every = 1 + len(view.times) // MOST_TIMES  # more columns than a printer has dots
    shown, times, space = values(view.one()[::every]), view.times[::every], view.space[0]
    colors = _color.of([shown], view, view.threshold)
    half = 0.5 * float(np.diff(times).mean())
    extent = (times[0] - half, times[-1] + half, *view.extent(space))
    norm: Any = colors.norm
    ax.imshow(shown.T, extent=extent, origin="lower", cmap=colors.cmap, norm=norm, aspect="auto")
    ax.set_xlim(times[0], times[-1])
    ax.set_xlabel(view.axis_label(view.time))
    ax.set_ylabel(view.axis_label(space))
    for spine in ax.spines.values():
        spine.set_visible(True)
    if view.note():
        ax.set_title(view.note())
    _color.bar(ax.figure, colors, ax, view.label(), view.threshold)
