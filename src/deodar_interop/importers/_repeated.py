"""Keys that occur more than once in an object of an imported file."""

from __future__ import annotations

from collections.abc import Callable
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
