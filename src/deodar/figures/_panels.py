"""The kinds of figures, the choice of a kind for a variable, and several variables in one figure."""

from __future__ import annotations

import dataclasses as dc
import pkgutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, cast

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.gridspec import SubplotSpec

from deodar.extensions import Extensions, requires
from deodar.figures import _moving, _style
from deodar.figures._moving import Changing
from deodar.figures._view import View
from deodar.plugins import Plugin


def kinds() -> dict[str, ModuleType]:
    """Return every kind of figure of a variable by name: the modules with a function `suits`.

    The package imports them. Other modules, which draw runs of papers, are not imported here.
    """
    names = sorted(
        m.name for m in pkgutil.iter_modules([str(Path(__file__).parent)]) if not m.name.startswith("_")
    )
    found = {name: sys.modules.get(f"{__package__}.{name}") for name in names}
    return {name: module for name, module in found.items() if module and hasattr(module, "suits")}


def _problem(plugin: Plugin, found: object) -> str:
    """Return the problem with a kind of figure from a package; it needs `paint` too if ACROSS is true."""
    across = ["paint"] if getattr(found, "ACROSS", False) else []
    return requires("ACROSS", "size", "fill", *across)(plugin, found)


KINDS: Extensions[ModuleType] = Extensions("figures", "kind of figure", kinds, _problem)
"""The kinds of figures, including those of installed packages.

A figure of a package is drawn only on request, so the default kind of a variable does not depend on the
installed packages.
"""


def choose(view: View) -> str:
    """Return the default kind for a variable: that of the requested times, positions or axes, else the only
    kind that suits it.
    """
    if view.axes is not None:
        return "projection"
    if view.places is not None and view.space:
        return "time_course"
    if view.at is not None and len(view.space) <= 2:
        return "snapshots" if len(view.at) > 1 and view.space else "snapshot"
    return next(name for name, kind in kinds().items() if kind.suits(view))


def kind(view: View, name: str | None = None) -> ModuleType:
    """Return the requested kind, or the default kind."""
    return KINDS[(name or choose(view)).replace("-", "_")]


# --------------------------------------------------------------------------------------------- several panels


@dc.dataclass(frozen=True)
class Cell:
    """One panel of a figure: what it shows, and the rows and columns of the grid that it covers.

    Attributes:
        view: the variable.
        kind: the module of its kind.
        rows, columns: first row or column, and the one after the last.
        title: title in place of that of the kind; None: that of the kind.
        letter: the text at the upper left corner.
        legend: place of the legend in words of matplotlib, or "none"; None: where it hides least.
    """

    view: View
    kind: ModuleType
    rows: tuple[int, int]
    columns: tuple[int, int]
    title: str | None = None
    letter: str = ""
    legend: str | None = None

    @property
    def width(self) -> int:
        """Number of columns."""
        return self.columns[1] - self.columns[0]


@dc.dataclass(frozen=True)
class Tracks:
    """Sizes of the columns and rows of a figure, in inches, with the space around their axes."""

    widths: Sequence[float]
    heights: Sequence[float]


def natural(cells: Sequence[Cell], width: float | None = None) -> Tracks:
    """Return the grid in which each kind has its own size; `width`: of the whole figure, in inches."""
    sizes = [c.kind.size(c.view) for c in cells]
    widths = _widths(cells, [w for w, _ in sizes], width)
    heights = [0.0] * max(c.rows[1] for c in cells)
    for c, (w, h) in zip(cells, sizes, strict=True):
        given = sum(widths[slice(*c.columns)])
        high = h if c.kind.ACROSS else h * min(1.0, given / w)
        for k in range(*c.rows):
            heights[k] = max(heights[k], high / (c.rows[1] - c.rows[0]))
    for c, (_, h) in zip(cells, sizes, strict=True):
        if _above(c, cells) is not None:  # without the times below the upper panel
            heights[c.rows[0]] = min(heights[c.rows[0]], 0.9 * h)
    empty = min((h for h in heights if h), default=_style.PANEL)
    return Tracks([w or min(w for w in widths if w) for w in widths], [h or empty for h in heights])


