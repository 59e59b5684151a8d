"""Settling: run a session until its fields no longer change."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deodar.elements.field import Field
from deodar.errors import AnalysisError
from deodar.session.session import Session
from deodar.summary import Summarised, Summary

LIMIT = 2000.0
"""Longest settling, in time constants.

Near an instability the slowest rate of change is the distance d from it, and the passage takes about pi /
sqrt(d) time constants: 200 for a distance of a hundredth of a percent of an activation of 2.
"""
LEAST_STEPS = 50


@dataclass(frozen=True, repr=False)
class Settled(Summarised):
    """The result of settling.

    Attributes:
        settled: whether the fields settled within the limit.
        time_constants: duration of settling, in units of the longest time constant.
        change: the last change of activation per time constant, the largest of all fields and samples.
    """

    settled: bool
    time_constants: float
    change: float

    def __bool__(self) -> bool:
        return self.settled

    def _summary(self) -> Summary:
        outcome = "Settled" if self.settled else "Not settled"
        rows = [("last change per time constant", f"{self.change:.2g}")]
        return Summary(f"{outcome} after {self.time_constants:.4g} time constants", rows)


def settle(session: Session, tolerance: float = 1e-3, limit: float = LIMIT) -> Settled:
    """Run until no field changes by more than `tolerance` per time constant, or until `limit` time constants
    have passed.

    Noise must be off, or below the tolerance; otherwise the run reaches the limit.

    Args:
        session: the session, which continues from its present state.
        tolerance: largest change of activation per time constant that counts as settled; > 0.
        limit: longest run, in units of the longest time constant of the session's fields; > 0.

    Raises:
        AnalysisError: if the session has no field.
    """
    if not tolerance > 0 or not limit > 0:
        raise AnalysisError(f"settling needs a tolerance and a limit above 0, not {tolerance} and {limit}")
    fields = [(e.path, e.element.tau) for e in session.document.entries if isinstance(e.element, Field)]
    if not fields:
        raise AnalysisError("the session has no field that could settle", where=session.document.name)
    longest = max(tau for _, tau in fields)
    steps = max(LEAST_STEPS, math.ceil(longest / session.dt))
    passed, change = 0.0, math.inf
    before = [session.read(f"{path}.activation") for path, _ in fields]
    while passed < limit:
        session.step(steps)
        passed += steps * session.dt / longest
        after = [session.read(f"{path}.activation") for path, _ in fields]
        moved = [
            float(np.max(np.abs(b - a))) * tau / (steps * session.dt)
            for a, b, (_, tau) in zip(before, after, fields, strict=True)
        ]
        before, change = after, max(moved)
        if change <= tolerance:
            return Settled(True, passed, change)
    return Settled(False, passed, change)
