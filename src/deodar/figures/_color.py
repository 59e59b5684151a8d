"""Colour scales of maps, shared by all panels of a comparison."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.figure import FigureBase

from deodar.errors import RecordError, did_you_mean
from deodar.figures import _style
from deodar.figures._view import View

NEARLY_FLAT = 1e-9
GAP, WIDE = 0.04, 0.05
"""The distance of a colour bar from a map, and its width, as shares of the map's width."""

COUNT = 256
"""Colours of a map."""

LEAST_REACH = 3.0
"""The shorter reach of activation is at least the longer one divided by this."""

LONGEST = 18
"""Characters of a line of the label beside a map that may be low."""


def of(arrays: Iterable[Any], view: View, threshold: float | None) -> ScalarMappable:
    """Return the colour scale of some arrays, with the range and the colour map that a view selects."""
    map_of_amounts = _style.amounts(_style.port_color(view.name))
    return scale(arrays, threshold, view.value_range, view.colors, map_of_amounts)


def scale(
    arrays: Iterable[Any],
    threshold: float | None,
    value_range: Sequence[float] | None = None,
    colors: str | None = None,
    map_of_amounts: Colormap = _style.AMOUNTS,
) -> ScalarMappable:
    """Return the colour scale of some arrays.

    Activation is white at the threshold, blue below and ember above it. The scale always contains the
    threshold; otherwise the noise of an inactive field would look like peaks. Other values have the map of
    amounts. `value_range` sets the ends of the scale, and `colors` names another map.
    """
    if value_range is not None:
        low, high = map(float, value_range)
    else:
        low, high = _ends(arrays)
        if threshold is not None and colors is None:
            low, high = min(low, threshold), max(high, threshold)
    if colors is not None:
        return ScalarMappable(Normalize(low, high), _named(colors))
    return ScalarMappable(
        Normalize(low, high), map_of_amounts if threshold is None else activation(low, high, threshold)
    )


def activation(low: float, high: float, threshold: float) -> Colormap:
    """Return the map of activation from `low` to `high`.

    Each side of the threshold has a reach of its own, over which it takes all of its colours: with one
    reach, a peak of +3 over a resting level of -10 would be pale. The reach of a side is the distance of the
    threshold from its end, at least a third of that of the other side, so that noise at the threshold stays
    pale. The colour of the threshold itself is white.
    """
    values = np.linspace(low, high, COUNT)
    if low <= threshold <= high:
        # the colour that matplotlib takes for it
        values[min(COUNT - 1, int(COUNT * (threshold - low) / (high - low)))] = threshold
    below = max(threshold - low, (high - threshold) / LEAST_REACH)
    above = max(high - threshold, (threshold - low) / LEAST_REACH)
    place = np.where(values < threshold, (values - threshold) / below, (values - threshold) / above)
    return ListedColormap(_style.ACTIVATION(0.5 + 0.5 * np.clip(place, -1.0, 1.0)), "activation")


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
