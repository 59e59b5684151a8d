"""One figure of one variable, of any kind."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import xarray
from matplotlib.figure import Figure, FigureBase

from deodar.figures import _style
from deodar.figures._view import View


def alone(
    size: Callable[[View], tuple[float, float]],
    fill: Callable[[FigureBase, View], None],
    variable: xarray.DataArray,
    view: Mapping[str, Any],
) -> Figure:
    """Return a figure in the size of a kind, filled by the kind."""
    looked = View(variable, **view)
    with _style.style():
        figure = _style.figure(*size(looked))
        fill(figure, looked)
    return figure
