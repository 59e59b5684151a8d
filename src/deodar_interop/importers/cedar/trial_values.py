"""Parameters that an experiment of cedar changes, with their values in the file and at any moment."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from typing import Any

from deodar.model.document import Entry
from deodar.model.paths import display
from deodar_interop.importers.cedar.file import CedarStep, StepPath, members, text
from deodar_interop.importers.cedar.held import TIMES, held
from deodar_interop.importers.cedar.values import milliseconds, number

SWITCH, STRENGTH = "active", "strength"
"""Parameters of a boost, of which deodar has the product."""


@dc.dataclass(frozen=True)
class ChangedParameter:
    """A parameter of a step.

    Attributes:
        step: path of the step.
        name: the parameter.
        path: path of deodar's parameter.
        sign: factor from cedar's number to deodar's.
        value: cedar's number in the file, or its default.
    """

    step: StepPath
    name: str
    path: str
    sign: float
    value: float


class TrialParameters:
    """The parameters of the steps of a file.

    Args:
        steps: steps of the file by path.
        entries: elements of the document by path.
    """

    def __init__(self, steps: Mapping[StepPath, CedarStep], entries: Mapping[StepPath, Entry]) -> None:
        self.steps = steps
        self.entries = entries

    def find(self, body: Mapping[str, Any]) -> ChangedParameter | None:
        """Return the parameter that an action names; None without a counterpart."""
        path = tuple(text(body.get("element path", body.get("Step"))).split("."))
        name = text(body.get("parameter path", body.get("Property")))
        step, entry = self.steps.get(path), self.entries.get(path)
        if step is None or entry is None:
            return None
        prefix = f"{display(entry.names)}."
        if step.short == "Boost" and name in (SWITCH, STRENGTH):
            boost_value = float(self.boost(path)[name == STRENGTH])
            return ChangedParameter(path, name, f"{prefix}amplitude", 1.0, boost_value)
        holder = held(step, entry, name)
        if holder is None:
            return None
        return ChangedParameter(path, name, f"{prefix}{holder.leaf}", holder.sign, holder.value)

    def given(self, parameter: ChangedParameter, value: Any) -> float | None:
        """Return the number of a value for a parameter; None if it is none."""
        if parameter.name == SWITCH:
            return {"true": 1.0, "1": 1.0, "false": 0.0, "0": 0.0}.get(text(value) or str(value).lower())
        return milliseconds(value) if parameter.name in TIMES else number(value)

    def boost(self, path: StepPath) -> tuple[bool, float]:
        """Return whether a boost is active in the file, and its strength."""
        values = self.steps[path].values
        strength = number(values.get(STRENGTH, 1.0))
        return text(values.get(SWITCH)) == "true", 1.0 if strength is None else strength

    def here(self, parameter: ChangedParameter, values: Mapping[tuple[StepPath, str], float]) -> float:
        """Return deodar's number of a parameter, with cedar's numbers of all that were changed."""
        if self.steps[parameter.step].short != "Boost":
            return parameter.sign * values.get((parameter.step, parameter.name), parameter.value)
        active, strength = self.boost(parameter.step)
        in_file = {SWITCH: float(active), STRENGTH: strength}
        return values.get((parameter.step, SWITCH), in_file[SWITCH]) * values.get(
            (parameter.step, STRENGTH), in_file[STRENGTH]
        )


def named(body: Mapping[str, Any]) -> dict[str, Any]:
    """Return the object of an action that names its parameter."""
    return members(body.get("Step Parameter", body.get("StepParameter", body)))
