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
