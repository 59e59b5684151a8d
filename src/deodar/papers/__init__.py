"""Published experiments, run again: one folder for each paper; the folder is the registry, and entry points
`deodar.papers` of installed packages.

A paper is a module or a package with

* `HELP`: one line;
* `about(quick)`: the settings of its design, as plain data;
* `BY_CONDITION`: the entries of `about` that map names of conditions to settings; a folder with fewer
  conditions is extended;
* `jobs(quick)`: its trials as `experiments.jobs.Job`;
* `report(rows, quick)`: a `papers.Report` of the rows that exist;
* `kept(row)`: the entries of a row that claims, figures or numbers read; they are stored in the repository;
* `PICTURES`: pictures of the manual, each with its figure.

A paper of deodar may have a file `demo.py`, its quick form, which `deodar demo NAME` runs: `HELP`,
`arguments(parser)` and `run(args, show)`, which returns a `papers.Demonstration`.

Heavy imports are inside functions.
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
    """Import a part of reports, or a paper, when it is first used."""
    if name in ("NOT_RUN", "Report"):
        return getattr(importlib.import_module("deodar.papers._report"), name)
    return files(__name__)(name)


def files(package: str) -> Callable[[str], Any]:
    """Return the `__getattr__` of a package that imports its files when they are first used."""

    def __getattr__(name: str) -> Any:
        if name.startswith("_") or importlib.util.find_spec(f"{package}.{name}") is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=None)
        return importlib.import_module(f"{package}.{name}")

    return __getattr__


def names() -> list[str]:
    """Return the names of all papers: those of deodar, then those of installed packages."""
    return [*own(), *(p.name for p in packaged() if not p.problem)]


def own() -> list[str]:
    """Return the names of the papers of deodar: those of their folders, with hyphens."""
    return sorted(m.name.replace("_", "-") for m in pkgutil.iter_modules(__path__) if m.name[0] != "_")


def demos() -> dict[str, ModuleType]:
    """Return the demonstrations of deodar's papers, by the name of the paper."""
    paths = {name: f"deodar.papers.{name.replace('-', '_')}.demo" for name in own()}
    found = {name: path for name, path in paths.items() if importlib.util.find_spec(path)}
    return {name: importlib.import_module(path) for name, path in found.items()}


def packaged() -> list[Plugin]:
    """Return the names of the papers of installed packages, without importing them."""
    return plugins.found("papers", own())


def paper(name: str) -> ModuleType:
    """Return a paper by its name.

    Raises:
        UnknownName: no paper has this name (the nearest name is suggested), or its package cannot be used.
    """
    if name in own():
        return importlib.import_module(f"deodar.papers.{name.replace('-', '_')}")
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
