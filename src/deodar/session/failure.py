"""Values that are not finite: the step at which they first occur in each copy, and the error message."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import EllipsisType
from typing import TypeVar

import numpy as np

from deodar.errors import NotFinite
from deodar.session.clock import Clock

RowSpans = list[tuple[int, int]]
"""Pairs of a group of a plan and a row in it."""

CopyIndex = TypeVar("CopyIndex", tuple[int, ...], EllipsisType)
"""Index of a copy in a batch; `...` means all copies together."""


def first_steps(
    bad: Callable[[int], Sequence[np.ndarray]], low: int, high: int, copies: Sequence[CopyIndex]
) -> dict[CopyIndex, tuple[int, RowSpans]]:
    """Find for each copy the first step after which a value is not finite, and the rows concerned.

    The search is a bisection, shared by copies that fail at the same steps.

    Args:
        bad: function of a number of steps; returns for each group which rows of which copies are not finite,
            (copies..., rows).
        low: number of steps after which all values are finite.
        high: number of steps after which each copy has a value that is not finite.
        copies: indices of the copies.
    """
    if not copies:
        return {}
    middle = (low + high) // 2 if high - low > 1 else high
    groups = bad(middle)
    if middle == high:
        return {
            copy: (
                high,
                [(g, r) for g, b in enumerate(groups) for r in range(b.shape[-1]) if b[copy][..., r].any()],
            )
            for copy in copies
        }
    early = [copy for copy in copies if any(b[copy].any() for b in groups)]
    late = [copy for copy in copies if copy not in early]
    return first_steps(bad, low, middle, early) | first_steps(bad, middle, high, late)


def not_finite(names: Sequence[str], clock: Clock, unit: str) -> NotFinite:
    """Make the error that names the elements and the step."""
    listed = ", ".join(names[:5]) + (", ..." if len(names) > 5 else "")
    return NotFinite(
        f"{listed} became infinite or undefined in step {clock.tick} (time {clock.time:g} {unit}, dt"
        f" {clock.dt:g})",
        names,
        fix=(
            "The step may be too long for this model: try a smaller dt; else look for an input or a coupling"
            " that grows without bound"
        ),
        step=clock.tick,
    )
