"""The parameters of one element of a file, read with their defaults; each reading adds a report line."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar, TypeVar

from deodar.importers.report import Line, Verdict
from deodar.parameters import show

LARGEST = 1e30
"""Largest number; larger ones overflow in single precision when they are squared or multiplied."""

Default = TypeVar("Default")


class ForeignValues:
    """The parameter values of an element, in the notation of a tool, which a subclass knows.

    Attributes:
        body: the parameters as the file has them.
        where: label of the element.
        lines: report lines by the name of the parameter.
        ignored: parameters that change nothing of what an element computes, and are not reported.
    """

    ignored: ClassVar[tuple[str, ...]] = ()

    def __init__(self, body: Mapping[str, Any], where: str) -> None:
        self.body = body
        self.where = where
        self.lines: dict[str, Line] = {}

    def key(self, name: str) -> str:
        """Return the name of a parameter in the report."""
        return name

    def single(self, name: str) -> float | None:
        """Return a value of the file as one number; None if it is something else."""
        raise NotImplementedError

    def number(self, name: str, default: float, lower: float = -LARGEST, upper: float = LARGEST) -> float:
        """Return one number; a value that is not a number or out of bounds is replaced and reported."""
        if name not in self.body:
            return self.absent(name, default)
        stated = self.single(name)
        if stated is None or not math.isfinite(stated):
            return self.instead(name, default)
        inside = min(max(stated, lower), upper)
        if inside != stated:
            self.say(name, "approximated", f"{stated:g} is out of range; {inside:g} is used")
        else:
            self.say(name)
        return inside

    def absent(self, name: str, default: Default) -> Default:
        """Return the value of a parameter that is not in the file."""
        return default

    def say(self, name: str, verdict: Verdict = "carried", why: str = "") -> None:
        """Add a report line about a parameter."""
        key = self.key(name)
        self.lines[key] = Line(self.where, "parameter", key, verdict, why)

    def instead(self, name: str, default: Default) -> Default:
        """Return the default of a parameter whose value in the file has no meaning, and report it."""
        self.say(name, "approximated", f"it is {show(self.body[name])}; {show(default)} is used")
        return default

    def rest(self, kind: str) -> list[Line]:
        """Return all report lines; a parameter of this kind of element that was not read is `dropped`."""
        for name in self.body:
            if name not in self.ignored and self.key(name) not in self.lines:
                self.say(name, "dropped", f"{kind} has no such parameter, or it has no effect here")
        return list(self.lines.values())
