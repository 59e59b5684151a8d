"""A requirement of a tuned field: the base class of those of deodar and of those that users write."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from deodar.analysis.tuning.response import FieldResponse
from deodar.codec import JsonObject
from deodar.errors import ParameterError
from deodar.parameters import real, show

QuantityKind = Literal["detection", "reverse detection", "forgetting", "width", "amplitude"]


@dataclass(frozen=True)
class ExactQuantity:
    """A quantity of the steady states of a field that is computed from the equations.

    Attributes:
        kind: a fold by its name in Dynamic Field Theory, or the width or amplitude of the peak.
        target: its stated value.
        within: the tolerance.
        strength: amplitude of the input that makes the peak.
    """

    kind: QuantityKind
    target: float
    within: float
    strength: float


class Requirement:
    """What a field is to do with its input; derive a class for one of your own.

    A subclass is a frozen dataclass that defines `margin`, and perhaps `value` and `contradicts`. The field
    is measured alone, without noise, for many candidates at once:

        @dataclass(frozen=True)
        class Quiet(dd.Requirement):
            below: float

            def margin(self, response):
                return response.silent(response.above(), self.below)
    """

    needs_axis: ClassVar[bool] = False
    """Whether it has no meaning on a node."""

    def margin(self, response: FieldResponse) -> np.ndarray:
        """Return for each candidate by how much the requirement is met: 0 or above where it is.

        In units of its tolerance: 1 in the middle of the tolerated range, 0 at its ends, below 0 beyond. Of a
        requirement without a value 1 is the largest, and far below 0 the margin still grows towards where it
        is met, as well as it can.
        """
        raise NotImplementedError

    def value(self, response: FieldResponse) -> np.ndarray | None:
        """Return the measured value for each candidate; None if the requirement has none."""
        return None

    def exact(self, strength: float) -> ExactQuantity | None:
        """Return the quantity whose value can be reached exactly; None if there is none.

        Args:
            strength: amplitude of the inputs of the protocol.
        """
        return None

    def contradicts(self, other: Requirement) -> str:
        """Return why no field meets both; empty if one may."""
        return ""

    def data(self) -> JsonObject:
        """Return it as plain data."""
        return {"text": str(self)}


def accepted(name: str, value: float, positive: bool = False) -> float:
    """Return a finite number.

    Raises:
        ParameterError: it is none, or not above 0 where `positive`.
    """
    number = real(value)
    if number is None or not np.isfinite(number) or (positive and number <= 0):
        rule = "a finite number above 0" if positive else "a finite number"
        raise ParameterError(f"{name} is {show(value)}; expected {rule}")
    return number


def accepted_strength(strength: float | None) -> float | None:
    """Return the amplitude of an input, or None."""
    return None if strength is None else accepted("strength", strength, positive=True)


def banded(value: np.ndarray, target: float, within: float) -> np.ndarray:
    """Return the margin of a value: 1 at the target, 0 at the ends of the tolerated range."""
    return 1 - np.abs(value - target) / within


def apart(name: str, at: float, within: float, other_at: float, other_within: float) -> str:
    """Return why two tolerated ranges of one quantity have nothing in common; empty if they overlap."""
    if abs(at - other_at) <= within + other_within:
        return ""
    return f"{name} cannot be {at:g} +- {within:g} and {other_at:g} +- {other_within:g}"


def written(name: str, **values: object) -> str:
    """Return a requirement as it is typed; values that are None are left out."""
    arguments = ", ".join(f"{k}={v:g}" for k, v in values.items() if isinstance(v, (int, float)))
    return f"{name}({arguments})"
