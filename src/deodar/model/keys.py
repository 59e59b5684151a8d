"""Keys that occur more than once in one object of a JSON text.

A plain dictionary keeps the last value and hides the others.
"""

from __future__ import annotations

import dataclasses as dc
from typing import Any, cast

KeyStep = str | int
"""Key of an object, or position in a list."""


class Ambiguous(dict[str, Any]):
    """An object of a JSON text in which keys occur more than once: each key with its last value, as `json`
    gives it.

    `pairs` holds all keys and values in the order of the text.
    """

    pairs: list[tuple[str, Any]]


@dc.dataclass(frozen=True)
class Repeated:
    """A key that occurs more than once.

    Attributes:
        path: steps from the root to the object that holds it.
        key: the key.
        values: every value that it has, in the order of the text; the last one is in use.
    """

    path: tuple[KeyStep, ...]
    key: str
    values: tuple[Any, ...]

    @property
    def where(self) -> str:
        """The path of the object as text; "" for the root."""
        return ".".join(str(step) for step in self.path)


def collect(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object of a JSON text, to be given to `json.loads` as `object_pairs_hook`.

    It marks the objects that `repeated` looks for.
    """
    out = dict(pairs)
    if len(out) == len(pairs):
        return out
    marked = Ambiguous(out)
    marked.pairs = pairs
    return marked


def repeated(data: Any) -> list[Repeated]:
    """All keys that occur more than once, outermost objects first; `data` was read with `collect`."""
    found: list[Repeated] = []
    level: list[tuple[tuple[KeyStep, ...], Any]] = [((), data)]
    while level:
        below: list[tuple[tuple[KeyStep, ...], Any]] = []
        for path, item in level:
            if isinstance(item, Ambiguous):
                values: dict[str, list[Any]] = {}
                for key, value in item.pairs:
                    values.setdefault(key, []).append(value)
                found += [
                    Repeated(path, key, tuple(several)) for key, several in values.items() if len(several) > 1
                ]
            inside = (
                cast("dict[str, Any]", item).items()
                if isinstance(item, dict)
                else enumerate(cast("list[Any]", item))
            )
            below += [((*path, step), value) for step, value in inside if isinstance(value, (dict, list))]
        level = below
    return found
