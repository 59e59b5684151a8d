"""A two-dimensional array as a colour map."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable

from deodar.figures._view import View

LARGEST_ASPECT = 3.0


def paint(ax: Axes, values: Any, view: View, across: str, up: str, colors: ScalarMappable) -> None:
    """Draw the values, an array (across, up), with the labels of both axes."""
    x, y = view.extent(across), view.extent(up)
    norm: Any = colors.norm
    ax.imshow(
        values.T,
        extent=(*x, *y),
        origin="lower",
        cmap=colors.cmap,
        norm=norm,
        aspect="equal" if square(view, across, up) else "auto",
    )
    ax.set_xlabel(view.axis_label(across))
    ax.set_ylabel(view.axis_label(up))
    for spine in ax.spines.values():
        spine.set_visible(True)


def square(view: View, across: str, up: str) -> bool:
    """Return whether both axes have one scale: of the same unit, and neither much longer."""
    units = [view.variable[d].attrs.get("units") if d in view.variable.coords else None for d in (across, up)]
    (a, b), (c, d) = view.extent(across), view.extent(up)
    return units[0] == units[1] and 1 / LARGEST_ASPECT <= (b - a) / (d - c) <= LARGEST_ASPECT


def shape(view: View, across: str, up: str) -> float:
    """Return height over width of the map."""
    if not square(view, across, up):
        return 0.8
    (a, b), (c, d) = view.extent(across), view.extent(up)
    return (d - c) / (b - a)
