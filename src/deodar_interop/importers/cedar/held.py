"""The parameters that hold the numbers of cedar's steps, and their values in an experiment."""

from __future__ import annotations

import dataclasses as dc
import math
import re
from collections.abc import Mapping
from typing import Any

from deodar.errors import DeodarError
from deodar.leaves import get
from deodar.model.document import Entry
from deodar.model.paths import display
from deodar_interop.importers.cedar.file import CedarStep, StepPath, members, pairs, text
from deodar_interop.importers.cedar.values import milliseconds, number

NAMES: Mapping[str, Mapping[str, str]] = {
    "NeuralField": {
        "time scale": "tau",
        "resting level": "resting_level",
        "input noise gain": "noise",
        "global inhibition": "global_inhibition",
        "sigmoid.beta": "sigmoid.beta",
        "sigmoid.threshold": "sigmoid.threshold",
    },
    "StaticGain": {"gain factor": "factor"},
    "GaussInput": {"amplitude": "amplitude"},
    "BoxInput": {"amplitude": "amplitude"},
    "Boost": {"strength": "amplitude"},
    "ConstMatrix": {"value": "amplitude"},
    "Preshape": {"time scale build up": "tau_build", "time scale decay": "tau_decay"},
    "SpaceToRateCode": {"tau": "tau"},
    "SynapticConnection": {"static gain.Synapse Weight": "factor"},
}
"""Parameters of cedar's steps and of deodar's elements that hold the same number."""

KERNEL = re.compile(r"(?:lateral )?kernels\[(\d{1,3})\]\.(amplitude)\Z")
LISTED = re.compile(r"(.+)\[(\d{1,3})\]\Z")

OPPOSITE = ("global inhibition",)
"""Parameters whose sign is the opposite here."""

TIMES = ("time scale", "time scale build up", "time scale decay", "tau")
"""Parameters that are times."""

RELATIVE, ABSOLUTE = 1e-9, 1e-12
"""Differences up to which two numbers are the same: those of the rounding of a unit."""


@dc.dataclass(frozen=True)
class HeldNumber:
    """A parameter of an element that holds a number of a step.

    Attributes:
        leaf: path of the parameter inside the element.
        sign: factor from cedar's number to deodar's.
        value: cedar's number in the file, or its default.
    """

    leaf: str
    sign: float
    value: float


def held(step: CedarStep, entry: Entry, parameter: str) -> HeldNumber | None:
    """Return what holds the number of a parameter of a step.

    None without such a parameter, and where it is another number here: the amplitude of the kernel of a node,
    or the strength of an inactive boost.
    """
    kernel = KERNEL.match(parameter)
    leaf = f"kernel.{kernel[1]}.{kernel[2]}" if kernel else NAMES.get(step.short, {}).get(parameter)
    if leaf is None:
        return None
    sign = -1.0 if parameter in OPPOSITE else 1.0
    try:
        signed = sign * float(get(entry.element, leaf))
    except (DeodarError, TypeError, ValueError):  # a kernel that the field does not have
        return None
    in_file = stated(step.values, parameter)
    if in_file is not None and not math.isclose(in_file, signed, rel_tol=RELATIVE, abs_tol=ABSOLUTE):
        return None
    return HeldNumber(leaf, sign, signed)


def stated(values: Any, parameter: str) -> float | None:
    """Return the number of a parameter in the file; None if it does not state one."""
    for name in parameter.split("."):
        listed = LISTED.match(name)
        if listed:
            entries = pairs(members(values).get(listed[1]))
            k = int(listed[2])
            values = entries[k][1] if k < len(entries) else None
        else:
            values = members(values).get(name)
    return milliseconds(values) if parameter in TIMES else number(values)


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
