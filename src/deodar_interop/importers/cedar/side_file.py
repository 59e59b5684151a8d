"""Learned values beside a file: `FILE.json.data`, with the traces and weights of its steps.

Each is text: a line `Mat,CV_32F,d0,d1,...`, then the numbers, first index fastest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from deodar import codec
from deodar.errors import DocumentError
from deodar.importers._beside import Beside
from deodar.importers.report import Line
from deodar_interop.importers.cedar.file import members, pairs
from deodar_interop.importers.cedar.grid import MOST_CELLS

ENDING = ".data"


class SideFile:
    """The stored arrays of a file by step and slot."""

    def __init__(self, name: str, beside: Beside) -> None:
        self.lines: list[Line] = []
        self.name = f"{name}{ENDING}"
        self.arrays: dict[tuple[str, str], np.ndarray] = {}
        try:
            content = beside(self.name)
            body = {} if content is None else members(codec.foreign(content))
        except DocumentError as error:
            self.lines.append(Line("", "file", self.name, "dropped", error.problems[0].what))
            body = {}
        for label, roles in body.items():
            self._add(label, roles)

    def _add(self, label: str, roles: Any) -> None:
        for _, slots in pairs(roles):
            for slot, text in pairs(slots):
                numbers = array(text)
                if numbers is None:
                    self.lines.append(
                        Line(label, "file", f"{self.name}: {slot}", "dropped", "it is no array")
                    )
                else:
                    self.arrays[label, slot] = numbers

    def of(self, label: str, slot: str, values: Mapping[str, Any]) -> np.ndarray | None:
        """Return the stored array of a slot: from the file beside, or from the step itself."""
        inside = members(values.get("stored data"))
        for roles in (inside, *(members(v) for v in inside.values())):
            if isinstance(roles.get(slot), str):
                return array(roles[slot])
        return self.arrays.get((label, slot), self.arrays.get((label.rpartition(".")[2], slot)))


def array(text: Any) -> np.ndarray | None:
    """Return the array of a text, without axes of one sample; None if it is none, or not finite."""
    if not isinstance(text, str):
        return None
    head, _, body = text.partition("\n")
    words = [w.strip() for w in head.split(",")]
    if len(words) < 3 or words[0] != "Mat":
        return None
    try:
        dims = [int(w) for w in words[2:] if w and w != "compact"]
        numbers = np.array([float(v) for v in body.replace("\n", ",").split(",") if v.strip()])
    except (ValueError, OverflowError):
        return None
    if not dims or min(dims) < 1 or math.prod(dims) != numbers.size or numbers.size > MOST_CELLS:
        return None
    if not np.isfinite(numbers).all():
        return None
    arranged = numbers.reshape(dims, order="F")
    return arranged.reshape([n for n in dims if n > 1]) if len(dims) <= 2 else arranged