def _widths(cells: Sequence[Cell], natural: Sequence[float], width: float | None) -> list[float]:
    """Return the width of each column for the natural widths of panels; `width`: their sum."""
    widths = [0.0] * max(c.columns[1] for c in cells)
    for c, w in zip(cells, natural, strict=True):
        for k in range(*c.columns):
            widths[k] = max(widths[k], w / c.width)
    if width is None:
        return widths
    whole = sum(widths)
    return [w * width / whole for w in widths]


def draw(
    cells: Sequence[Cell],
    grid: Tracks,
    times: Sequence[float] | None = None,
    changing: list[Changing] | None = None,
) -> Figure:
    """Draw the panels of a figure, with the present style of type.

    Panels one above the other share their time axis if it is horizontal and shows the same time.

    Args:
        cells: the panels.
        grid: the sizes of rows and columns.
        times: the times of a video, whose panels are drawn as at the first one. None: a figure.
        changing: receives what changes over these times in each panel, and None for a panel that a package
            draws again.
    """
    figure = _style.figure(sum(grid.widths), sum(grid.heights))
    spec = figure.add_gridspec(
        len(grid.heights), len(grid.widths), width_ratios=grid.widths, height_ratios=grid.heights
    )
    drawn: dict[int, Axes] = {}
    for cell in cells:
        where = spec[slice(*cell.rows), slice(*cell.columns)]
        if len(cells) == 1 and times is None:
            place: FigureBase | Axes = figure
            cell.kind.fill(figure, cell.view)
        elif hasattr(cell.kind, "paint"):
            above = _above(cell, cells)
            upper = drawn.get(id(above))
            low, high = (cell.view.times[0], cell.view.times[-1]) if upper is None else _limits(upper)
            place = drawn[id(cell)] = figure.add_subplot(where, sharex=upper)
            _begin(place, cell, cell.kind.paint, times, changing)
            place.set_anchor("N")
            if upper is not None:
                upper.set_xlabel("")
                upper.tick_params(labelbottom=False)
                place.set_xlim(min(low, cell.view.times[0]), max(high, cell.view.times[-1]))
        else:
            own = cell.kind.__name__.startswith(f"{__package__}.")
            place = cast(FigureBase, GridPart(where)) if own else figure.add_subfigure(where)
            _begin(place, cell, cell.kind.fill, times, changing)
        _finish(place, cell)
    for first in {cell.columns[0] for cell in cells}:
        figure.align_ylabels([drawn[id(c)] for c in cells if c.columns[0] == first and id(c) in drawn])
    _fix_type(figure)
    return figure


def _begin(
    place: FigureBase | Axes,
    cell: Cell,
    draw: Callable[[Any, View], None],
    times: Sequence[float] | None,
    changing: list[Changing] | None,
) -> None:
    """Draw one panel; of a video, as at the first of its times."""
    view = cell.view
    if times is None or changing is None or view.time not in view.variable.dims or view.at is not None:
        draw(place, view)
    elif cell.kind.ACROSS and isinstance(place, Axes):
        draw(place, view)
        changing.append(_moving.cursor(place, view))
    elif hasattr(cell.kind, "moving"):
        found = cell.kind.moving(place, view, times)
        if found is None:
            draw(place, view)
        else:
            changing.append(found)
    elif cell.kind.__name__.startswith(f"{__package__}."):
        draw(place, view)
    else:
        changing.append(_moving.redrawn(place, view, draw, times[0]))


