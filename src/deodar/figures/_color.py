"""Colour scales of maps, shared by all panels of a comparison."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import FigureBase

from deodar.figures import _style

NEARLY_FLAT = 1e-9


def scale(arrays: Iterable[Any], threshold: float | None) -> ScalarMappable:
    """Return the colour scale of some arrays.

    Activation has a diverging map: white at the threshold, blue below, red above, with equal steps of colour
    for equal steps of activation on both sides. The scale always contains the threshold; otherwise the noise
    of an inactive field would look like peaks. Other values have a sequential map.
    """
    every = [np.asarray(a, float) for a in arrays]
    low, high = min(float(np.nanmin(a)) for a in every), max(float(np.nanmax(a)) for a in every)
    if high - low <= NEARLY_FLAT * max(1.0, abs(low), abs(high)):
        low, high = low - 0.5, high + 0.5
    if threshold is not None:
        low, high = min(low, threshold), max(high, threshold)
        reach = max(threshold - low, high - threshold)
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
    made = place.colorbar(colors, ax=axes, label=label, pad=0.02, aspect=18 if isinstance(axes, Axes) else 22)
    made.outline.set_linewidth(0.6)  # pyright: ignore[reportCallIssue]
    low, high = colors.get_clim()
    if threshold is not None and low < threshold < high:
        made.ax.axhline(threshold, color=_style.THRESHOLD, linewidth=0.9)


def _part(name: str, low: float, high: float) -> Colormap:
    """Return a part of a diverging map, whose ends are -1 and 1 and whose middle is 0."""
    # start-up time: matplotlib is needed for figures only
    import matplotlib

    whole = matplotlib.colormaps[name]
    return LinearSegmentedColormap.from_list(
        f"{name} part", whole(0.5 + 0.5 * np.linspace(low, high, 256)), 256
    )
