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

A paper of deodar may have a file `demo.py`, its quick form, which `deodar demo NAME` runs: `HELP`,
`arguments(parser)` and `run(args, show)`, which returns a `papers.Demonstration`.

Heavy imports stand inside.
"""

from __future__ import annotations

import importlib
import importlib.util
import pkgutil
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any

from deodar import plugins
from deodar.errors import UnknownName, did_you_mean
from deodar.papers._demonstration import Demonstration as Demonstration
from deodar.papers._demonstration import Show as Show
from deodar.plugins import Plugin

if TYPE_CHECKING:
    from deodar.papers._report import NOT_RUN as NOT_RUN
    from deodar.papers._report import Report as Report


def __getattr__(name: str) -> Any:
    """Import what reports are made of, or a paper, when it is first used."""
    if name in ("NOT_RUN", "Report"):
        return getattr(importlib.import_module("deodar.papers._report"), name)
    return files(__name__)(name)


def files(package: str) -> Callable[[str], Any]:
    """Make the `__getattr__` of a package that imports a file of its own when it is first used."""

    def __getattr__(name: str) -> Any:
        if name.startswith("_") or importlib.util.find_spec(f"{package}.{name}") is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=None)
        return importlib.import_module(f"{package}.{name}")

    return __getattr__


def names() -> list[str]:
    """Every paper that can be reproduced: those of deodar, then those that installed packages name."""
    return [*own(), *(p.name for p in packaged() if not p.problem)]


def own() -> list[str]:
    """The papers that come with deodar."""
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))


def demos() -> dict[str, ModuleType]:
    """The demonstrations of the papers that come with deodar, by the name of the paper."""
    found = [name for name in own() if importlib.util.find_spec(f"deodar.papers.{name}.demo")]
    return {name: importlib.import_module(f"deodar.papers.{name}.demo") for name in found}


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
