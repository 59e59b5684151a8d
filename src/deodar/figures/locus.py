"""Loci of bifurcations in the plane of two parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from deodar.errors import FigureError
from deodar.figures import _style
from deodar.figures._style import COLOR, COLORS

if TYPE_CHECKING:
    from deodar.analysis.continuation.locus import Locus

MARKS = {"cusp": "^", "Bogdanov-Takens": "*"}
SIZES = {"cusp": 4.0, "Bogdanov-Takens": 7.0}
"""Marks of points on a line, and their sizes."""


def locus_figure(*loci: Locus, at: tuple[float, float] | None = None) -> Figure:
    """Draw where bifurcations lie in the plane of two parameters.

    Cusps are triangles, Bogdanov-Takens points stars. The first line says which parameter runs across.

    Args:
        loci: lines over the same two parameters, in any order.
        at: values of a model, drawn as a cross, with its distance from the nearest line; None: none.

    Raises:
        FigureError: there is no line, or they have different parameters.
    """
    if not loci:
        raise FigureError("there is no locus to draw", fix="Give what dd.locus returned")
    first, second = loci[0].parameters
    if len({frozenset(found.parameters) for found in loci}) > 1:
        raise FigureError("the loci have different parameters", fix="Draw them in figures of their own")
    turned = tuple(found.over(first, second) for found in loci)
    with _style.style():
        figure = _style.figure(1.3 * _style.SINGLE, 2.8)
        axes = figure.subplots()
        draw_loci(axes, turned)
        if at is not None:
            axes.plot(*at, "+", color=COLOR.threshold, markersize=9, label=model_label(turned, at))
        axes.margins(0.06)
        axes.set_xlabel(first)
        axes.set_ylabel(second)
        axes.legend(loc="best")
        return figure


def model_label(loci: Sequence[Locus], at: tuple[float, float]) -> str:
    """Return the words for the cross of a model: the change of both parameters that reaches a line.

    Without the distance if there is no line, or a parameter is 0, so that no change is relative to it.
    """
    if not loci or 0 in at:
        return "the model"
    nearest = min(loci, key=lambda found: found.distance(at))
    return f"the model, {nearest.distance(at):.1%} from\n{nearest.of}"


def draw_loci(axes: Axes, loci: tuple[Locus, ...]) -> None:
    """Draw lines, those of one bifurcation in one colour, and the points on them, each point once."""
    names = list(dict.fromkeys(found.of for found in loci))
    seen: set[tuple[str, float, float]] = set()
    drawn: set[str] = set()
    for found in loci:
        color = COLORS[names.index(found.of) % len(COLORS)]
        axes.plot(*found.values.T, color=color, label="_" * (found.of in drawn) + found.of)
        drawn.add(found.of)
        for point in found.points:
            key = (point.kind, round(point.values[0], 6), round(point.values[1], 6))
            if key not in seen:
                seen.add(key)
                mark = axes.plot(*point.values, MARKS[point.kind], color=COLOR.threshold, zorder=4)[0]
                mark.set_markersize(SIZES[point.kind])
