"""What the files of a folder state, as one table: each file of `classes` is one family."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

from deodar.errors import ModelError
from deodar.registry import imported


class HasNames(Protocol):
    """Something with names that a file can repeat."""

    @property
    def names(self) -> Sequence[str]: ...


Named = TypeVar("Named", bound=HasNames)


def merged(package: str, table: str) -> dict[Any, Any]:
    """Return the entries of the mapping `table` of every file that has one.

    Raises:
        ModelError: two files have an entry with the same key.
    """
    by_name: dict[Any, Any] = {}
    for module in imported(package):
        entries: Mapping[Any, Any] = getattr(module, table, {})
        twice = by_name.keys() & entries.keys()
        if twice:
            raise ModelError(f"{module.__name__}.{table} repeats {min(map(str, twice))}")
        by_name |= entries
    return by_name


def declared(package: str, kind: type[Named]) -> dict[str, Named]:
    """Return what the files define of one class, by each of its `names`.

    Raises:
        ModelError: two entries have one name.
    """
    entries = {id(e): e for module in imported(package) for e in vars(module).values() if isinstance(e, kind)}
    by_name: dict[str, Named] = {}
    for entry in entries.values():
        for name in entry.names:
            if name in by_name:
                raise ModelError(f"{package} defines {name} twice")
            by_name[name] = entry
    return by_name
