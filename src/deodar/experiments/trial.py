"""The result of one trial: what was seen of it, and what happened when."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from deodar.errors import NotFinite
from deodar.experiments.observations import TIME as TIME
from deodar.experiments.running import Kept

Value = float | list[float] | None


@dataclass(frozen=True)
class Trial:
    """One trial, run.

    Attributes:
        times: document time of each look, the first at the start.
        values: for each thing that was watched its values, looks first; those at which recording was stopped
            are left out.
        events: document time of each event; None: it did not happen.
        outcome: the event that ended the trial, `time`, or `diverged`.
        measures: each measure; None: what it waits for did not happen.
        recorded: document time of each look that `values` holds.
        snapshots: what actions kept, by their labels: document time, and for each port its values.
        error: of a trial that diverged, why: its values are NaN, its events and measures None; none: it did
            not.
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
        """Document time from the first look to the last."""
        return float(self.times[-1] - self.times[0]) if len(self.times) else 0.0
