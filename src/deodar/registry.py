"""The registry of kinds: every module of an extension folder registers one kind, or a family of siblings.

A *room* is an extension folder (`deodar.elements`, `deodar.couplings`, ...), or one module with all kinds of
a sort. Its modules are imported when a kind is first looked up; one that registers no kind is refused. Kinds
of installed packages are found by the entry points `deodar.kinds` and `deodar.worlds` (`plugins.py`); looking
up one of them imports it alone.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar

from deodar import plugins
from deodar.errors import ModelError, UnknownName, did_you_mean
from deodar.plugins import Plugin
from deodar.synonyms import KINDS

ROOMS = ("numerics.sigmoids", "numerics.kernels", "elements", "couplings", "worlds")

T = TypeVar("T", bound=type[Any])

_kinds: dict[str, type[Any]] = {}


def register(cls: T) -> T:
    """Class decorator: register `cls` under its class name, the `kind` that documents store."""
    owner = _kinds.get(cls.__name__)
    if owner is not None and owner.__module__ != cls.__module__:
        raise ModelError(
            f"the kind {cls.__name__!r} is registered twice, by {owner.__module__} and by {cls.__module__}",
            fix="Give one of them another class name",
        )
    _kinds[cls.__name__] = cls
    return cls


def own(cls: type[Any]) -> bool:
    """Return whether a class is part of the distribution deodar: of the engine, or of a package beside it."""
    return plugins.is_own(cls.__module__)


def modules(package: str) -> list[str]:
    """Return the names of the modules of a folder whose files are found, not listed.

    They are its files and, for each folder in it, the file with the folder's name
    (`worlds/arena/arena.py`), or the folder itself without such a file. Names that begin with an underscore
    are left out. A file in place of a folder is the only module.
    """
    paths = getattr(importlib.import_module(package), "__path__", None)
    if paths is None:
        return [package]
    found = sorted(pkgutil.iter_modules(paths), key=lambda module: module.name)
    return [
        f"{package}.{module.name}{_within(paths, module.name) if module.ispkg else ''}"
        for module in found
        if not module.name.startswith("_")
    ]


def imported(package: str) -> list[Any]:
    """Import and return the modules of such a folder, in the order of their names."""
    return [importlib.import_module(name) for name in modules(package)]


def _within(paths: Iterable[str], name: str) -> str:
    return f".{name}" if any(Path(path, name, f"{name}.py").is_file() for path in paths) else ""


def kinds(room: str | None = None) -> dict[str, type[Any]]:
    """Return every registered kind by name, or those of one room.

    Kinds of packages belong to the room None, worlds of packages also to `worlds`; kinds of other modules
    that were imported belong to the room of the class that they are made from.
    """
    for each in ROOMS:
        _scan(each)
    outside = [p for p in packaged() if room is None or p.group == room]
    taken = {p.name for p in outside if not take(p)}
    return {
        name: cls
        for name, cls in sorted(_kinds.items())
        if room is None or name in taken or _belongs(cls, room)
    }


def _belongs(cls: type[Any], room: str) -> bool:
    """Return whether a class is of a room, or, if it is not deodar's own, of a base class there."""
    line = (cls,) if own(cls) else cls.__mro__
    return any(f"{base.__module__}.".startswith(f"deodar.{room}.") for base in line)


def kind(name: str) -> type[Any]:
    """Return the class registered under `name`, of deodar or of an installed package.

    Raises:
        UnknownName: if no kind has that name (the nearest is suggested), or its package cannot be used.
    """
    if name not in _kinds:
        for each in ROOMS:
            _scan(each)
    if name not in _kinds:
        outside = {p.name: p for p in reversed(packaged())}
        if name not in outside:
            raise UnknownName(
                f"no element, coupling, kernel or sigmoid is called {name!r}",
                fix=did_you_mean(name, [*_kinds, *outside], KINDS),
            )
        problem = take(outside[name])
        if problem:
            of = outside[name]
            raise UnknownName(
                f"{name!r} cannot be used: the package {of.package} {of.version} {problem}",
                fix="Type: deodar doctor",
            )
    return _kinds[name]


def registered(name: str) -> type[Any] | None:
    """Return the class that is registered under a name by now; None: there is none."""
    return _kinds.get(name)


def packaged() -> list[Plugin]:
    """Return the kinds and worlds of installed packages, without importing them."""
    taken = [name for name, cls in _kinds.items() if own(cls)]
    return [*plugins.found("kinds", taken), *plugins.found("worlds", taken)]


def take(plugin: Plugin) -> str:
    """Register the kind of a package; return the problem, "" without a problem."""
    before = set(_kinds)
    cls, problem = plugin.load()
    if not problem and getattr(cls, "__name__", "") != plugin.name:
        problem = f"names {plugin.entry.value} as {plugin.name!r}, which is not a class of that name"
    if problem:
        for extra in set(_kinds) - before:  # a module that raises may have registered some of its kinds
            del _kinds[extra]
        return problem
    _kinds.setdefault(plugin.name, cls)
    return ""


def package(name: str) -> str:
    """Return name and version of the package of a registered kind, in the form of documents; "" for a kind of
    deodar.
    """
    cls = _kinds.get(name)
    if cls is None or own(cls):
        return ""
    outside = (p for p in packaged() if p.name == name)
    return next((f"{p.package} {p.version}" for p in outside if p.load()[0] is cls), "")


def _scan(room: str) -> None:
    for module in modules(f"deodar.{room}"):
        importlib.import_module(module)
        if all(cls.__module__ != module for cls in _kinds.values()):
            raise ModelError(f"{module} registers no kind; a file of an extension folder registers its kinds")
