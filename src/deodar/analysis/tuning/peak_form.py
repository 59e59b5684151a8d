"""Requirements on the form of peaks, and on what two inputs lead to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from deodar.analysis.tuning.requirement import (
    ExactQuantity,
    Requirement,
    accepted,
    accepted_strength,
    apart,
    banded,
    written,
)
from deodar.analysis.tuning.response import FieldInput, FieldResponse, SettledBatch


@dataclass(frozen=True, repr=False)
class SelectionRequirement(Requirement):
    """See `selects`."""

    strength: float | None = None
    needs_axis: ClassVar[bool] = True

    def margin(self, response: FieldResponse) -> np.ndarray:
        strength = response.strength if self.strength is None else self.strength
        return response.one_of_two(response.competing(strength))

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, MultiPeakRequirement) and self.strength == other.strength:
            return "two equal inputs cannot end in one peak and in two"
        return ""

    def __repr__(self) -> str:
        return written("selects", strength=self.strength)


@dataclass(frozen=True, repr=False)
class MultiPeakRequirement(Requirement):
    """See `multi_peak`."""

    strength: float | None = None
    needs_axis: ClassVar[bool] = True

    def margin(self, response: FieldResponse) -> np.ndarray:
        strength = response.strength if self.strength is None else self.strength
        return response.both_of_two(response.competing(strength))

    def __repr__(self) -> str:
        return written("multi_peak", strength=self.strength)


@dataclass(frozen=True, repr=False)
class WidthRequirement(Requirement):
    """See `peak_width`."""

    width: float
    within: float
    strength: float | None = None
    needs_axis: ClassVar[bool] = True

    def margin(self, response: FieldResponse) -> np.ndarray:
        return response.guarded(self._stage(response), banded(self.value(response), self.width, self.within))

    def value(self, response: FieldResponse) -> np.ndarray:
        return self._stage(response).width

    def _stage(self, response: FieldResponse) -> SettledBatch:
        strength = response.strength if self.strength is None else self.strength
        return response.after(FieldInput(middle=strength))

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("width", self.width, self.within, self.strength or strength)

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, WidthRequirement) and self.strength == other.strength:
            return apart("the width", self.width, self.within, other.width, other.within)
        return ""

    def __repr__(self) -> str:
        return written("peak_width", width=self.width, within=self.within, strength=self.strength)


@dataclass(frozen=True, repr=False)
class AmplitudeRequirement(Requirement):
    """See `peak_amplitude`."""

    amplitude: float
    within: float
    strength: float | None = None

    def margin(self, response: FieldResponse) -> np.ndarray:
        stage = self._stage(response)
        margin = np.minimum(banded(self.value(response), self.amplitude, self.within), response.active(stage))
        return response.guarded(stage, margin)

    def value(self, response: FieldResponse) -> np.ndarray:
        return self._stage(response).above.max(-1) + response.threshold

    def _stage(self, response: FieldResponse) -> SettledBatch:
        strength = response.strength if self.strength is None else self.strength
        return response.after(FieldInput(middle=strength))

    def exact(self, strength: float) -> ExactQuantity:
        return ExactQuantity("amplitude", self.amplitude, self.within, self.strength or strength)

    def contradicts(self, other: Requirement) -> str:
        if isinstance(other, AmplitudeRequirement) and self.strength == other.strength:
            return apart("the amplitude", self.amplitude, self.within, other.amplitude, other.within)
        return ""

    def __repr__(self) -> str:
        return written("peak_amplitude", amplitude=self.amplitude, within=self.within, strength=self.strength)


def selects(strength: float | None = None) -> SelectionRequirement:
    """Require that two equal inputs end in one peak.

    One of both is a hundredth stronger until the field settles, as in `dd.selection`, which measures this.

    Args:
        strength: amplitude of each input; None: that of `dd.tune`.
    """
    return SelectionRequirement(accepted_strength(strength))


def multi_peak(strength: float | None = None) -> MultiPeakRequirement:
    """Require that two equal inputs each have a peak.

    Args:
        strength: amplitude of each input; None: that of `dd.tune`.
    """
    return MultiPeakRequirement(accepted_strength(strength))


def peak_width(width: float, within: float, strength: float | None = None) -> WidthRequirement:
    """Require a width of the peak while its input is on, between the interpolated crossings of the threshold.

    Args:
        width: the width, in units of the axis; > 0.
        within: its tolerance; > 0.
        strength: amplitude of the input; None: that of `dd.tune`.

    Raises:
        ParameterError: a value is not above 0.
    """
    width = accepted("width", width, positive=True)
    within = accepted("within", within, positive=True)
    return WidthRequirement(width, within, accepted_strength(strength))


def peak_amplitude(amplitude: float, within: float, strength: float | None = None) -> AmplitudeRequirement:
    """Require a highest activation of the peak while its input is on.

    Args:
        amplitude: the activation.
        within: its tolerance; > 0.
        strength: amplitude of the input; None: that of `dd.tune`.

    Raises:
        ParameterError: a value is not finite, or the tolerance not above 0.
    """
    within = accepted("within", within, positive=True)
    return AmplitudeRequirement(accepted("amplitude", amplitude), within, accepted_strength(strength))
