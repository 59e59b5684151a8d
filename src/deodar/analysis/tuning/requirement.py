"""What a tuned field is to do: the requirements of deodar, and the base class of those that users write."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np

from deodar.analysis.tuning.response import FieldInput, FieldResponse, SettledBatch
from deodar.family import Family
from deodar.parameters import Part, Recompile, parameters

QuantityKind = Literal["detection", "reverse detection", "forgetting", "width", "amplitude"]
Tolerance = Annotated[float, Recompile(lower=1e-9)]
Strength = Annotated[float | None, Recompile(lower=1e-9)]

NONE = FieldInput()
"""A stage without input."""


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

    @property
    def of_peak(self) -> bool:
        """Whether it belongs to the peak, which depends on the input that makes it, and is no fold."""
        return self.kind in ("width", "amplitude")

    def apart(self, other: ExactQuantity) -> bool:
        """Return whether it is the same quantity, and the tolerated ranges have nothing in common."""
        same = self.kind == other.kind and (not self.of_peak or self.strength == other.strength)
        return same and abs(self.target - other.target) > self.within + other.within

    def __str__(self) -> str:
        return f"{self.target:g} +- {self.within:g}"


class Requirement(Part):
    """What a field is to do with its input; derive a class for one of your own.

    A subclass is a frozen dataclass that defines `margin`, and perhaps `value` and `contradicts`. The field
    is measured alone, without noise, for many candidates at once:

        @dataclass(frozen=True)
        class Quiet(dd.Requirement):
            boost: float

            def margin(self, response):
                return response.silent(response.after(dd.FieldInput(boost=self.boost)))
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
        first, second = self.exact(0.0), other.exact(0.0)
        if first is None or second is None or not first.apart(second):
            return ""
        return f"the {first.kind} cannot be {first} and {second}"

    def __repr__(self) -> str:
        given = ((p.name, getattr(self, p.name)) for p in parameters(type(self)))
        arguments = ", ".join(f"{name}={value:g}" for name, value in given if value is not None)
        return f"{type(self).__name__}({arguments})"


REQUIREMENTS = Family(Requirement)
"""The requirements of deodar; each is registered where it is declared, by the name that files have."""


# ---------------------------------------------------------------------------------------------- instabilities


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class detects(Requirement):
    """Require a detection threshold: localised input of `at - within` makes no peak, of `at + within` one.

    Attributes:
        at: the threshold, an amplitude of the localised input.
        within: its tolerance.
    """

    at: float
    within: Tolerance

    def margin(self, response: FieldResponse) -> np.ndarray:
        low = response.after(FieldInput(middle=self.at - self.within))
        high = response.after(FieldInput(middle=self.at + self.within))
        return np.minimum(response.silent(low), response.active(high))

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("detection", self.at, self.within, strength)

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, reverse) and other.at - other.within > self.at + self.within:
            return "a peak vanishes at a weaker input than that which makes it, or at the same"
        return super().contradicts(other)


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class reverse(Requirement):
    """Require a reverse detection threshold: the peak stays at `at + within`, and vanishes at `at - within`.

    Attributes:
        at: the threshold, an amplitude of the localised input.
        within: its tolerance.
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.
    """

    at: float
    within: Tolerance
    strength: Strength = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        on = response.localised(self.strength)
        held = FieldInput(middle=self.at + self.within)
        memory = response.after(on, held)
        lost = response.after(on, held, FieldInput(middle=self.at - self.within))
        margin = np.minimum(response.kept(memory), response.silent(lost))
        return np.minimum(margin, response.active(response.after(on)))

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("reverse detection", self.at, self.within, self.strength or strength)

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, remembers) and self.at - self.within >= 0:
            return "a peak that vanishes at an input above 0 does not outlive its input"
        return super().contradicts(other)


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class remembers(Requirement):
    """Require a working memory: a peak outlives its input, stays bounded, and is not there without it.

    Attributes:
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.
    """

    strength: Strength = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        on = response.localised(self.strength)
        margin = np.minimum(response.active(response.after(on)), response.kept(response.after(on, NONE)))
        return np.minimum(margin, response.silent(response.after()))

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, forgets) and (other.within is None or (other.at or 0.0) > other.within):
            return "a peak cannot outlive its input and vanish with it"
        if isinstance(other, relaxes_within):
            return "a peak that outlives its input does not vanish after it"
        return ""


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class forgets(Requirement):
    """Require that a peak vanishes with its input, or a forgetting threshold.

    With `at` a peak outlives its input at a homogeneous input of `at + within`, and vanishes at `at -
    within`. The threshold of a working memory is below 0.

    Attributes:
        at: the forgetting threshold, a homogeneous input; None: a peak vanishes with its input.
        within: the tolerance of `at`.
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.
    """

    at: float | None = None
    within: Annotated[float | None, Recompile(lower=1e-9)] = None
    strength: Strength = None

    def validate(self) -> Iterator[tuple[str, str]]:
        if (self.at is None) != (self.within is None):
            yield ("at", "is None, and within is given") if self.at is None else ("within", "is None")

    def margin(self, response: FieldResponse) -> np.ndarray:
        on = response.localised(self.strength)
        if self.at is None or self.within is None:
            margin = response.silent(response.after(on, NONE))
            return np.minimum(margin, response.active(response.after(on)))
        high, low = self.at + self.within, self.at - self.within
        on, held_input = FieldInput(middle=on.middle, boost=high), FieldInput(boost=high)
        memory, lost = response.after(on, held_input), response.after(on, held_input, FieldInput(boost=low))
        margin = np.minimum(response.kept(memory), response.silent(lost))
        return np.minimum(margin, response.silent(response.after(held_input)))

    def exact(self, strength: float) -> ExactQuantity | None:
        if self.at is None or self.within is None:
            return None
        return ExactQuantity("forgetting", self.at, self.within, self.strength or strength)

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, forgets) and (self.at is None) != (other.at is None):
            threshold = self.exact(0.0) or other.exact(0.0)
            if threshold is not None and threshold.target < -threshold.within:
                return "a peak that vanishes with its input has no boost below 0 that it outlives"
        return super().contradicts(other)


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class rests(Requirement):
    """Require that the field has no peak without input."""

    def margin(self, response: FieldResponse) -> np.ndarray:
        return response.silent(response.after())


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class relaxes_within(Requirement):
    """Require that activation is below the threshold at a time after the input of a peak is removed.

    Attributes:
        time: the longest time.
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.
    """

    time: Annotated[float, Recompile("time", lower=1e-9, role="duration")]
    strength: Strength = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        on = response.localised(self.strength)
        stage = response.after(on, NONE)
        margin = np.minimum(1 - self.value(response) / self.time, response.silent(stage))
        return np.minimum(response.guarded(stage, margin), response.active(response.after(on)))

    def value(self, response: FieldResponse) -> np.ndarray:
        return response.tau * response.after(response.localised(self.strength), NONE).active


