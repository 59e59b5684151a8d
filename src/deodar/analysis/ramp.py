"""A slow ramp of input, up and down: the hysteresis of a field."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deodar.analysis.isolated import InputKind, Isolated
from deodar.analysis.settle import LIMIT
from deodar.summary import Summarised, Summary


@dataclass(frozen=True, repr=False)
class Branch(Summarised):
    """The settled states of a field at each value of a ramp, in one direction.

    Attributes:
        count: number of peaks.
        activation: highest activation, with or without a peak.
        width: width of the highest peak along the first axis, in axis units; NaN without a peak, or on a
            node.
        settled: whether the field settled within the limit.
    """

    count: np.ndarray
    activation: np.ndarray
    width: np.ndarray
    settled: np.ndarray

    def _summary(self) -> Summary:
        some = np.flatnonzero(self.count)
        return Summary(
            f"Branch of {len(self.count)} settled states, {len(some)} with a peak",
            [("activation", f"{self.activation.min():.4g} to {self.activation.max():.4g}")],
        )


@dataclass(frozen=True, repr=False)
class SettledRamp(Summarised):
    """The settled states of a field over increasing, then decreasing values of its input.

    Attributes:
        by: the input that was varied, `input` or `boost`.
        values: the inputs, increasing; both branches are in this order.
        up: from the resting level upwards.
        down: from the highest value downwards.
    """

    by: InputKind
    values: np.ndarray
    up: Branch
    down: Branch

    @property
    def bistable(self) -> np.ndarray:
        """The values at which the two branches differ in the number of peaks."""
        return self.values[self.up.count != self.down.count]

    def _summary(self) -> Summary:
        bistable = self.bistable
        rows = [
            (self.by, f"{self.values[0]:.4g} to {self.values[-1]:.4g}"),
            ("bistable", f"{bistable[0]:.4g} to {bistable[-1]:.4g}" if len(bistable) else "nowhere"),
        ]
        return Summary(f"Ramp of {len(self.values)} values, up and down", rows)


def ramp(
    isolated: Isolated, values: Sequence[float] | np.ndarray, by: InputKind = "input", limit: float = LIMIT
) -> SettledRamp:
    """Settle a field at each value of its input, first upwards from rest, then downwards.

    Args:
        isolated: the field.
        values: strengths of the input, in any order; the ramp sorts them.
        by: `input` for localised input, `boost` for homogeneous input.
        limit: longest settling, in time constants.
    """
    steps = np.sort(np.asarray(values, np.float64))
    isolated.reset()
    up = _branch(isolated, steps, by, limit)
    down = _branch(isolated, steps[::-1], by, limit)
    return SettledRamp(
        by, steps, up, Branch(down.count[::-1], down.activation[::-1], down.width[::-1], down.settled[::-1])
    )


def _branch(isolated: Isolated, values: np.ndarray, by: InputKind, limit: float) -> Branch:
    count, activation, width, settled = [], [], [], []
    for strength in values:
        isolated.put(**{by: strength})
        settled.append(bool(isolated.settle(limit=limit)))
        peaks = isolated.peaks()
        count.append(len(peaks))
        activation.append(float(isolated.activation().max()))
        width.append(peaks[0].width[0] if peaks and isolated.axes else np.nan)
    return Branch(np.array(count), np.array(activation), np.array(width), np.array(settled))
