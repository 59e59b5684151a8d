"""The parameters of one element of a file, read with their defaults; each reading adds a report line."""

from __future__ import annotations

import math
from typing import TypeVar

from deodar.importers._foreign import Foreign
from deodar.importers.report import Line, Verdict
from deodar.parameters import show

LARGEST = 1e30
"""Largest number; larger ones overflow in single precision when they are squared or multiplied."""

Default = TypeVar("Default")


class ForeignValues:
    """The parameter values of an element, in the notation of a tool, which a subclass knows."""

    def __init__(self, element: Foreign) -> None:
        self.element = element
        self.lines: dict[str, Line] = {}

    def single(self, name: str) -> float | None:
        """Return a value of the file as one number; None if it is something else."""
        raise NotImplementedError

    def number(self, name: str, default: float, lower: float = -LARGEST, upper: float = LARGEST) -> float:
        """Return one number; a value that is not a number or out of bounds is replaced and reported."""
        if name not in self.element.values:
            return self.absent(name, default)
        value = self.single(name)
        if value is None or not math.isfinite(value):
            return self.instead(name, default)
        inside = min(max(value, lower), upper)
        if inside != value:
            self.say(name, "approximated", f"{value:g} is out of range; {inside:g} is used")
        else:
            self.say(name)
        return inside

    def absent(self, name: str, default: Default) -> Default:
        """Return the value of a parameter that is not in the file."""
        return default

    def say(self, name: str, verdict: Verdict = "carried", why: str = "") -> None:
        """Add a report line about a parameter."""
        self.lines[name] = Line(self.element.label, "parameter", name, verdict, why)

    def instead(self, name: str, default: Default) -> Default:
        """Return the default of a parameter whose value in the file has no meaning, and report it."""
        self.say(name, "approximated", f"it is {show(self.element.values[name])}; {show(default)} is used")
        return default

    def rest(self) -> list[Line]:
        """Return all report lines; a parameter that was not read is `dropped`."""
        for name in self.element.values:
            if name not in self.lines:
                self.say(
                    name, "dropped", f"{self.element.kind} has no such parameter, or it has no effect here"
                )
        return list(self.lines.values())
