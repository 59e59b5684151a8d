"""Published experiments, run again: one folder for each paper; the folder is the registry, and entry points
`deodar.papers` of installed packages.

A paper is a module or a package with

* `HELP`: one line;
* `about(quick)`: what makes its design, as plain data;
* `BY_CONDITION`: the entries of `about` that map names of conditions to settings; a folder with fewer
  conditions is extended;
* `jobs(quick)`: its trials as `experiments.jobs.Job`;
* `report(rows, quick)`: a `papers.Report` of the rows that are there;
* `kept(row)`: a row without what no claim, figure or number reads; so it is kept in the repository;
* `PICTURES`: pictures of the manual, and which figure each of them is.

Heavy imports stand inside.
"""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType
from typing import TYPE_CHECKING, Any

from deodar import plugins
from deodar.errors import UnknownName, did_you_mean
from deodar.plugins import Plugin

if TYPE_CHECKING:
    from deodar.papers._report import NOT_RUN as NOT_RUN
    from deodar.papers._report import Report as Report
else:

    def __getattr__(name: str) -> Any:
        """What reports are made of, imported when it is first used."""
        if name not in ("NOT_RUN", "Report"):
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(importlib.import_module("deodar.papers._report"), name)


def names() -> list[str]:
    """Every paper that can be reproduced: those of deodar, then those that installed packages name."""
    return [*own(), *(p.name for p in packaged() if not p.problem)]


def own() -> list[str]:
    """The papers that come with deodar."""
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))


def packaged() -> list[Plugin]:
    """The papers that installed packages name, without importing them."""
    return plugins.found("papers", own())


def paper(name: str) -> ModuleType:
    """A paper by its name.

    Raises:
        UnknownName: nothing is called so (the nearest name is suggested), or its package cannot be used.
    """
    if name in own():
        return importlib.import_module(f"deodar.papers.{name}")
    for p in packaged():
        if p.name == name:
            module, problem = p.load()
            if problem:
                raise UnknownName(
                    f"the paper {name!r} cannot be used: the package {p.package} {p.version} {problem}",
                    fix="Type: deodar doctor",
                )
            return module
    raise UnknownName(f"there is no paper {name!r} to reproduce", fix=did_you_mean(name, names()))
