"""The kinds of figures, the choice of a kind for a variable, and several variables in one figure."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Sequence
from types import ModuleType
from typing import Any

from matplotlib.figure import Figure

from deodar import figures
from deodar.errors import RecordError
from deodar.extensions import Extensions
from deodar.figures import _style
from deodar.figures._view import View
from deodar.plugins import Plugin

MOST_PANELS = 12


def kinds() -> dict[str, ModuleType]:
    """Return every kind of figure of a variable by name: the modules with a function `suits`."""
    names = sorted(m.name for m in pkgutil.iter_modules(figures.__path__) if not m.name.startswith("_"))
    found = {name: importlib.import_module(f"deodar.figures.{name}") for name in names}
    return {name: module for name, module in found.items() if hasattr(module, "suits")}


REQUIRED = ("ACROSS", "size", "fill")
"""The required members of a kind's module; `paint` too if ACROSS is true."""


def _problem(plugin: Plugin, found: object) -> str:
    """Return the problem with a kind of figure from a package."""
    needed = [*REQUIRED, *(["paint"] if getattr(found, "ACROSS", False) else [])]
    missing = [name for name in needed if not hasattr(found, name)]
    return f"has no {', '.join(missing)}" if missing else ""


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


def draw(views: Sequence[View], name: str | None = None) -> Figure:
    """Draw one figure of one or several variables, one panel each, one above the other.

    If the horizontal axis of all panels is time, they share it.
    """
    if not views:
        raise RecordError("there is no variable to draw")
    if len(views) > MOST_PANELS:
        raise RecordError(
            f"{len(views)} variables are too many for one figure", fix=f"Name at most {MOST_PANELS} of them"
        )
    chosen = [(kind(view, name), view) for view in views]
    with _style.style():
        sizes = [k.size(view) for k, view in chosen]
        width, height = max(w for w, _ in sizes), sum(h for _, h in sizes)
        if len(chosen) == 1:
            figure = _style.figure(width, height)
            chosen[0][0].fill(figure, chosen[0][1])
        elif all(k.ACROSS for k, _ in chosen):
            figure = _shared(chosen, width, [h for _, h in sizes])
        else:
            figure = _style.figure(width, height)
            parts: Any = figure.subfigures(len(chosen), 1, height_ratios=[h for _, h in sizes])
            for (k, view), part in zip(chosen, parts, strict=True):
                k.fill(part, view)
    return figure


def _shared(chosen: Sequence[tuple[ModuleType, View]], width: float, heights: Sequence[float]) -> Figure:
    figure = _style.figure(max(width, 4.5), 0.85 * sum(heights) + 0.2)
    views = [view for _, view in chosen]
    same = len({view.axis_label("time") for view in views}) == 1
    grid = figure.subplots(len(chosen), 1, sharex=same, height_ratios=list(heights))
    for (k, view), ax in zip(chosen, grid, strict=True):
        k.paint(ax, view)
    if same:
        for ax in grid[:-1]:
            ax.set_xlabel("")
            ax.tick_params(labelbottom=False)
        grid[0].set_xlim(min(v.times[0] for v in views), max(v.times[-1] for v in views))
    return figure
