"""The folder is the registry: every module of an extension folder registers exactly one kind.

A *room* is an extension folder (`deodar.elements`, `deodar.couplings`, ...). `scan` imports its modules once, when a
kind is first looked up, and refuses a module that registers nothing or two things.
"""

from __future__ import annotations

import importlib
import pkgutil
from typing import Any, TypeVar

from deodar.errors import ModelError, UnknownName, did_you_mean

ROOMS = ("numerics.sigmoids", "numerics.kernels", "elements", "couplings", "worlds")

T = TypeVar("T", bound=type[Any])

_kinds: dict[str, type[Any]] = {}


def register(cls: T) -> T:
    """Class decorator: make `cls` known by its class name, the `kind` that documents store."""
    owner = _kinds.get(cls.__name__)
    if owner is not None and owner.__module__ != cls.__module__:
        raise ModelError(
            f"the kind {cls.__name__!r} is registered twice, by {owner.__module__} and by {cls.__module__}",
            fix="Give one of them another class name",
        )
    _kinds[cls.__name__] = cls
    return cls


def modules(room: str) -> list[str]:
    """Names of the modules of an extension folder; names that begin with an underscore are not extensions."""
    package = importlib.import_module(f"deodar.{room}")
    names = [module.name for module in pkgutil.iter_modules(package.__path__)]
    return [f"deodar.{room}.{name}" for name in sorted(names) if not name.startswith("_")]


def imported(room: str) -> list[Any]:
    """The modules of an extension folder themselves, in the order of their names."""
    return [importlib.import_module(name) for name in modules(room)]


def kinds(room: str | None = None) -> dict[str, type[Any]]:
    """Every registered kind by name, or those declared in one room; a user's own kinds belong to the room None."""
    for each in ROOMS:
        _scan(each)
    if room is None:
        return dict(sorted(_kinds.items()))
    return {name: cls for name, cls in sorted(_kinds.items()) if cls.__module__.startswith(f"deodar.{room}.")}


def kind(name: str) -> type[Any]:
    """The class registered under `name`; an unknown name is an error that suggests the nearest one."""
    if name not in _kinds:
        known = kinds()
        if name not in known:
            raise UnknownName(f"no element, coupling, kernel or sigmoid is called {name!r}", fix=did_you_mean(name, known))
    return _kinds[name]


def _scan(room: str) -> None:
    for module in modules(room):
        importlib.import_module(module)
        found = [name for name, cls in _kinds.items() if cls.__module__ == module]
        if len(found) != 1:
            raise ModelError(f"{module} registers {len(found)} kinds ({', '.join(found) or 'none'}); a file of an extension folder registers one")
