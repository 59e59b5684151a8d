"""One element of another tool's file as plain data: names, and keys that occur more than once."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterable, Mapping
from typing import Any, cast

from deodar.codec import repeated
from deodar.importers.report import Line
from deodar.parameters import show


def repeated_keys(data: Any, label: Callable[[dict[str, Any]], str | None]) -> list[Line]:
    """Return a report line for each repeated key.

    Args:
        data: the content of the file, as `codec.foreign` returned it.
        label: returns the label of an object that is an element, else None; the line then belongs to it.
    """
    lines: list[Line] = []
    for repetition in repeated(data):
        inside, owner, path = data, "", list[Any]()
        for step in repetition.path:
            inside = inside[step]
            path.append(step)
            name = label(cast("dict[str, Any]", inside)) if isinstance(inside, dict) else None
            if name is not None:
                owner, path = name, []
        key = ".".join(str(step) for step in (*path, repetition.key))
        values = ", ".join(show(value) for value in repetition.values)
        why = f"it occurs {len(repetition.values)} times, with the values {values}; the last one is used"
        lines.append(Line(owner, "key", key, "approximated", why))
    return lines


class FreeNames:
    """The names in use; a repeated name gets a number."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)
        self._numbers: dict[str, int] = {}

    def new(self, base: str) -> str:
        """Return an unused name: `base`, else `base 2`, `base 3`, ..."""
        name, n = base, self._numbers.get(base, 1)
        while name in self._taken:
            n += 1
            name = f"{base} {n}"
        self._numbers[base] = n
        self._taken.add(name)
        return name


@dc.dataclass(frozen=True)
class Source:
    """One input of an element: the label of its source, and the source's component or ""."""

    label: str
    component: str = ""


@dc.dataclass(frozen=True)
class Foreign:
    """One element of the file: its index in the list, its label and class, its parameters unconverted, and
    its inputs in order.
    """

    place: int
    label: str
    kind: str
    values: Mapping[str, Any]
    sources: tuple[Source, ...]


def plain_text(value: Any) -> str:
    """Return a label as valid text: unpaired surrogates and control characters are replaced."""
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        return ""
    text = str(value)[:500].encode("utf-8", "replace").decode()
    return "".join(c if c.isprintable() else " " for c in text).strip()
