"""One element of another tool's file, as plain data."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from typing import Any


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
