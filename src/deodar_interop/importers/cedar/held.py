"""The parameters of deodar's elements that hold the numbers of cedar's steps."""

from __future__ import annotations

import dataclasses as dc
import math
import re
from collections.abc import Mapping
from typing import Any

from deodar.errors import DeodarError
from deodar.leaves import get
from deodar.model.document import Entry
from deodar_interop.importers.cedar.file import CedarStep, members, pairs
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
