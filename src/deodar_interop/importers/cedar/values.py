"""The parameters of one step, converted from text; each reading adds a line to the report."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from deodar.importers.report import Line
from deodar.parameters import show
from deodar_interop.importers._values import LARGEST, ForeignValues
from deodar_interop.importers.cedar.file import items, members, pairs, text

UNITS = {"s": 1000.0, "ms": 1.0, "us": 1e-3, "min": 60_000.0, "m": 60_000.0, "h": 3_600_000.0}
"""Units of time, in ms."""

NUMBER = re.compile(r"\s*([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)\s*([A-Za-z]*)\s*\Z")
"""A number as cedar writes it: old versions wrote the comma of the system's language."""


class StepValues(ForeignValues):
    """The parameters of a step, or of an object inside it, with the report lines about them.

    Attributes:
        prefix: path of the object inside the step, before the name of a parameter in the report.
    """

    ignored: ClassVar[tuple[str, ...]] = ("name", "comments", "threaded", "stored data")

    def __init__(
        self, body: Mapping[str, Any], where: str, prefix: str = "", lines: dict[str, Line] | None = None
    ) -> None:
        super().__init__(body, where)
        self.prefix = prefix
        if lines is not None:
            self.lines = lines

    def key(self, name: str) -> str:
        return f"{self.prefix}{name}"

    def single(self, name: str) -> float | None:
        return number(self.body[name])

    def inside(self, name: str, body: Any = None) -> StepValues:
        """Return the parameters of an object inside this one; its lines are added to these."""
        inner = members(self.body.get(name) if body is None else body)
        return StepValues(inner, self.where, f"{self.prefix}{name}.", self.lines)

    def time(self, name: str, default: float) -> float:
        """Return a time in ms; a number without a unit is in ms."""
        if name not in self.body:
            return default
        duration = milliseconds(self.body[name])
        if duration is None:
            return self.instead(name, default)
        if duration < 0:
            self.say(name, "approximated", f"{duration:g} ms is out of range; 0 is used")
            return 0.0
        self.say(name)
        return duration

    def whole(self, name: str, default: int, lower: int, upper: int) -> int:
        """Return a whole number."""
        return int(self.number(name, default, lower, upper))

    def flag(self, name: str, default: bool) -> bool:
        """Return a switch, written as `true` or `false`."""
        if name not in self.body:
            return default
        word = (
            text(self.body[name]).lower()
            if not isinstance(self.body[name], bool)
            else str(self.body[name]).lower()
        )
        if word not in ("true", "false", "1", "0"):
            return bool(self.instead(name, default))
        self.say(name)
        return word in ("true", "1")

    def word(self, name: str, default: str, choices: Sequence[str] = ()) -> str:
        """Return a word; one that is not among the choices is replaced and reported."""
        if name not in self.body:
            return default
        word = text(self.body[name])
        if choices and word not in choices:
            return str(self.instead(name, default))
        self.say(name)
        return word

    def numbers(
        self, name: str, default: float, count: int, lower: float = -LARGEST, upper: float = LARGEST
    ) -> list[float]:
        """Return `count` numbers; missing ones have the default value, as in cedar, and further ones are
        ignored.
        """
        if name not in self.body:
            return [default] * count
        entries = items(self.body[name])
        if not entries and text(self.body[name]):
            entries = [self.body[name]]
        parsed = [number(v) for v in entries]
        out = [default if v is None else min(max(v, lower), upper) for v in parsed[:count]]
        if any(v is None for v in parsed[:count]) or out != parsed[:count]:
            self.say(name, "approximated", f"it is {show(self.body[name])}; {out} is used")
        elif len(out) < count:
            self.say(
                name, "approximated", f"it has {len(out)} of {count} numbers; the others are {default:g}"
            )
        else:
            self.say(name)
        return out + [default] * (count - len(out))

    def object(self, name: str) -> tuple[str, StepValues] | None:
        """Return the type of an object and its parameters; None without the object."""
        if not isinstance(self.body.get(name), dict):
            return None
        self.say(name)
        inside = self.inside(name)
        return text(inside.body.get("type")), inside

    def objects(self, name: str) -> list[tuple[str, StepValues]]:
        """Return the objects of a list: the type of each and its parameters."""
        typed = pairs(self.body.get(name))
        if name in self.body:
            self.say(name)
        return [(kind, self.inside(f"{name}[{k}]", body)) for k, (kind, body) in enumerate(typed)]


def number(value: Any) -> float | None:
    """Return a number from text; None if it is none, not finite or too large."""
    if isinstance(value, bool):
        return float(value)
    match = NUMBER.match(str(value)) if isinstance(value, (str, int, float)) else None
    if match is None:
        return None
    out = float(match[1].replace(",", "."))
    return out if math.isfinite(out) and abs(out) <= LARGEST else None


def milliseconds(value: Any) -> float | None:
    """Return a time in ms from text such as `0.02 s`; a bare number is in ms."""
    match = NUMBER.match(str(value)) if isinstance(value, (str, int, float)) else None
    plain = number(value)
    if match is None or plain is None or (match[2] and match[2] not in UNITS):
        return None
    return plain * UNITS.get(match[2], 1.0)
