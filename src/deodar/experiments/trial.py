"""The result of one trial: sampled values, events and measures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from deodar.errors import NotFinite
from deodar.experiments.observations import TIME as TIME
from deodar.experiments.running_trial import Kept

Value = float | list[float] | None


@dataclass(frozen=True)
class Trial:
    """The result of one trial.

    Attributes:
        times: document time of each sample, the first at the start.
        values: the values of each watched port or sensor, sampling times first; samples taken while recording
            was stopped are left out.
        events: document time of each event; None: it did not occur.
        outcome: the event that ended the trial, `time`, or `diverged`.
        measures: each measure; None: its event did not occur.
        recorded: document time of each sample in `values`.
        snapshots: the snapshots of actions, by their labels: document time, and the values of each port.
        error: reason of a trial that diverged: its values are NaN, its events and measures None; none: it did
            not diverge.
    """

    times: np.ndarray
    values: Mapping[str, np.ndarray]
    events: Mapping[str, float | None]
    outcome: str
    measures: Mapping[str, Value] = field(default_factory=dict[str, Value])
    recorded: np.ndarray = field(default_factory=lambda: np.zeros(0))
    snapshots: Mapping[str, Kept] = field(default_factory=dict[str, Kept])
    error: NotFinite | None = None

    @property
    def duration(self) -> float:
        """Document time from the first sample to the last."""
        return float(self.times[-1] - self.times[0]) if len(self.times) else 0.0
