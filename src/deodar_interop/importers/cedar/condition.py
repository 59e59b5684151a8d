"""Conditions of cedar's experiments: in which trials, from when on, and after which data."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping
from typing import Any

from deodar_interop.importers.cedar.file import items, members, text
from deodar_interop.importers.cedar.values import milliseconds, number

OLD = {
    "OnInit": "OnEachTrial",
    "OnTrial": "OnTrialNumber",
    "CheckData": "OnMatrixValue",
    "SetParameter": "SetParameterValue",
    "ParameterAdd": "IncrementParameter",
    "StopAllTriggers": "EndTrial",
}
"""Earlier names of conditions and actions."""

DEEPEST = 16
"""Deepest nesting of conditions (a guess)."""


@dc.dataclass(frozen=True)
class DataCondition:
    """A comparison of all entries of some data, or of a number of them.

    Attributes:
        path: path of the data: `group.field[BUFFER].activation`.
        compare: ">", "<" or "=".
        value: the number to compare with.
        count: number of entries for which it holds; 0: all.
    """

    path: str
    compare: str
    value: float
    count: int


@dc.dataclass(frozen=True)
class TrialCondition:
    """What must hold together for a sequence of actions.

    Attributes:
        trial: number of the trial, from 1 on; 0: each; -1: two numbers that exclude each other.
        at: time in the trial, ms.
        data: comparisons of data.
    """

    trial: int = 0
    at: float = 0.0
    data: tuple[DataCondition, ...] = ()

    def and_also(self, other: TrialCondition) -> TrialCondition:
        """Return the condition that both hold."""
        numbers = {self.trial, other.trial} - {0}
        trial = 0 if not numbers else numbers.pop() if len(numbers) == 1 else -1
        return TrialCondition(trial, max(self.at, other.at), (*self.data, *other.data))


def short(kind: str) -> str:
    """Return the present name of a condition or action, without the names of its modules."""
    name = kind.rpartition(".")[2]
    return OLD.get(name, name)


def condition(body: Mapping[str, Any], level: int = 0) -> TrialCondition | None:
    """Return a condition; None if it is unknown, or a value in it has no meaning."""
    match short(text(body.get("type"))):
        case "OnEachTrial":
            return TrialCondition()
        case "OnTrialNumber":
            trial = number(body.get("on trial", 1))
            return None if trial is None or not 1 <= trial < 1e9 else TrialCondition(int(trial))
        case "AtTime":
            at = milliseconds(body.get("Time"))
            return None if at is None or at < 0 else TrialCondition(at=at)
        case "OnMatrixValue":
            data = _data(body)
            return None if data is None else TrialCondition(data=(data,))
        case "And" if level < DEEPEST:
            parts = [condition(members(body.get(f"Condition {k}")), level + 1) for k in (1, 2)]
            return None if parts[0] is None or parts[1] is None else parts[0].and_also(parts[1])
        case _:
            return None


def _data(body: Mapping[str, Any]) -> DataCondition | None:
    step_data = body.get("Step Data")
    parts = [text(v) for v in members(step_data).values()] or [text(v) for v in items(step_data)]
    value, compare = number(body.get("value")), text(body.get("compare operator"))
    count = number(body.get("number of elements", 1))
    if value is None or count is None or compare not in (">", "<", "="):
        return None
    whole = text(body.get("check full matrix")) != "false"
    return DataCondition(
        text(step_data) or ".".join(parts), compare, value, 0 if whole else max(int(count), 1)
    )


def rounded(at: float, dt: float) -> float:
    """Return a time as a whole number of steps: the first at it or later."""
    return math.ceil(at / dt - 1e-9) * dt
