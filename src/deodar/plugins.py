"""Packages that extend the engine, found by their entry points: those beside it in the distribution deodar,
and those of others.

A package lists its extensions in its metadata, for example

    [project.entry-points."deodar.kinds"]
    Change = "deodar_change.change:Change"

An extension is imported when its name is looked up. A problem with a package is text, not an error: all other
extensions work, and `deodar doctor` lists the problem.
"""

from __future__ import annotations

import functools
import importlib.metadata
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, cast

from deodar import __version__
from deodar.errors import Problem, UnknownName, first_line, show

GROUPS = {
    "kinds": "elements, couplings, kernels and sigmoids, by the name of their class",
    "worlds": "worlds, by the name of their class",
    "measures": "measures of experiments: classes derived from dd.BaseMeasure, by their names",
    "figures": "modules with ACROSS, size and fill; with paint where ACROSS is true",
    "importers": "modules with NAME, sniff and read",
    "exporters": "modules with NAME, ENDING, HELP, and write (of models) or save (of records)",
    "names": "public names: what `dd.NAME` is",
    "examples": "modules whose folder holds documents and scripts, for example:NAME",
    "commands": "modules with HELP, arguments and run",
    "groups": "groups that packages define: their deodar.extensions.Extensions",
}
"""The kind of object that the entry points of each group `deodar.GROUP` refer to."""

OWN = "deodar"
"""The distribution of the engine and of the packages beside it."""

PACKAGE = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,99} [0-9A-Za-z][0-9A-Za-z.!+_-]{0,49}")
"""Name and version of a package, as files state them under `packages`."""


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

    @property
    def first_party(self) -> bool:
        """Whether the package comes with deodar."""
        return self.package == OWN

    def load(self) -> tuple[Any, str]:
        """Import the object, once; return it and "", or None and the problem."""
        return (None, self.problem) if self.problem else _load(self)


def found(group: str, taken: Collection[str] = ()) -> list[Plugin]:
    """Return the entry points of a group, those of deodar's own packages first, in the order of packages.

    A name that deodar (`taken`) or an earlier package already has is a problem.
    """
    out: list[Plugin] = []
    owners = dict.fromkeys(taken, OWN)
    for entry in _all().get(f"deodar.{group}", ()):
        name, package = entry.point.name, entry.package
        owner = owners.setdefault(name, package)
        problem = f"takes the name {name!r}, which {owner} has" if owner != package else _misfit(package)
        out.append(Plugin(group, name, package, entry.version, problem, entry.point))
    return out


def stated(data: Any, problems: list[Problem]) -> dict[str, str]:
    """Return the package and its version for each name that a file lists under `packages`.

    Anything else than a package and its version is added to `problems`.
    """
    if not isinstance(data, dict):
        problems.append(Problem("packages", f"needs an object, not {type(data).__name__}"))
        return {}
    out: dict[str, str] = {}
    for name, text in cast("dict[str, Any]", data).items():
        if isinstance(text, str) and PACKAGE.fullmatch(text):
            out[name] = text
        else:
            what = f"needs a package and its version, such as 'deodar-change 0.1.0', not {show(text)}"
            problems.append(Problem(f"packages.{name}", what))
    return out


def unfit(
    needed: Mapping[str, str], package: Callable[[str], str], known: Collection[str]
) -> Iterator[Problem]:
    """Yield the packages of a file that are missing or have another version: the cause of other problems.

    Args:
        needed: the package and version for each name, as the file states them.
        package: function that returns the present package and version of a name; it raises UnknownName if the
            name cannot be used.
        known: names from installed packages, usable or not.
    """
    for name, text in needed.items():
        where = f"packages.{name}"
        try:
            here = package(name)
        except UnknownName:
            if name not in known:
                project, _, version = text.partition(" ")
                yield Problem(
                    where,
                    f"{name} is of the package {text}, which is not installed",
                    f"If you trust it, type: pip install {project}=={version}",
                )
            continue
        if here != text:
            now = here or "a module that is in no package"
            yield Problem(where, f"was saved with {text}; {name} is of {now} now")


def is_own(module: str) -> bool:
    """Return whether a module comes with deodar: in the engine, or in a package beside it."""
    return module.partition(".")[0] in _import_packages()


@functools.cache
def _import_packages() -> frozenset[str]:
    """Return the import packages of the distribution deodar: `deodar`, and those of its entry points.

    They are `deodar` alone where deodar is run without being installed.
    """
    try:
        entries = importlib.metadata.distribution(OWN).entry_points
    except importlib.metadata.PackageNotFoundError:
        entries = ()
    return frozenset({"deodar", *(entry.module.partition(".")[0] for entry in entries)})


@dataclass(frozen=True)
class _Entry:
    """An entry point, with name and version of its package."""

    package: str
    version: str
    point: importlib.metadata.EntryPoint


@functools.cache
def _all() -> dict[str, tuple[_Entry, ...]]:
    """Return the entry points by group, in the order of their packages, deodar first.

    The metadata of all packages are read once for all groups, and each package is parsed once.
    """
    everything = importlib.metadata.entry_points()
    packages: dict[int, tuple[str, str]] = {}
    groups: dict[str, tuple[_Entry, ...]] = {}
    for group in everything.groups:
        if not group.startswith("deodar."):
            continue
        entries: list[_Entry] = []
        for point in everything.select(group=group):
            assert point.dist is not None
            if id(point.dist) not in packages:
                packages[id(point.dist)] = point.dist.name, point.dist.version
            entries.append(_Entry(*packages[id(point.dist)], point))
        groups[group] = tuple(sorted(entries, key=lambda e: (e.package != OWN, e.package, e.point.name)))
    return groups


@functools.cache
def _misfit(package: str) -> str:
    """Return the problem if a package requires another version of deodar."""
    if package == OWN:
        return ""  # start-up time: it has no requirement of itself
    # start-up time
    from packaging.requirements import InvalidRequirement, Requirement
    from packaging.utils import canonicalize_name

    for text in importlib.metadata.requires(package) or ():
        try:
            requirement = Requirement(text)
        except InvalidRequirement:
            continue
        if canonicalize_name(requirement.name) == OWN and not requirement.specifier.contains(
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
