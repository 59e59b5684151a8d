"""Working memory: whether a peak outlives its input, and what makes it forget."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deodar.analysis.isolated import Isolated
from deodar.analysis.peaks import Peaks
from deodar.analysis.settle import LIMIT
from deodar.analysis.thresholds import Transition, descend
from deodar.errors import AnalysisError

BOOSTS = 16
LEAST = 64
"""Strongest localised inhibition that is tried, relative to the distance between resting level and threshold.
"""


@dataclass(frozen=True)
class Memory:
    """What is left of a peak after its input is gone.

    Attributes:
        outlives: whether a peak is left.
        driven: the peaks while the input was on.
        left: the peaks after it was taken away.
        activation: the pattern that is left.
        settled: whether it stood still before the limit.
    """

    outlives: bool
    driven: Peaks
    left: Peaks
    activation: np.ndarray
    settled: bool


def outlives(isolated: Isolated, amplitude: float, boost: float = 0.0, limit: float = LIMIT) -> Memory:
    """Whether a peak outlives its input: input of this amplitude until the field settles, then none until it
    settles again.

    Args:
        isolated: the field.
        amplitude: of the localised input, above the detection threshold.
        boost: homogeneous input that stays on throughout.
        limit: of settling, in time constants.

    Raises:
        AnalysisError: if the input makes no peak.
    """
    isolated.reset(input=amplitude, boost=boost)
    isolated.settle(limit=limit)
    driven = isolated.peaks()
    if not driven:
        raise AnalysisError(
            f"an input of {amplitude:g} makes no peak",
            where=isolated.path,
            fix="Take one above the detection threshold",
        )
    isolated.put(input=0.0)
    settled = isolated.settle(limit=limit)
    left = isolated.peaks()
    return Memory(bool(left), driven, left, isolated.activation(), bool(settled))


def suppression(
    isolated: Isolated, amplitude: float, accuracy: float = 0.01, limit: float = LIMIT
) -> Transition | None:
    """The localised input, below 0, at which a peak that outlives its own input vanishes; None where no peak
    does, or where it only moves aside.

    Args:
        isolated: the field.
        amplitude: of the localised input that makes the peak, above the detection threshold.
        accuracy: width of the final bracket relative to the value.
        limit: of settling, in time constants.
    """
    kept = outlives(isolated, amplitude, limit=limit)
    if not kept.outlives or isolated.covers(kept.left):
        return None
    return descend(isolated, "input", 0.0, -LEAST * isolated.scale, accuracy, limit)


def forgetting(
    isolated: Isolated, amplitude: float, accuracy: float = 0.01, limit: float = LIMIT
) -> Transition | None:
    """The homogeneous input below which no peak outlives its input; None where none does below the resting
    threshold.

    Negative for a working memory (how much inhibition erases it), positive for a field that a boost would
    turn into one. The value is found by making a peak, taking its input away and lowering the boost until the
    peak vanishes.

    Args:
        isolated: the field.
        amplitude: of the localised input that makes the peak, above the detection threshold.
        accuracy: width of the final bracket relative to the value.
        limit: of settling, in time constants.
    """
    highest = (
        isolated.threshold - isolated.field.resting_level
    )  # from here on a field without interaction is active all over
    for boost in np.linspace(0.0, max(highest, 0.0), BOOSTS, endpoint=False):
        isolated.reset(boost=boost)
        isolated.settle(limit=limit)
        if isolated.peaks():
            return None  # active without input: nothing that could be told from a memory
        kept = outlives(isolated, amplitude, float(boost), limit)
        if kept.outlives and not isolated.covers(kept.left):
            return descend(
                isolated, "boost", float(boost), float(boost) - 1024 * isolated.scale, accuracy, limit
            )
    return None
