"""Published experiments, run again: a folder for each paper, named by an entry point `deodar.papers`.

A paper is a module or a package with

* `HELP`: one line;
* `about(quick)`: the settings of its design, as plain data;
* `BY_CONDITION`: the entries of `about` that map names of conditions to settings; a folder with fewer
  conditions is extended;
* `jobs(quick)`: its trials as `experiments.jobs.Job`;
* `report(rows, quick)`: a `papers.Report` of the rows that exist;
* `kept(row)`: the entries of a row that claims, figures or numbers read; they are stored in the repository;
* `PICTURES`: pictures of the manual, each with its figure.

A paper that is a package may have a file `demo.py`, its quick form, which `deodar demo NAME` runs: `HELP`,
`arguments(parser)` and `run(args, show)`, which returns a `papers.Demonstration`. `deodar demo`
without a name runs the file of `story`, which is no paper.

Heavy imports are inside functions.
"""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any

from deodar.extensions import Extensions
from deodar_papers._demonstration import Demonstration as Demonstration
from deodar_papers._demonstration import Show as Show

if TYPE_CHECKING:
    from deodar_papers._report import NOT_RUN as NOT_RUN
    from deodar_papers._report import Report as Report


def __getattr__(name: str) -> Any:
    """Import a part of reports, or a paper, when it is first used."""
    if name in ("NOT_RUN", "Report"):
        return getattr(importlib.import_module("deodar_papers._report"), name)
    return files("deodar_papers")(name)


def files(package: str) -> Callable[[str], Any]:
    """Return the `__getattr__` of a package that imports its files when they are first used."""

    def __getattr__(name: str) -> Any:
        if name.startswith("_") or importlib.util.find_spec(f"{package}.{name}") is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=None)
        return importlib.import_module(f"{package}.{name}")

    return __getattr__


PAPERS: Extensions[ModuleType] = Extensions("papers", "paper", dict, lambda plugin, module: "")
"""The papers by name."""


def demos() -> dict[str, ModuleType]:
    """Return the demonstrations: the story, and those of all papers by the name of the paper."""
    places = {"story": "deodar_papers.story", **{name: paper.__name__ for name, paper in PAPERS.items()}}
    modules = {name: f"{place}.demo" for name, place in places.items()}
    return {
        name: importlib.import_module(path)
        for name, path in modules.items()
        if importlib.util.find_spec(path)
    }
