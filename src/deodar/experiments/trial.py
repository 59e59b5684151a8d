"""A trial: what is done and observed in it, and its result: sampled values, events and measures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from deodar.errors import NotFinite
from deodar.experiments.actions import Action
from deodar.experiments.events import Event
from deodar.experiments.measures import BaseMeasure
from deodar.experiments.observable import Observable
from deodar.experiments.observations import TIME as TIME
from deodar.experiments.running_trial import Kept

Value = float | list[float] | None


@dataclass(frozen=True)
class TrialPlan:
    """What is done and observed in each of several trials.

    Attributes:
        limit: document time after which a trial times out.
        watch: paths of ports whose values are returned, and names of sensors of a world on the host; the path
            of a field alone means its activation.
        events: the events to detect; events with `ends` end a trial.
        measures: the measures of each trial.
        actions: the actions, at their times or after their events.
        every: sampling interval in document time; none: dt. The first sample is at the start.
        dt: Euler step; none: the document's own.
    """

    limit: float
    watch: Sequence[str] = ()
    events: Sequence[Event] = ()
    measures: Sequence[BaseMeasure] = ()
    actions: Sequence[Action] = ()
    every: float | None = None
    dt: float | None = None

    @property
    def views(self) -> list[Observable]:
        """What events and measures look at, each once."""
        return list(
            dict.fromkeys([*(v for e in self.events for v in e.views), *(m.view for m in self.measures)])
        )

    def has(self, kind: type[Action]) -> bool:
        """Return whether an action of this kind is among the actions."""
        return any(isinstance(action, kind) for action in self.actions)


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
