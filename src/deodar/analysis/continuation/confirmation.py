"""The thresholds of a field by two methods: bisection of runs, and folds of its steady states."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from deodar.analysis.continuation.continuation import continuation
from deodar.analysis.isolated import Isolated
from deodar.analysis.regimes import STRONG, Regimes
from deodar.analysis.thresholds import Transition
from deodar.codec import JsonObject
from deodar.errors import DeodarError
from deodar.model.model import Model

REACH = 0.3
"""Distance from the forgetting threshold within which the peak is followed, relative to the field's scale."""

NAMES = {"detection": "detection", "reverse": "reverse detection", "forgetting": "forgetting"}
"""Thresholds that are folds, by their names among the transitions, with the name of the bifurcation."""


@dataclass(frozen=True)
class Confirmation:
    """A threshold as a fold.

    Attributes:
        value: the fold; None: no such fold was found.
        inside: whether it lies in the interval of the bisection.
        why: why there is none; empty if there is one.
    """

    value: float | None
    inside: bool
    why: str = ""

    def data(self) -> JsonObject:
        """Return it as plain data."""
        return {"fold": self.value, "inside": self.inside, "why": self.why or None}


def confirmed(measured: Regimes) -> dict[str, Confirmation]:
    """Compute the thresholds of a field as folds, and compare them with the intervals of the bisection.

    Detection and reverse detection are folds over the localised input, forgetting one over the homogeneous
    input, with the peak that the localised input has made.

    Args:
        measured: the measured regime of a field.
    """
    return folds(measured.isolated, measured)


def folds(isolated: Isolated, measured: Regimes) -> dict[str, Confirmation]:
    """Compute the thresholds of an isolated field as folds.

    Args:
        isolated: the measured field, or the same field on another grid.
        measured: the measured regime, which states near which values the folds are.
    """
    up = measured.thresholds.detection
    if up is None or not up.jump:
        return {}
    model = Model(document=isolated.session.document, trusted=True)
    for name in ("input", "second", "boost"):
        model.set(f"{name}.amplitude", 0.0)
    transitions = {name: t for name, t in measured.transitions.items() if name in NAMES}
    first = min(0.0, 1.5 * transitions["reverse"].value) if "reverse" in transitions else 0.0
    over_input = _Ramp("input.amplitude", (first, 1.5 * up.after), {})
    out = _compared(model, over_input, transitions, ("detection", "reverse"))
    if "forgetting" in transitions and not central(isolated):
        why = "the input is not in the middle of each axis"
        out["forgetting"] = Confirmation(None, False, why)
    elif "forgetting" in transitions:
        boost, reach = transitions["forgetting"].value, REACH * isolated.scale
        over_boost = _Ramp(
            "boost.amplitude", (boost + reach, boost - reach), {"input.amplitude": STRONG * up.after}
        )
        out |= _compared(model, over_boost, transitions, ("forgetting",))
    return out


def central(isolated: Isolated) -> bool:
    """Return whether the localised input is in the middle of each axis, about which states may be even."""
    return all(
        abs(center - float(axis.points[[0, -1]].mean())) < 1e-6 * axis.range
        for center, axis in zip(isolated.center, isolated.axes, strict=True)
    )


@dataclass(frozen=True)
class _Ramp:
    """A parameter, its first and last value, and the inputs that make the state at the start."""

    parameter: str
    span: tuple[float, float]
    made: Mapping[str, float]


def _compared(
    model: Model, over: _Ramp, transitions: Mapping[str, Transition], names: tuple[str, ...]
) -> dict[str, Confirmation]:
    """Return the folds over one parameter that have these names."""
    present = [name for name in names if name in transitions]
    # a peak that outlives its input may stand anywhere: it stays in the middle of each axis
    field: Any = model["field"].element
    even = [axis.name for axis in field.axes] if over.made else []
    try:
        branch = continuation(model, over.parameter, over.span, over.made, even=even, finer=False)
    except DeodarError as error:
        return {name: Confirmation(None, False, error.problems[0].what) for name in present}
    out: dict[str, Confirmation] = {}
    for name in present:
        low, high = transitions[name].interval
        folds = [b.value for b in branch.bifurcations if b.instability == NAMES[name]]
        if not folds:
            out[name] = Confirmation(None, False, "the branch has no such fold")
            continue
        nearest = min(folds, key=lambda value: abs(value - transitions[name].value))
        out[name] = Confirmation(nearest, low <= nearest <= high)
    return out
