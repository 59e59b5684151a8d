"""A map of regimes over two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import patheffects
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from deodar.analysis.maps.labels import WORDS, RegimeLabel
from deodar.figures import _style
from deodar.figures._style import BLACK, BLUE, COLOR, COLORS, GREEN, ORANGE, VERMILION

if TYPE_CHECKING:
    from deodar.analysis.maps.map_result import RegimeMap

REGIME_COLORS = {
    RegimeLabel.SILENT: COLOR.window,
    RegimeLabel.DRIVEN: COLORS[5],
    RegimeLabel.SUSTAINED: ORANGE,
    RegimeLabel.SELECTIVE: GREEN,
    RegimeLabel.SUSTAINED_SELECTIVE: VERMILION,
    RegimeLabel.UNBOUNDED: COLORS[3],
    RegimeLabel.ACTIVE: BLUE,
    RegimeLabel.RESTLESS: BLACK,
}
"""The colour of each regime, the same in all maps."""


def regime_map_figure(found: RegimeMap) -> Figure:
    """Draw a map of regimes: a colour for each, and a cross at the parameters of the model itself.

    The first parameter runs across, the second up. The cross is missing if the model lies outside of the map.

    Args:
        found: what `dd.regime_map` returned.
    """
    with _style.style():
        figure = _style.figure(1.6 * _style.SINGLE, 2.9)
        axes = figure.subplots()
        x, y = (_edges(values) for values in found.values)
        colors = ListedColormap([REGIME_COLORS[label] for label in RegimeLabel])
        norm = BoundaryNorm(np.arange(len(WORDS) + 1) - 0.5, len(WORDS))
        axes.pcolormesh(x, y, found.labels.T, cmap=colors, norm=norm, rasterized=True)
        present = [label for label in RegimeLabel if (found.labels == label).any()]
        keys: list[Patch | Line2D] = [
            Patch(facecolor=REGIME_COLORS[label], label=WORDS[label]) for label in present
        ]
        if x[0] <= found.at[0] <= x[-1] and y[0] <= found.at[1] <= y[-1]:
            halo = [patheffects.withStroke(linewidth=3, foreground="white")]
            cross: dict[str, Any] = {
                "marker": "+",
                "markersize": 9,
                "markeredgewidth": 1.2,
                "path_effects": halo,
            }
            (mark,) = axes.plot(*found.at, color=BLACK, linestyle="", label="the model", **cross)
            keys.append(mark)
        axes.set_xlim(x[0], x[-1])
        axes.set_ylim(y[0], y[-1])
        axes.set_xlabel(found.parameters[0])
        axes.set_ylabel(found.parameters[1])
        figure.legend(handles=keys, loc="outside right upper")
        return figure


def _edges(values: np.ndarray) -> np.ndarray:
    """Return the borders of cells with these centres."""
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])