# ------------------------------------------------------------------------------ two inputs, the form of peaks


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class selects(Requirement):
    """Require that two equal inputs end in one peak.

    One of both is a hundredth stronger until the field settles, as in `dd.selection`, which measures this.

    Attributes:
        strength: amplitude of each input; None: that of `dd.tune`.
    """

    strength: Strength = None
    needs_axis: ClassVar[bool] = True

    def margin(self, response: FieldResponse) -> np.ndarray:
        return response.one_of_two(response.competing(response.localised(self.strength).middle))

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, multi_peak) and self.strength == other.strength:
            return "two equal inputs cannot end in one peak and in two"
        return ""


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class multi_peak(Requirement):
    """Require that two equal inputs each have a peak.

    Attributes:
        strength: amplitude of each input; None: that of `dd.tune`.
    """

    strength: Strength = None
    needs_axis: ClassVar[bool] = True

    def margin(self, response: FieldResponse) -> np.ndarray:
        return response.both_of_two(response.competing(response.localised(self.strength).middle))


class PeakRequirement(Requirement):
    """A requirement on the peak while its input is on."""

    within: Tolerance
    strength: Strength

    def settled(self, response: FieldResponse) -> SettledBatch:
        """Return what the field has settled to with the input."""
        return response.after(response.localised(self.strength))

    def tolerated(self, response: FieldResponse, value: np.ndarray, target: float) -> np.ndarray:
        """Return the margin of a value: 1 at the target, 0 at the ends of the tolerated range."""
        return response.guarded(self.settled(response), 1 - np.abs(value - target) / self.within)


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class peak_width(PeakRequirement):
    """Require a width of the peak while its input is on, between the interpolated crossings of the threshold.

    Attributes:
        width: the width.
        within: its tolerance.
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.
    """

    width: Annotated[float, Recompile("axis", lower=1e-9)]
    within: Tolerance
    strength: Strength = None
    needs_axis: ClassVar[bool] = True

    def margin(self, response: FieldResponse) -> np.ndarray:
        return self.tolerated(response, self.value(response), self.width)

    def value(self, response: FieldResponse) -> np.ndarray:
        return self.settled(response).width

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("width", self.width, self.within, self.strength or strength)


@REQUIREMENTS.register
@dataclass(frozen=True, repr=False)
class peak_amplitude(PeakRequirement):
    """Require a highest activation of the peak while its input is on.

    Attributes:
        amplitude: the activation.
        within: its tolerance.
        strength: amplitude of the input that makes the peak; None: that of `dd.tune`.
    """

    amplitude: Annotated[float, Recompile("activation")]
    within: Tolerance
    strength: Strength = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        banded = self.tolerated(response, self.value(response), self.amplitude)
        return np.minimum(banded, response.active(self.settled(response)))

    def value(self, response: FieldResponse) -> np.ndarray:
        return self.settled(response).above.max(-1) + response.threshold

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("amplitude", self.amplitude, self.within, self.strength or strength)
