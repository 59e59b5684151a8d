"""Colour scales of maps, shared by all panels of a comparison."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import FigureBase

from deodar.errors import RecordError, did_you_mean
from deodar.figures import _style
from deodar.figures._view import View

NEARLY_FLAT = 1e-9
GAP, WIDE = 0.04, 0.05
"""The distance of a colour bar from a map, and its width, as shares of the map's width."""

LONGEST = 18
"""Characters of a line of the label beside a map that may be low."""


def of(arrays: Iterable[Any], view: View, threshold: float | None) -> ScalarMappable:
    """Return the colour scale of some arrays, with the range and the colour map that a view selects."""
    return scale(arrays, threshold, view.value_range, view.colors)


def scale(
    arrays: Iterable[Any],
    threshold: float | None,
    value_range: Sequence[float] | None = None,
    colors: str | None = None,
) -> ScalarMappable:
    """Return the colour scale of some arrays.

    Activation has a diverging map: white at the threshold, blue below, red above, with equal steps of colour
    for equal steps of activation on both sides. The scale always contains the threshold; otherwise the noise
    of an inactive field would look like peaks. Other values have a sequential map. `value_range` sets the
    ends of the scale, and `colors` names another map.
    """
    if value_range is not None:
        low, high = map(float, value_range)
    else:
        low, high = _ends(arrays)
        if threshold is not None and colors is None:
            low, high = min(low, threshold), max(high, threshold)
    if colors is not None:
        return ScalarMappable(Normalize(low, high), _named(colors))
    if threshold is not None:
        reach = max(abs(low - threshold), abs(high - threshold))
        return ScalarMappable(
            Normalize(low, high),
            _part(_style.DIVERGING, (low - threshold) / reach, (high - threshold) / reach),
        )
    return ScalarMappable(Normalize(low, high), _style.SEQUENTIAL)


def bar(
    place: FigureBase,
    colors: ScalarMappable,
    axes: Axes | Sequence[Axes],
    label: str,
    threshold: float | None = None,
) -> None:
    """Draw the colour bar beside axes, with a line at the threshold."""
    listed = [axes] if isinstance(axes, Axes) else list(axes)
    last = listed[-1].get_subplotspec()
    if last is not None and last.get_gridspec().nrows > 1 and len(listed) > 1:
        made = place.colorbar(colors, ax=axes, label=label, pad=0.02, aspect=22)
    else:  # as high as the map, which need not fill its place
        low = listed[-1].get_aspect() != "auto"
        beside = listed[-1].inset_axes((1.0 + GAP, 0.0, WIDE, 1.0), label="<colorbar>")
        made = place.colorbar(colors, cax=beside, label=textwrap.fill(label, LONGEST) if low else label)
    made.outline.set_linewidth(0.6)  # pyright: ignore[reportCallIssue]
    low, high = colors.get_clim()
    if threshold is not None and low < threshold < high:
        made.ax.axhline(threshold, color=_style.THRESHOLD, linewidth=0.9)


def _ends(arrays: Iterable[Any]) -> tuple[float, float]:
    """Return the smallest and the largest value, apart where they are equal."""
    every = [np.asarray(a, float) for a in arrays]
    low, high = min(float(np.nanmin(a)) for a in every), max(float(np.nanmax(a)) for a in every)
    if high - low <= NEARLY_FLAT * max(1.0, abs(low), abs(high)):
        low, high = low - 0.5, high + 0.5
    return low, high


def _named(name: str) -> Colormap:
    """Return a colour map of matplotlib.

    Raises:
        RecordError: matplotlib has no map of that name.
    """
    if name not in matplotlib.colormaps:
        raise RecordError(
            f"there is no colour map {name!r}", fix=did_you_mean(name, list(matplotlib.colormaps))
        )
    return matplotlib.colormaps[name]


def _part(name: str, low: float, high: float) -> Colormap:
    """Return a part of a diverging map, whose ends are -1 and 1 and whose middle is 0."""
    whole = matplotlib.colormaps[name]
    return LinearSegmentedColormap.from_list(
        f"{name} part", whole(0.5 + 0.5 * np.linspace(low, high, 256)), 256
    )
