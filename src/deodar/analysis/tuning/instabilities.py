"""Requirements on the instabilities of a field: detection, reverse detection, forgetting, memory, rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deodar.analysis.tuning.requirement import (
    ExactQuantity,
    Requirement,
    accepted,
    accepted_strength,
    apart,
    written,
)
from deodar.analysis.tuning.response import FieldInput, FieldResponse


@dataclass(frozen=True, repr=False)
class DetectionRequirement(Requirement):
    """See `detects`."""

    at: float
    within: float

    def margin(self, response: FieldResponse) -> np.ndarray:
        low = response.after(FieldInput(middle=self.at - self.within))
        high = response.after(FieldInput(middle=self.at + self.within))
        return np.minimum(response.silent(low), response.active(high))

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("detection", self.at, self.within, strength)

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, DetectionRequirement):
            return apart("the detection threshold", self.at, self.within, other.at, other.within)
        if isinstance(other, ReverseRequirement) and other.at - other.within > self.at + self.within:
            return "a peak vanishes at a weaker input than that which makes it, or at the same"
        return ""

    def __repr__(self) -> str:
        return written("detects", at=self.at, within=self.within)


@dataclass(frozen=True, repr=False)
class ReverseRequirement(Requirement):
    """See `reverse`."""

    at: float
    within: float
    strength: float | None = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        on = FieldInput(middle=response.strength if self.strength is None else self.strength)
        held = FieldInput(middle=self.at + self.within)
        memory = response.after(on, held)
        lost = response.after(on, held, FieldInput(middle=self.at - self.within))
        margin = np.minimum(response.kept(memory), response.silent(lost))
        return np.minimum(margin, response.active(response.after(on)))

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("reverse detection", self.at, self.within, self.strength or strength)

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, ReverseRequirement):
            return apart("the reverse threshold", self.at, self.within, other.at, other.within)
        if isinstance(other, MemoryRequirement) and self.at - self.within >= 0:
            return "a peak that vanishes at an input above 0 does not outlive its input"
        return ""

    def __repr__(self) -> str:
        return written("reverse", at=self.at, within=self.within, strength=self.strength)


@dataclass(frozen=True, repr=False)
class MemoryRequirement(Requirement):
    """See `remembers`."""

    strength: float | None = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        on = FieldInput(middle=response.strength if self.strength is None else self.strength)
        margin = np.minimum(response.active(response.after(on)), response.kept(response.after(on, _NONE)))
        return np.minimum(margin, response.silent(response.after()))

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, ForgettingRequirement) and (other.at is None or other.at > other.within):
            return "a peak cannot outlive its input and vanish with it"
        if isinstance(other, RelaxationRequirement):
            return "a peak that outlives its input does not vanish after it"
        return ""

    def __repr__(self) -> str:
        return written("remembers", strength=self.strength)


@dataclass(frozen=True, repr=False)
class ForgettingRequirement(Requirement):
    """See `forgets`."""

    at: float | None = None
    within: float = 0.0
    strength: float | None = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        strength = response.strength if self.strength is None else self.strength
        if self.at is None:
            on = FieldInput(middle=strength)
            margin = response.silent(response.after(on, _NONE))
            return np.minimum(margin, response.active(response.after(on)))
        high, low = self.at + self.within, self.at - self.within
        on, held_input = FieldInput(middle=strength, boost=high), FieldInput(boost=high)
        memory, lost = response.after(on, held_input), response.after(on, held_input, FieldInput(boost=low))
        margin = np.minimum(response.kept(memory), response.silent(lost))
        return np.minimum(margin, response.silent(response.after(held_input)))

    def exact(self, strength: float) -> ExactQuantity | None:
        if self.at is None:
            return None
        return ExactQuantity("forgetting", self.at, self.within, self.strength or strength)

    def contradicts(self, other: Requirement) -> str:
        if not isinstance(other, ForgettingRequirement):
            return ""
        if self.at is None or other.at is None:
            with_value = other.at if self.at is None else self.at
            within = max(self.within, other.within)
            low = with_value is not None and with_value < -within
            return "a peak that vanishes with its input has no boost below 0 that it outlives" if low else ""
        return apart("the forgetting threshold", self.at, self.within, other.at, other.within)

    def __repr__(self) -> str:
        within = self.within if self.at is not None else None
        return written("forgets", at=self.at, within=within, strength=self.strength)


@dataclass(frozen=True, repr=False)
class RestRequirement(Requirement):
    """See `rests`."""

    def margin(self, response: FieldResponse) -> np.ndarray:
        return response.silent(response.after())

    def __repr__(self) -> str:
        return "rests()"


@dataclass(frozen=True, repr=False)
class RelaxationRequirement(Requirement):
    """See `relaxes_within`."""

    time: float
    strength: float | None = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        on = FieldInput(middle=response.strength if self.strength is None else self.strength)
        stage = response.after(on, _NONE)
        margin = np.minimum(1 - self.value(response) / self.time, response.silent(stage))
        return np.minimum(response.guarded(stage, margin), response.active(response.after(on)))

    def value(self, response: FieldResponse) -> np.ndarray:
        on = FieldInput(middle=response.strength if self.strength is None else self.strength)
        return response.tau * response.after(on, _NONE).active

    def __repr__(self) -> str:
        return written("relaxes_within", time=self.time, strength=self.strength)


_NONE = FieldInput()


def detects(at: float, within: float) -> DetectionRequirement:
    """Require a detection threshold: localised input of `at - within` makes no peak, of `at + within` one.

    Args:
        at: the threshold, an amplitude of the localised input.
        within: its tolerance; > 0.

    Raises:
        ParameterError: a value is not finite, or the tolerance not above 0.
    """
    return DetectionRequirement(accepted("at", at), accepted("within", within, positive=True))


def reverse(at: float, within: float, strength: float | None = None) -> ReverseRequirement:
    """Require a reverse detection threshold: the peak stays at `at + within`, and vanishes at `at - within`.

    Args:
        at: the threshold, an amplitude of the localised input.
        within: its tolerance; > 0.
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.

    Raises:
        ParameterError: a value is not finite, or the tolerance not above 0.
    """
    within = accepted("within", within, positive=True)
    return ReverseRequirement(accepted("at", at), within, accepted_strength(strength))


def remembers(strength: float | None = None) -> MemoryRequirement:
    """Require a working memory: a peak outlives its input, stays bounded, and is not there without it.

    Args:
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.
    """
    return MemoryRequirement(accepted_strength(strength))


def forgets(
    at: float | None = None, within: float | None = None, strength: float | None = None
) -> ForgettingRequirement:
    """Require that a peak vanishes with its input, or a forgetting threshold.

    With `at` a peak outlives its input at a homogeneous input of `at + within`, and vanishes at `at -
    within`. The threshold of a working memory is below 0.

    Args:
        at: the forgetting threshold, a homogeneous input; None: a peak vanishes with its input.
        within: its tolerance; > 0.
        strength: amplitude of the localised input that makes the peak; None: that of `dd.tune`.

    Raises:
        ParameterError: a value is not finite, the tolerance not above 0, or one of both is missing.
    """
    if at is None:
        if within is not None:
            accepted("at", at)  # type: ignore[arg-type]
        return ForgettingRequirement(strength=accepted_strength(strength))
    tolerance = accepted("within", within, positive=True)  # type: ignore[arg-type]
    return ForgettingRequirement(accepted("at", at), tolerance, accepted_strength(strength))


def rests() -> RestRequirement:
    """Require that the field has no peak without input."""
    return RestRequirement()


def relaxes_within(time: float, strength: float | None = None) -> RelaxationRequirement:
    """Require that activation is below the threshold at a time after the input of a peak is removed.

    Args:
        time: the longest time, in document time; > 0.
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.

    Raises:
        ParameterError: the time is not above 0.
    """
    return RelaxationRequirement(accepted("time", time, positive=True), accepted_strength(strength))
