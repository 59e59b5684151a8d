"""Packages that extend deodar, found by their entry points.

A package lists its extensions in its metadata, for example

    [project.entry-points."deodar.kinds"]
    Change = "deodar_change.change:Change"

An extension is imported when its name is looked up. A problem with a package is text, not an error: all other
extensions work, and `deodar doctor` lists the problem.
"""

from __future__ import annotations

import functools
import importlib.metadata
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from deodar import __version__
from deodar.errors import first_line

GROUPS = {
    "kinds": "elements, couplings, kernels and sigmoids, by the name of their class",
    "worlds": "worlds, by the name of their class",
    "measures": "measures of experiments: classes derived from dd.BaseMeasure, by their names",
    "figures": "modules with ACROSS, size and fill; with paint where ACROSS is true",
    "importers": "modules with NAME, sniff and read",
    "commands": "modules with HELP, arguments and run",
    "papers": "modules with HELP, about, jobs, report and so on",
}
"""The kind of object that the entry points of each group `deodar.GROUP` refer to."""


@dataclass(frozen=True)
class Plugin:
    """One entry point of a package.

    Attributes:
        group: a key of `GROUPS`.
        name: name for look-ups.
        package: name of the installed package.
        version: version of the package.
        problem: reason why it cannot be imported, found without importing it; "" without a problem.
        entry: the entry point.
    """

    group: str
    name: str
    package: str
    version: str
    problem: str
    entry: importlib.metadata.EntryPoint

    def load(self) -> tuple[Any, str]:
        """Import the object, once; return it and "", or None and the problem."""
        return (None, self.problem) if self.problem else _load(self)


def found(group: str, taken: Collection[str] = ()) -> list[Plugin]:
    """Return the entry points of a group, in the order of their packages.

    A name that deodar (`taken`) or an earlier package already has is a problem.
    """
    out: list[Plugin] = []
    owners = dict.fromkeys(taken, "deodar")
    for entry in _entries(group):
        assert entry.dist is not None
        package, version = entry.dist.name, entry.dist.version
        owner = owners.setdefault(entry.name, package)
        problem = (
            f"takes the name {entry.name!r}, which {owner} has" if owner != package else _misfit(package)
        )
        out.append(Plugin(group, entry.name, package, version, problem, entry))
    return out


@functools.cache
def _entries(group: str) -> tuple[importlib.metadata.EntryPoint, ...]:
    entries = importlib.metadata.entry_points(group=f"deodar.{group}")
    return tuple(
        sorted(
            (e for e in entries if e.dist is not None), key=lambda e: (e.dist.name if e.dist else "", e.name)
        )
    )


@functools.cache
def _misfit(package: str) -> str:
    """Return the problem if a package requires another version of deodar."""
    # start-up time
    from packaging.requirements import InvalidRequirement, Requirement
    from packaging.utils import canonicalize_name

    for text in importlib.metadata.requires(package) or ():
        try:
            requirement = Requirement(text)
        except InvalidRequirement:
            continue
        if canonicalize_name(requirement.name) == "deodar" and not requirement.specifier.contains(
            __version__, prereleases=True
        ):
            return f"is made for deodar {requirement.specifier}, and this is {__version__}"
    return ""


@functools.cache
def _load(plugin: Plugin) -> tuple[Any, str]:
    try:
        return plugin.entry.load(), ""
    except (Exception, SystemExit) as error:  # a module may raise any exception
        return None, f"raises {type(error).__name__} when it is imported: {first_line(error)}"
