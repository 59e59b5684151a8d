"""What a motor allows: limits, the largest rate of change, and its command at rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta

from deodar.codec import JsonObject
from deodar.errors import WorldError
from deodar.parameters import show

STOPS_AFTER = 200.0
"""Time without a command after which a motor goes to rest, ms (a guess: two periods of a slow robot)."""


@dataclass(frozen=True)
class MotorRule:
    """The commands that a motor allows; both the sender and the owner of the motor apply them.

    Attributes:
        limits: smallest and largest value of each sample, in the unit of the motor; None: any value.
        slew: largest change of each sample, in the unit of the motor per second; None: any change.
        rest: value of each sample at rest, in the unit of the motor. A stop is immediate, whatever the slew.
        stops_after: time without a command after which the owner puts the motor to rest, ms.
    """

    limits: tuple[float, float] | None = None
    slew: Annotated[float, Meta(gt=0)] | None = None
    rest: float = 0.0
    stops_after: Annotated[float, Meta(gt=0)] = STOPS_AFTER

    def __post_init__(self) -> None:
        low, high = self.limits or (-math.inf, math.inf)
        if self.limits is not None and not -math.inf < low < high < math.inf:
            raise WorldError(f"limits is {show(self.limits)}; expected two finite numbers, the lower first")
        for name, value in (
            ("slew", self.slew or 0.0),
            ("rest", self.rest),
            ("stops_after", self.stops_after),
        ):
            if not math.isfinite(value):
                raise WorldError(f"{name} is {show(value)}; expected a finite number")
        if not low <= self.rest <= high:
            raise WorldError(f"rest is {self.rest:g}; expected a value within the limits {low:g} to {high:g}")

    def allowed(self, command: np.ndarray, before: np.ndarray | None, period: float) -> np.ndarray:
        """Return the nearest command within the limits and the slew rate.

        Args:
            command: the wanted command; finite.
            before: the command of the last period; None: the motor was at rest.
            period: time since then, ms.
        """
        if self.slew is not None:
            # a restored command is of float64; the change is computed in the type of the command
            last = self.at_rest(command) if before is None else before.astype(command.dtype, copy=False)
            most = self.slew * period / 1000
            command = np.clip(command, last - most, last + most).astype(command.dtype)
        return command if self.limits is None else np.clip(command, *self.limits)

    def within(
        self, limits: tuple[float, float] | None = None, slew: float | None = None, where: str = ""
    ) -> MotorRule:
        """Return a rule that allows what this one allows, and no more than other limits and another slew.

        Raises:
            WorldError: no command is left, or not the one at rest.
        """
        if slew is not None and not slew > 0:
            raise WorldError(f"the change a second is {slew:g}; expected a number above 0", where)
        (low, high), (least, most) = (pair or (-math.inf, math.inf) for pair in (self.limits, limits))
        if not max(low, least) < min(high, most):
            raise WorldError(
                f"no value lies within both {low:g} to {high:g} and {least:g} to {most:g}", where
            )
        narrower = None if self.limits is limits is None else [max(low, least), min(high, most)]
        slowest = min((s for s in (self.slew, slew) if s is not None), default=None)
        return MotorRule.from_data({**self.to_data(), "limits": narrower, "slew": slowest}, where)

    def at_rest(self, command: np.ndarray) -> np.ndarray:
        """Return the command at rest, with the shape and type of another command."""
        return np.full_like(command, self.rest)

    def to_data(self) -> JsonObject:
        """Return the rule as plain data, without what allows everything."""
        data: JsonObject = {"rest": self.rest, "stops_after": self.stops_after}
        if self.limits is not None:
            data["limits"] = list(self.limits)
        if self.slew is not None:
            data["slew"] = self.slew
        return data

    @classmethod
    def from_data(cls, data: Mapping[str, Any], where: str) -> MotorRule:
        """Read a rule from plain data; other keys are ignored.

        Raises:
            WorldError: a value is not what the rule needs.
        """
        try:
            return msgspec.convert({k: v for k, v in data.items() if v is not None}, cls)
        except msgspec.ValidationError as error:
            raise WorldError(str(error), where) from None
        except WorldError as error:
            raise WorldError(error.problems[0].what, where) from None
