"""Detection and reverse detection thresholds of a field, by bisection; also with a homogeneous boost."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deodar.analysis.isolated import InputKind, Isolated
from deodar.analysis.peaks import Peaks
from deodar.analysis.settle import LIMIT
from deodar.session.session_snapshot import SessionSnapshot
from deodar.summary import Summarised, Summary

MOST_DOUBLINGS = 8
JUMP = 20.0
"""Smallest ratio of a change of activation to the change of input that counts as a jump, not a graded
response.
"""
UNTOLD = 4.0
"""Distance beyond an instability, in settling tolerances, at which a field may still count as settled.

An input has its full effect only at its center, and less where the activation changes slowest (a guess; in
the cases with an exact solution the factor is 1 to 2).
"""
FINE = 0.01
"""Tolerance of settling relative to the requested accuracy."""
SINGLE = 2e-6
"""Smallest tolerance of settling in single precision, relative to the scale: smaller changes of activation
are rounding errors.
"""


@dataclass(frozen=True, repr=False)
class Transition(Summarised):
    """The input at which a peak appears or vanishes while the input changes slowly.

    Attributes:
        value: the input of the transition, the middle of the bracket.
        before: the last input at which the field settled on the old branch.
        after: the first input at which it did not.
        interval: lowest and highest possible input of the transition: the bracket, widened on both sides by
            the resolution of settling.
        jump: whether activation jumps there (an instability), or grows gradually through the threshold.
        state: the settled field just after the transition.
    """

    value: float
    before: float
    after: float
    interval: tuple[float, float]
    jump: bool
    state: SessionSnapshot

    def _summary(self) -> Summary:
        half, kind = abs(self.interval[1] - self.interval[0]) / 2, "a jump" if self.jump else "gradual"
        return Summary(f"Transition at {self.value:.4g} +- {half:.2g}, {kind}")


@dataclass(frozen=True, repr=False)
class Thresholds(Summarised):
    """Both thresholds of a field for one kind of input.

    Attributes:
        detection: transition at which a peak appears as the input grows; None if no peak appears up to
            `searched`, or if a peak exists without input.
        reverse: transition at which the peak vanishes as the input shrinks; None if it still exists at 0 (on
            a node: at -`searched`).
        active_at_rest: whether a peak exists without any input.
        searched: the largest input tried.
    """

    detection: Transition | None
    reverse: Transition | None
    active_at_rest: bool
    searched: float

    def _summary(self) -> Summary:
        rows = [
            (name, *(("none",) if t is None else (f"{t.value:.4g}", "a jump" if t.jump else "gradual")))
            for name, t in (("detection", self.detection), ("reverse", self.reverse))
        ]
        return Summary("Thresholds" + (", active without input" if self.active_at_rest else ""), rows)


def thresholds(
    isolated: Isolated, by: InputKind = "input", accuracy: float = 0.01, limit: float = LIMIT
) -> Thresholds:
    """Measure the detection and reverse detection thresholds of a field.

    The input grows from 0 until a peak appears, and shrinks from there until it vanishes. Every step of the
    bisection starts from the last settled state before the change, so that the field stays on its branch as
    long as the branch exists.

    Args:
        isolated: the field.
        by: `input` for localised input, `boost` for homogeneous input.
        accuracy: width of the final bracket relative to the threshold; > 0.
        limit: longest settling, in time constants.

    Reference:
        Schöner, Spencer & the DFT Research Group (2016), Dynamic Thinking, chapter 2 (detection and reverse
        detection).
    """
    isolated.reset()
    isolated.settle(limit=limit)
    if isolated.peaks():
        return Thresholds(None, None, True, 0.0)
    searched = isolated.scale * 2.0**MOST_DOUBLINGS
    up = ascend(isolated, by, accuracy, limit)
    if up is None:
        return Thresholds(None, None, False, searched)
    isolated.restore(up.state)
    floor = 0.0 if isolated.axes else -searched
    down = descend(isolated, by, up.after, floor, accuracy, limit)
    return Thresholds(up, down, False, searched)


def tolerance(isolated: Isolated, accuracy: float) -> float:
    """Return the change of activation per time constant that counts as settled, for a threshold with
    `accuracy`.

    Just beyond an instability the rate of change of activation is proportional to the distance of the input
    from it. The tolerance of settling limits the resolution of the threshold, so it must be far below the
    width of the bracket.
    """
    least = SINGLE if isolated.session.precision == "float32" else 0.0
    return max(min(2e-4, FINE * accuracy), least) * isolated.scale


def _stuck(isolated: Isolated, most: float) -> float:
    """Return the change of activation per time constant that rounding can hide: a step adds less than half a
    unit of the last digit.
    """
    return (
        0.5
        * float(np.finfo(isolated.session.precision).eps)
        * most
        * isolated.field.tau
        / isolated.session.dt
    )


def ascend(
    isolated: Isolated, by: InputKind, accuracy: float = 0.01, limit: float = LIMIT
) -> Transition | None:
    """Return the transition at which a peak appears as `by` grows from 0 on a settled field without a peak.

    None if no peak appears.
    """
    fine = tolerance(isolated, accuracy)
    low, high, snapshot = 0.0, isolated.scale, isolated.snapshot()
    searched = isolated.scale * 2.0**MOST_DOUBLINGS
    while True:
        isolated.restore(snapshot)
        isolated.put(**{by: high})
        isolated.settle(fine, limit)
        if isolated.peaks():
            bracket = Bracket(by, low, high, snapshot)
            return bisect(isolated, bracket, lambda: bool(isolated.peaks()), accuracy, limit)
        low, snapshot = high, isolated.snapshot()
        if high >= searched:
            return None
        high *= 2


def descend(
    isolated: Isolated,
    by: InputKind,
    start: float,
    floor: float,
    accuracy: float = 0.01,
    limit: float = LIMIT,
    sudden: bool = False,
) -> Transition | None:
    """Return the transition at which a settled peak vanishes as the input falls from `start`.

    None if the peak still exists at `floor`.

    Args:
        isolated: the field, settled at `start`.
        by: `input` for localised input, `boost` for homogeneous input.
        start: the input at which the peak exists.
        floor: the lowest input tried.
        accuracy: width of the final bracket relative to the threshold; > 0.
        limit: longest settling, in time constants.
        sudden: whether the input falls from `start` to each value at once, instead of slowly.
    """
    fine = tolerance(isolated, accuracy)
    lowest, state, reach = start, isolated.snapshot(), isolated.scale / 2
    while True:
        trial = max(floor, lowest - reach)
        isolated.restore(state)
        isolated.put(**{by: trial})
        isolated.settle(fine, limit)
        if not isolated.peaks():
            bracket = Bracket(by, lowest, trial, state, sudden)
            return bisect(isolated, bracket, lambda: not isolated.peaks(), accuracy, limit)
        if trial <= floor:
            return None
        lowest, state, reach = trial, state if sudden else isolated.snapshot(), reach * 2


@dataclass(frozen=True)
class Bracket:
    """Two inputs between which a transition of a field lies.

    Attributes:
        by: the input that is varied.
        before: the input at which the field has not changed.
        after: the input at which the field has changed; below `before` if the input falls.
        state: the field, settled at `before`; if the input changes suddenly, at the input from which it
            changes.
        sudden: whether the input changes to each value from that state, instead of slowly.
    """

    by: InputKind
    before: float
    after: float
    state: SessionSnapshot
    sudden: bool = False


def bisect(
    isolated: Isolated,
    bracket: Bracket,
    changed: Callable[[], bool],
    accuracy: float = 0.01,
    limit: float = LIMIT,
) -> Transition:
    """Find the input inside a bracket at which the field changes; `changed` is called after settling."""
    before, after, state = bracket.before, bracket.after, bracket.state
    fine = tolerance(isolated, accuracy)
    # for smaller values the accuracy is relative to the scale, as a threshold may be 0
    least = 0.01 * isolated.scale
    isolated.restore(state)
    last = isolated.activation()
    settled: tuple[SessionSnapshot, np.ndarray] | None = None
    while settled is None or abs(after - before) > accuracy / 2 * max(abs(before + after) / 2, least):
        trial = (before + after) / 2 if settled is not None else after
        isolated.restore(state)
        isolated.put(**{bracket.by: trial})
        isolated.settle(fine, limit)
        if changed() or settled is None:
            after, settled = trial, (isolated.snapshot(), isolated.activation())
        else:
            before, last = trial, isolated.activation()
            state = state if bracket.sudden else isolated.snapshot()
    moved = float(np.max(np.abs(settled[1] - last)))
    most = max(float(np.max(np.abs(last))), float(np.max(np.abs(settled[1]))))
    # the passage takes about pi / sqrt(distance) time constants
    untold = UNTOLD * (fine + _stuck(isolated, most)) + isolated.scale * (math.pi / limit) ** 2
    interval = (min(before, after) - untold, max(before, after) + untold)
    return Transition(
        (before + after) / 2, before, after, interval, moved > JUMP * abs(after - before), settled[0]
    )


# ------------------------------------------------------------------------------------- boost-driven detection


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
