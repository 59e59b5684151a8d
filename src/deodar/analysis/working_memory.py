"""Working memory: whether a peak outlives its input, and which inhibition deletes it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deodar.analysis.isolated import Isolated
from deodar.analysis.peaks import Peaks
from deodar.analysis.settle import LIMIT
from deodar.analysis.thresholds import Transition, descend
from deodar.errors import AnalysisError
from deodar.summary import Summarised, Summary, counted

BOOSTS = 16
LEAST = 64
"""Strongest localised inhibition tried, relative to the distance between resting level and threshold."""

BESIDE = 0.1
"""Distance of the localised inhibition from the peak, relative to its width."""


@dataclass(frozen=True, repr=False)
class Memory(Summarised):
    """The state of a field after the input of a peak is removed.

    Attributes:
        outlives: whether a peak remains.
        driven: the peaks while the input was on.
        left: the peaks after the input was removed.
        activation: the remaining activation pattern.
        settled: whether the field settled within the limit.
    """

    outlives: bool
    driven: Peaks
    left: Peaks
    activation: np.ndarray
    settled: bool

    def _summary(self) -> Summary:
        rows = [
            ("with the input", counted(len(self.driven), "peak")),
            ("after the input", counted(len(self.left), "peak")),
        ]
        return Summary("A peak outlives its input" if self.outlives else "No peak outlives its input", rows)


def outlives(isolated: Isolated, amplitude: float, boost: float = 0.0, limit: float = LIMIT) -> Memory:
    """Measure whether a peak outlives its input.

    The input is on until the field settles, then off until it settles again.

    Args:
        isolated: the field.
        amplitude: amplitude of the localised input, above the detection threshold.
        boost: homogeneous input that is always on.
        limit: longest settling, in time constants.

    Raises:
        AnalysisError: if the input creates no peak.
    """
    isolated.reset(input=amplitude, boost=boost)
    isolated.settle(limit=limit)
    driven = isolated.peaks()
    if not driven:
        raise AnalysisError(
            f"an input of {amplitude:g} makes no peak",
            where=isolated.path,
            fix="Use one above the detection threshold",
        )
    isolated.put(input=0.0)
    settled = isolated.settle(limit=limit)
    peaks_left = isolated.peaks()
    return Memory(bool(peaks_left), driven, peaks_left, isolated.activation(), bool(settled))


def suppression(
    isolated: Isolated, amplitude: float, accuracy: float = 0.01, limit: float = LIMIT
) -> Transition | None:
    """Return the localised input, below 0, below which a peak that outlives its own input vanishes.

    It is switched on at once, at `BESIDE` of its width from the peak along the first axis; weaker inputs move
    the peak aside. A slowly growing input always moves it aside, unless it is exactly over the peak. Exactly
    there no side is preferred, so that rounding errors would determine the value. None if no peak outlives
    its input, or if every input moves it aside.

    Args:
        isolated: the field.
        amplitude: amplitude of the localised input that creates the peak, above the detection threshold.
        accuracy: width of the final bracket relative to the value.
        limit: longest settling, in time constants.
    """
    memory = outlives(isolated, amplitude, limit=limit)
    if not memory.outlives or isolated.covers(memory.left):
        return None
    peak = min(memory.left, key=lambda found_peak: math.dist(found_peak.position, isolated.center))
    center = (peak.position[0] + BESIDE * isolated.sigma[0], *peak.position[1:])
    isolated.session.set("input.center", center)
    try:
        return descend(isolated, "input", 0.0, -LEAST * isolated.scale, accuracy, limit, sudden=True)
    finally:
        isolated.session.set("input.center", isolated.center)


def forgetting(
    isolated: Isolated, amplitude: float, accuracy: float = 0.01, limit: float = LIMIT
) -> Transition | None:
    """Return the homogeneous input below which no peak outlives its input.

    The value is negative for a working memory (the inhibition that deletes it) and positive for a field that
    needs a boost to become one. It is found by creating a peak, removing its input and lowering the boost
    until the peak vanishes. None if no peak outlives its input at any boost below the distance between
    resting level and threshold.

    Args:
        isolated: the field.
        amplitude: amplitude of the localised input that creates the peak, above the detection threshold.
        accuracy: width of the final bracket relative to the value.
        limit: longest settling, in time constants.
    """
    # with this boost a field without interaction is active everywhere
    highest = isolated.threshold - isolated.field.resting_level
    for boost in np.linspace(0.0, max(highest, 0.0), BOOSTS, endpoint=False):
        isolated.reset(boost=boost)
        isolated.settle(limit=limit)
        if isolated.peaks():
            return None  # active without input: not distinguishable from a memory
        memory = outlives(isolated, amplitude, float(boost), limit)
        if memory.outlives and not isolated.covers(memory.left):
            return descend(
                isolated, "boost", float(boost), float(boost) - 1024 * isolated.scale, accuracy, limit
            )
    return None