class GridPart:
    """A part of the grid of a figure, with those methods of a `FigureBase` that the kinds call.

    A subfigure would lose the space that axes in the same rows and columns need for their labels.
    """

    def __init__(self, where: SubplotSpec) -> None:
        self._where = where
        self._figure = cast(Any, where.get_gridspec()).figure
        self.axes: list[Axes] = []

    def subplots(self, rows: int = 1, columns: int = 1, squeeze: bool = True, **shared: Any) -> Any:
        """Add axes in rows and columns, as `Figure.subplots`."""
        grid = self._where.subgridspec(rows, columns).subplots(squeeze=False, **shared)
        self.axes = list(grid.flat)
        for ax in self.axes:
            ax.set_anchor("N")
        return grid[0, 0] if squeeze and grid.size == 1 else grid

    def colorbar(self, *given: Any, **named: Any) -> Any:
        """Draw a colour bar, as `Figure.colorbar`."""
        return self._figure.colorbar(*given, **named)

    def suptitle(self, text: str, **named: Any) -> None:
        """Write a line above the titles of the axes."""
        top = self.axes[0].get_subplotspec()
        size = matplotlib.rcParams["axes.titlesize"]
        for ax in self.axes:
            spec = ax.get_subplotspec()
            first = spec is not None and top is not None and spec.rowspan.start == top.rowspan.start
            title = ax.get_title()
            if first and not title.startswith(LINE):
                ax.set_title(LINE + title)  # room for the line
        for old in [t for t in self.axes[0].texts if t.get_gid() == ABOVE]:
            old.remove()
        above = matplotlib.rcParams["axes.titlepad"] + 1.2 * size
        self.axes[0].annotate(
            text,
            xy=(0, 1),
            xycoords="axes fraction",
            xytext=(0, above),
            textcoords="offset points",
            ha="left",
            va="baseline",
            gid=ABOVE,
            annotation_clip=False,
            **{"fontsize": size, **named},
        ).set_in_layout(False)


LINE = " \n"
ABOVE = "above"

BAR = "<colorbar>"
"""The label that matplotlib gives to the axes of a colour bar."""


def _above(cell: Cell, cells: Sequence[Cell]) -> Cell | None:
    """Return the panel right above a panel whose horizontal axis is the same time."""
    for c in cells:
        same = c.columns == cell.columns and c.rows[1] == cell.rows[0] and c.kind.ACROSS and cell.kind.ACROSS
        if same and _axis(c) == _axis(cell):
            return c
    return None


def _axis(cell: Cell) -> tuple[Any, ...]:
    return cell.view.axis_label(cell.view.time), tuple(cell.view.time_range or ())


def _limits(ax: Axes) -> tuple[float, float]:
    low, high = ax.get_xlim()
    return float(low), float(high)


def _finish(place: FigureBase | Axes, cell: Cell) -> None:
    """Set the range of time, the title, the legend and the letter of a panel."""
    inside: list[Axes] = [place] if isinstance(place, Axes) else cast(Any, place).axes
    found = [ax for ax in inside if ax.get_label() != BAR]
    if cell.kind.ACROSS and cell.view.time_range is not None:
        for ax in found:
            ax.set_xlim(*cell.view.time_range)
    for legend in [ax.get_legend() for ax in found if cell.legend is not None]:
        if legend is not None and cell.legend == "none":
            legend.remove()
        elif legend is not None:
            legend.set_loc(cast(Any, cell.legend))
    if cell.title is not None:
        if len(found) == 1:
            found[0].set_title(cell.title)
        else:
            cast(FigureBase, place).suptitle(cell.title, fontsize=matplotlib.rcParams["axes.titlesize"])
    if cell.letter and found:
        size = matplotlib.rcParams["axes.titlesize"]
        lines = 1.2 * size if found[0].get_title().startswith(LINE) else 0.0
        found[0].annotate(
            cell.letter,
            xy=(0, 1),
            xycoords=(found[0].yaxis.label, found[0].transAxes),  # the left edge of what is beside the axes
            xytext=(0, matplotlib.rcParams["axes.titlepad"] + lines),
            textcoords="offset points",
            ha="left",
            va="baseline",
            fontweight="bold",
            fontsize=size,
            annotation_clip=False,
        )


def _fix_type(figure: Figure) -> None:
    """Keep the present size and font of ticks, which matplotlib makes when it writes the figure."""
    family = matplotlib.rcParams["font.family"]
    for ax in [part for outer in figure.axes for part in (outer, *outer.child_axes)]:
        ax.tick_params(labelsize=matplotlib.rcParams["xtick.labelsize"])
        if family != ["sans-serif"]:
            ax.tick_params(labelfontfamily=family)
