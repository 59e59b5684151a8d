"""The tables of the files of a folder as one: each file of `classes` states those of one family."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from types import ModuleType
from typing import Any

from deodar.errors import ModelError


def modules(package: str) -> list[ModuleType]:
    """Import the files of a package, in the order of their names."""
    path = importlib.import_module(package).__path__
    names = sorted(module.name for module in pkgutil.iter_modules(path))
    return [importlib.import_module(f"{package}.{name}") for name in names]


def merged(package: str, table: str) -> dict[Any, Any]:
    """Return the entries of the mapping `table` of every file that has one.

    Raises:
        ModelError: two files have an entry with the same key.
    """
    found: dict[Any, Any] = {}
    for module in modules(package):
        entries: Mapping[Any, Any] = getattr(module, table, {})
        twice = found.keys() & entries.keys()
        if twice:
            raise ModelError(f"{module.__name__}.{table} repeats {min(map(str, twice))}")
        found |= entries
    return found


def union(package: str, names: str) -> frozenset[str]:
    """Return the names in the set `names` of every file that has one."""
    return frozenset[str]().union(*(getattr(module, names, ()) for module in modules(package)))
