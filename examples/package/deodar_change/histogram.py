"""A kind of figure: how often each value of a variable occurs."""

from __future__ import annotations

from typing import Any

import deodar as dd

ACROSS = False


def size(view: dd.figures.View) -> tuple[float, float]:
    """Width and height of the figure, in inches."""
    return 3.5, 2.4


def fill(place: Any, view: dd.figures.View) -> None:
    """Draw into a figure, or into a part of one."""
    ax = place.subplots()
    ax.hist(view.one().values.ravel(), bins=30)
    ax.set_xlabel(view.label())
    ax.set_ylabel("number of values")
