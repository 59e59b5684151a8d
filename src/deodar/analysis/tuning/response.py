"""The responses of a batch of candidates to inputs, from which requirements read their margins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deodar.analysis.isolated import WHOLE
from deodar.analysis.selection import HEAD_START
from deodar.numerics.axes import Axes

STEP = 0.1
"""Activation beyond the threshold, relative to the field's scale, at which an on/off margin is 1."""

MISSED = -0.1
"""Margin where a requirement is missed in a way that activation does not show."""

LASTING = 300.0
"""Time constants for which a peak outlasts its input at which its margin is nearly 0."""

LOST = -20.0
"""Margin where activation is not finite."""


@dataclass(frozen=True)
class FieldInput:
    """The input of one stage.

    Attributes:
        middle: amplitude of the localised input in the middle; the input of a node.
        first: amplitude of the first of two inputs at equal distances from the middle.
        second: amplitude of the second one.
        boost: homogeneous input.
    """

    middle: float = 0.0
    first: float = 0.0
    second: float = 0.0
    boost: float = 0.0


@dataclass(frozen=True)
class SettledBatch:
    """What a batch of candidates has settled to at the end of a stage.

    Attributes:
        above: activation relative to the threshold, (candidates, samples); a node has one sample.
        peaks: number of peaks.
        width: width of the widest peak.
        settled: whether the field settled within the limit.
        active: time constants for which activation was above the threshold, from the begin of the stage.
    """

    above: np.ndarray
    peaks: np.ndarray
    width: np.ndarray
    settled: np.ndarray
    active: np.ndarray


Stages = tuple[FieldInput, ...]


class FieldResponse:
    """The responses of a batch of candidates, each computed when it is first read.

    `after(a, b)` is the field after two stages of input from the resting level, each until it settles. Stages
    that several requirements have in common are computed once.

    Args:
        run: computes the end of stages.
        axes: the field's axes.
        strength: amplitude of the inputs of the protocol.
        scale: distance between resting level and threshold of the model's own field.
        threshold: threshold of each candidate.
        places: samples of the two inputs.
        tau: time constant, in document time.
    """

    def __init__(
        self,
        run: Callable[[Stages], SettledBatch],
        axes: Axes,
        strength: float,
        scale: float,
        threshold: np.ndarray,
        places: tuple[int, ...],
        tau: float,
    ) -> None:
        self._run = run
        self.axes, self.strength, self.scale, self.tau = axes, strength, scale, tau
        self.threshold, self.places = threshold, places

    def localised(self, strength: float | None) -> FieldInput:
        """Return the localised input of an amplitude; None: that of the protocol."""
        return FieldInput(middle=self.strength if strength is None else strength)

    def after(self, *stages: FieldInput) -> SettledBatch:
        """Return what the field has settled to after stages of input from the resting level."""
        return self._run(stages or (FieldInput(),))

    def above(self, *stages: FieldInput) -> np.ndarray:
        """Return the highest activation relative to the threshold after stages of input."""
        return self.after(*stages).above.max(-1)

    def competing(self, strength: float) -> SettledBatch:
        """Return the field with two equal inputs, of which the first was a hundredth stronger before."""
        ahead = FieldInput(first=strength * (1 + HEAD_START), second=strength)
        return self.after(ahead, FieldInput(first=strength, second=strength))

    # ------------------------------------------------------------------------------------- parts of a margin

    def silent(self, stage: SettledBatch) -> np.ndarray:
        """Return the margin of a field without a peak."""
        return self.guarded(stage, self._margin(-stage.above.max(-1)))

    def active(self, stage: SettledBatch) -> np.ndarray:
        """Return the margin of a field with a peak that does not spread over the field."""
        return self.guarded(stage, np.minimum(self._margin(stage.above.max(-1)), self._bounded(stage)))

    def kept(self, stage: SettledBatch) -> np.ndarray:
        """Return the margin of a peak that is still there after its input has changed.

        Where it vanishes, the margin grows with the time for which it outlasts the change, because its
        activation says nothing about how near it is to staying.
        """
        outlasts = np.log1p(np.maximum(stage.active, 0.0)) / np.log(LASTING)
        lost = -1 + np.minimum(outlasts, 1 + MISSED)
        return np.where(stage.above.max(-1) > 0, self.active(stage), self.guarded(stage, lost))

    def one_of_two(self, stage: SettledBatch) -> np.ndarray:
        """Return the margin of one peak at one of the two places, and none at the other."""
        first, second = (self._near(stage, place) for place in self.places)
        wins, loses = np.maximum(first, second), np.minimum(first, second)
        margin = np.minimum(self._margin(wins), self._margin(-loses))
        margin = np.where(stage.peaks == 1, margin, np.minimum(margin, MISSED))
        return self.guarded(stage, margin)

    def both_of_two(self, stage: SettledBatch) -> np.ndarray:
        """Return the margin of a peak at each of the two places."""
        first, second = (self._near(stage, place) for place in self.places)
        margin = self._margin(np.minimum(first, second))
        margin = np.where(stage.peaks == 2, margin, np.minimum(margin, MISSED))
        return self.guarded(stage, margin)

    def _near(self, stage: SettledBatch, place: int) -> np.ndarray:
        """Return the highest activation near a place: nearer than a quarter of the distance of the two."""
        reach = max(1, abs(self.places[1] - self.places[0]) // 4)
        samples = np.arange(max(0, place - reach), min(stage.above.shape[-1], place + reach + 1))
        return stage.above[:, samples].max(-1)

    def _bounded(self, stage: SettledBatch) -> np.ndarray:
        if not self.axes:
            return np.ones(len(stage.width))
        most = WHOLE * self.axes[0].range
        margin = np.minimum(1.0, (most - stage.width) / (STEP * most))
        return np.where(stage.width < most, margin, np.minimum(margin, MISSED))

    def _margin(self, above: np.ndarray) -> np.ndarray:
        return np.minimum(1.0, above / (STEP * self.scale))

    def guarded(self, stage: SettledBatch, margin: np.ndarray) -> np.ndarray:
        """Return a margin that is below 0 where the field did not settle, or is not finite."""
        margin = np.where(stage.settled, margin, np.minimum(margin, MISSED))
        return np.where(np.isfinite(stage.above).all(-1), np.nan_to_num(margin, nan=LOST), LOST)
