"""What changes in a panel from one frame of a video to the next."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from matplotlib.text import Text

from deodar.figures import _style
from deodar.figures._view import View


@dc.dataclass(frozen=True)
class Changing:
    """The part of a panel that changes over time.

    Attributes:
        artists: what is drawn in each frame, over the rest of the figure.
        show: changes the artists to the state at a time.
    """

    artists: Sequence[Artist]
    show: Callable[[float], None]


def cursor(ax: Axes, view: View) -> Changing:
    """Return a line at the shown time, for axes on which time runs across."""
    line = ax.axvline(view.times[0], color=_style.COLOR.moment, linewidth=_style.MEDIUM)

    def show(time: float) -> None:
        line.set_xdata([time, time])

    return Changing([line], show)


def redrawn(
    place: Axes | FigureBase, view: View, draw: Callable[[Any, View], None], first: float
) -> Changing:
    """Return a panel that a package draws again for each time."""

    def show(time: float) -> None:
        place.clear()
        draw(place, dc.replace(view, at=[view.times[view.nearest(time)]]))

    show(first)
    return Changing([], show)


def limits(
    planes: Iterable[np.ndarray], view: View, threshold: float | None, margin: float = 0.0
) -> tuple[float, float]:
    """Return the range of the values of all frames, with the threshold in it."""
    if view.value_range is not None:
        low, high = view.value_range
        return float(low), float(high)
    ends = [(float(np.nanmin(plane)), float(np.nanmax(plane))) for plane in planes]
    low, high = min(a for a, _ in ends), max(b for _, b in ends)
    if threshold is not None:
        low, high = min(low, threshold), max(high, threshold)
    more = margin * (high - low) or 0.5 * (low == high)
    return low - more, high + more


def texts(axes: Sequence[Axes], place: Axes | FigureBase, text: str) -> list[Text]:
    """Return the titles and notes of a panel that say a text."""
    found = [t for ax in axes for t in (ax.title, *ax.texts)]
    if isinstance(place, FigureBase):
        found += [t for t in place.get_children() if isinstance(t, Text)]
    return [t for t in found if t.get_text() == text]


def frames(axes: Sequence[Axes]) -> list[Artist]:
    """Return the lines around maps, which are drawn over them."""
    return [spine for ax in axes for spine in ax.spines.values()]
