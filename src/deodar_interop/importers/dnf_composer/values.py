"""The parameters of one element, in the notation of dnf-composer."""

from __future__ import annotations

from typing import Any, cast

from deodar.numerics.kernels.separable import NARROWEST
from deodar.parameters import show
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._values import LARGEST, ForeignValues
from deodar_interop.importers.dnf_composer.file import number

WIDEST = 1e9
"""Largest width in samples; a wider Gaussian is constant over any axis."""


class StoredValues(ForeignValues):
    """The parameter values of an element. The default of a parameter that is not in the file is reported,
    because dnf-composer refuses such a file.
    """

    def __init__(self, element: Foreign) -> None:
        super().__init__(element.values, element.label)
        self.optional: set[str] = set()

    def single(self, name: str) -> float | None:
        return number(self.body[name])

    def absent(self, name: str, default: Any) -> Any:
        if name not in self.optional:
            self.say(name, "approximated", f"it is not in the file; {show(default)} is used")
        return default

    def width(self, name: str, default: float) -> float:
        """Return the width of a Gaussian; at 0, where dnf-composer computes 0 / 0, a single sample."""
        width = self.number(name, default, 0.0, WIDEST)
        if width == 0 and name in self.body:
            self.say(name, "approximated", "a width of 0 has no values; a single sample is used")
        return max(width, NARROWEST)

    def flag(self, name: str, default: bool) -> bool:
        """Return a switch; older programs may have written it as 0 or 1."""
        if name not in self.body:
            return self.absent(name, default)
        flag = self.body[name]
        if isinstance(flag, bool):
            self.say(name)
            return flag
        if number(flag) in (0, 1):
            self.say(name, "approximated", f"it is {flag}, read as {show(bool(flag))}")
            return bool(flag)
        return self.instead(name, default)

    def choice(self, name: str, choices: tuple[str, ...]) -> str:
        """Return one of several words, which the file gives by its number; the first one is the default."""
        if name not in self.body:
            return choices[0]
        index = number(self.body[name])
        if index is None or index not in range(len(choices)):
            self.say(name, "approximated", f"it is {show(self.body[name])}; {choices[0]} is used")
            return choices[0]
        self.say(name, "carried", choices[int(index)])
        return choices[int(index)]

    def rows(self, name: str, width: int) -> list[list[float]]:
        """Return rows of `width` numbers; others are reported and left out."""
        stated = self.body.get(name)
        if stated is None or stated == {}:
            if name in self.body:
                self.say(name)
            return []
        entries = cast("list[Any]", stated) if isinstance(stated, list) else [stated]
        rows = [
            [min(max(v, -LARGEST), LARGEST) for n in cast("list[Any]", row) if (v := number(n)) is not None]
            for row in entries
            if isinstance(row, list) and len(cast("list[Any]", row)) == width
        ]
        good = [row for row in rows if len(row) == width]
        lost = len(entries) - len(good)
        if lost:
            why = f"{lost} of {len(entries)} entries are not {width} numbers, and are left out"
            self.say(name, "approximated" if good else "dropped", why)
        else:
            self.say(name)
        return good
