"""A map of regimes over two parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import AbstractPathEffect

from deodar.analysis.maps.labels import WORDS, RegimeLabel
from deodar.errors import FigureError
from deodar.figures import _style
from deodar.figures._style import BLACK, BLUE, COLOR, COLORS, GREEN, ORANGE, VERMILION
from deodar.figures.locus import MARKS, SIZES, model_label

if TYPE_CHECKING:
    from deodar.analysis.continuation.locus import Locus
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


LINES = ("-", "--", ":", "-.")
"""Styles of lines of different bifurcations."""


def regime_map_figure(found: RegimeMap, loci: Sequence[Locus] = ()) -> Figure:
    """Draw a map of regimes: a colour for each, and a cross at the parameters of the model itself.

    The first parameter runs across, the second up. The cross is missing if the model lies outside of the map.
    With loci it says by how much both parameters may change before the nearest line is reached; cusps are
    triangles, Bogdanov-Takens points stars.

    Args:
        found: what `dd.regime_map` returned.
        loci: lines over both parameters, in any order: what `dd.regime_loci` or `dd.locus` returned.

    Raises:
        FigureError: a line has other parameters.
    """
    for line in loci:
        if set(line.parameters) != set(found.parameters):
            raise FigureError(
                f"a locus is over {' and '.join(line.parameters)},"
                f" the map over {' and '.join(found.parameters)}",
                fix="Give loci over the parameters of the map",
            )
    lines = [line.over(*found.parameters) for line in loci]
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
        keys += _lines(axes, lines)
        if x[0] <= found.at[0] <= x[-1] and y[0] <= found.at[1] <= y[-1]:
            halo = [patheffects.withStroke(linewidth=3, foreground="white")]
            cross: dict[str, Any] = {
                "marker": "+",
                "markersize": 9,
                "markeredgewidth": 1.2,
                "path_effects": halo,
            }
            (mark,) = axes.plot(
                *found.at, color=BLACK, linestyle="", label=model_label(lines, found.at), **cross
            )
            keys.append(mark)
        axes.set_xlim(x[0], x[-1])
        axes.set_ylim(y[0], y[-1])
        axes.set_xlabel(found.parameters[0])
        axes.set_ylabel(found.parameters[1])
        figure.legend(handles=keys, loc="outside right upper")
        return figure


def _lines(axes: Axes, lines: Sequence[Locus]) -> list[Line2D]:
    """Draw lines with the points on them, and return one of each bifurcation for the legend."""
    halo: list[AbstractPathEffect] = [patheffects.withStroke(linewidth=2.6, foreground="white")]
    names = list(dict.fromkeys(line.of for line in lines))
    keys: dict[str, Line2D] = {}
    for line in lines:
        style = LINES[names.index(line.of) % len(LINES)]
        (drawn,) = axes.plot(*line.values.T, style, color=BLACK, linewidth=1.0, label=line.of)
        drawn.set_path_effects(halo)
        keys.setdefault(line.of, drawn)
        for point in line.points:
            mark = axes.plot(*point.values, MARKS[point.kind], color="white", zorder=4)[0]
            mark.set(markersize=SIZES[point.kind] + 1, markeredgecolor=BLACK, markeredgewidth=0.7)
    return list(keys.values())


def _edges(values: np.ndarray) -> np.ndarray:
    """Return the borders of cells with these centres."""
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])
