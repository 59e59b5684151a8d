"""Boost-driven detection: a homogeneous input that turns a pattern below threshold into a peak."""

from __future__ import annotations

from dataclasses import dataclass

from deodar.analysis.isolated import Isolated
from deodar.analysis.peaks import Peaks
from deodar.analysis.settle import LIMIT
from deodar.analysis.thresholds import ascend
from deodar.summary import Summarised, Summary

SHARES = (0.25, 0.5, 0.75)
"""Strengths of the pre-shapes that are measured, relative to the detection threshold."""


@dataclass(frozen=True, repr=False)
class Boosted(Summarised):
    """A pre-shape, and the boost at which it becomes a peak.

    Attributes:
        preshape: strength of the localised input, which alone creates no peak.
        boost: homogeneous input at which a peak appears; None if none appears.
        peaks: the peaks of the field at this boost.
        localised: whether the field then has one peak at the pre-shape, and is not active everywhere.
    """

    preshape: float
    boost: float | None
    peaks: Peaks | None
    localised: bool

    def _summary(self) -> Summary:
        strength = "none up to the limit" if self.boost is None else f"{self.boost:.4g}"
        where = "at the pre-shape" if self.localised else "not at the pre-shape alone"
        return Summary(f"Detection by a boost of {strength}", [("pre-shape", self.preshape), ("peak", where)])


def boosted(isolated: Isolated, preshape: float, accuracy: float = 0.01, limit: float = LIMIT) -> Boosted:
    """Measure the boost at which a pre-shape becomes a peak; a stronger pre-shape needs a weaker boost.

    The field first settles with the localised input. The boost then grows until a peak appears.

    Args:
        isolated: the field.
        preshape: strength of the localised input, below the detection threshold.
        accuracy: width of the final bracket relative to the value.
        limit: longest settling, in time constants.

    Reference:
        Erlhagen & Schöner (2002), Dynamic field theory of movement preparation, Psychol. Rev. 109
        (pre-shape); Schöner, Spencer & the DFT Research Group (2016), Dynamic Thinking, chapter 2
        (boost-driven detection).
    """
    isolated.reset(input=preshape)
    isolated.settle(limit=limit)
    transition = ascend(isolated, "boost", accuracy, limit)
    if transition is None:
        return Boosted(preshape, None, None, False)
    isolated.restore(transition.state)
    peaks = isolated.peaks()
    return Boosted(
        preshape,
        transition.value,
        peaks,
        len(peaks) == 1 and not isolated.covers(peaks) and _at_input(isolated, peaks),
    )


def _at_input(isolated: Isolated, peaks: Peaks) -> bool:
    """Return whether the peak is at the position of the input, to within its width."""
    return all(
        abs(p - c) <= 2 * s
        for p, c, s in zip(peaks[0].position, isolated.center, isolated.sigma, strict=True)
    )
