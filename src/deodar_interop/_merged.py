"""The tables of the files of a folder as one: each file of `classes` states those of one family."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from deodar.errors import ModelError
from deodar.registry import imported


def merged(package: str, table: str) -> dict[Any, Any]:
    """Return the entries of the mapping `table` of every file that has one.

    Raises:
        ModelError: two files have an entry with the same key.
    """
    found: dict[Any, Any] = {}
    for module in imported(package):
        entries: Mapping[Any, Any] = getattr(module, table, {})
        twice = found.keys() & entries.keys()
        if twice:
            raise ModelError(f"{module.__name__}.{table} repeats {min(map(str, twice))}")
        found |= entries
    return found


def union(package: str, names: str) -> frozenset[str]:
    """Return the names in the set `names` of every file that has one."""
    return frozenset[str]().union(*(getattr(module, names, ()) for module in imported(package)))
