"""Plots of the studio from installed packages: their descriptions, and their files for the page.

A plot of a package is a Python module with

* `TITLE`: the name in the menu of plots;
* `FILE`: the ES module that draws it, a file in the folder of the Python module, by its name;
* `AXES`: number of axes of the arrays that it draws: 1; 2 (of arrays with more axes, the maximum over the
  others); 3 for pictures, whose third axis is the colour channel;
* `PERIODIC`: whether all axes have to be periodic; False by default.

The manual (*Adding an element*) describes what the ES module exports. The page draws a plot of a package only
on request, so the default plot of a port does not depend on the installed packages.
"""

from __future__ import annotations

import functools
import re
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from deodar import regular_file
from deodar.errors import UnknownName
from deodar.extensions import Extensions, requires
from deodar.plugins import Plugin
from deodar_studio.messages.to_page import PlotView

OWN = Path(__file__).with_name("own_plots.txt")
"""The names of the plots of the page, one in each line; `python tools/generate.py` writes it from the files
`studio/src/plots/kinds/NAME.plot.ts`.
"""

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
"""The names that a plot may have: they are part of an address."""

MOST_AXES = 3


def views() -> list[PlotView]:
    """Return the description of every plot from a package; a plot with a problem is left out."""
    return [_view(plugin, plugin.load()[0]) for plugin in PLOTS.packaged() if not PLOTS.problem(plugin)]


def file(name: str) -> Path | None:
    """Return the ES module of a plot, or None if no usable plot of a package has that name."""
    try:
        found = PLOTS[name]
    except UnknownName:
        return None
    return None if found is None else _file(found)


@functools.cache
def _own() -> dict[str, ModuleType | None]:
    return dict.fromkeys(regular_file.read_text(OWN).split())


def _problem(plugin: Plugin, found: Any) -> str:
    if not isinstance(found, ModuleType):
        return f"names {plugin.entry.value} as {plugin.name!r}, which is not a module"
    if not NAME.fullmatch(plugin.name):
        return "has a name with other characters than letters, digits, _ and -"
    if missing := requires("TITLE", "FILE", "AXES")(plugin, found):
        return missing
    plot = cast("Any", found)
    if not isinstance(plot.TITLE, str) or not plot.TITLE.strip():
        return f"has the TITLE {plot.TITLE!r}, which is not a text"
    if type(plot.AXES) is not int or not 1 <= plot.AXES <= MOST_AXES:
        return f"has AXES = {plot.AXES!r}, which is not 1, 2 or 3"
    if not isinstance(getattr(found, "PERIODIC", False), bool):
        return f"has PERIODIC = {plot.PERIODIC!r}, which is not True or False"
    if not isinstance(plot.FILE, str) or Path(plot.FILE).name != plot.FILE:
        return f"has the FILE {plot.FILE!r}, which is not the name of a file"
    return "" if _file(found) is not None else f"has the FILE {plot.FILE!r}, which is not in its folder"


PLOTS: Extensions[ModuleType | None] = Extensions("plots", "plot", _own, _problem)
"""The plots, including those of installed packages; None for a plot of deodar, which has no module."""


def _file(found: ModuleType) -> Path | None:
    path = Path(found.__file__ or "").parent / found.FILE
    return path if found.__file__ and path.is_file() else None


def _view(plugin: Plugin, found: ModuleType) -> PlotView:
    return PlotView(
        name=plugin.name,
        title=found.TITLE,
        package=f"{plugin.package} {plugin.version}",
        axes=found.AXES,
        periodic=getattr(found, "PERIODIC", False),
        module=f"plots/{plugin.name}.js",
    )
