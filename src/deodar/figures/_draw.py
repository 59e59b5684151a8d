"""One figure of one variable: what every kind does to draw itself alone."""

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
    """A figure of the size that a kind asks for, filled by it."""
    looked = View(variable, **view)
    with _style.style():
        figure = _style.figure(*size(looked))
        fill(figure, looked)
    return figure
