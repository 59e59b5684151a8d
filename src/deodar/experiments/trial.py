"""A trial: what is done and observed in it, and its result: sampled values, events and measures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from deodar.errors import NotFinite, TimeError
from deodar.experiments.actions import Action
from deodar.experiments.events import Event
from deodar.experiments.measures import BaseMeasure
from deodar.experiments.observable import Observable
from deodar.experiments.observations import TIME as TIME
from deodar.experiments.running_trial import Kept
from deodar.parameters import Part, Recompile, show
from deodar.session.run import require_sampled, whole
from deodar.summary import Summarised, Summary, counted

MOST_ENTRIES = 2000
"""Largest number of ports, events, measures or actions of a plan (a guess)."""

Value = float | list[float] | None


@dataclass(frozen=True)
class TrialPlan(Part):
    """What is done and observed in each of several trials.

    Attributes:
        limit: document time after which a trial times out.
        watch: paths of ports whose values are kept; the path of a field alone means its activation. Beside a
            world on the host also names of its sensors.
        events: the events to detect; events with `ends` end a trial.
        measures: the measures of each trial.
        actions: the actions, at their times or after their events.
        every: sampling interval in document time; none: each step. The first sample is at the start.
        dt: Euler step; none: the document's own.
    """

    limit: Annotated[float, Recompile("time", role="duration", lower=0.0)]
    watch: Annotated[Sequence[str], Recompile(names="port")] = ()
    events: Sequence[Event] = ()
    measures: Sequence[BaseMeasure] = ()
    actions: Sequence[Action] = ()
    every: Annotated[float | None, Recompile("time", role="duration")] = None
    dt: Annotated[float | None, Recompile("time", role="duration")] = None

    def validate(self) -> Iterator[tuple[str, str]]:
        if self.dt is not None and self.dt <= 0:
            yield "dt", f"is {show(self.dt)}; expected a number above 0"
        for name in ("watch", "events", "measures", "actions"):
            count = len(getattr(self, name))
            if count > MOST_ENTRIES:
                yield name, f"has {count:,} entries, more than {MOST_ENTRIES:,}"

    def steps(self, dt: float) -> int:
        """Return the number of steps of a trial that times out.

        Raises:
            TimeError: the limit is no multiple of the step.
        """
        return whole(self.limit, dt, "the limit")

    def gap(self, dt: float) -> int:
        """Return the number of steps between two samples.

        Raises:
            TimeError: the sampling interval is 0, no multiple of the step, or longer than the trial.
        """
        gap = 1 if self.every is None else whole(self.every, dt, "every")
        if gap == 0:
            raise TimeError("every is 0; expected at least one step")
        require_sampled(self.every, gap, round(self.limit / dt), dt)
        return gap

    @property
    def views(self) -> list[Observable]:
        """What events and measures look at, each once."""
        return list(
            dict.fromkeys([*(v for e in self.events for v in e.views), *(m.view for m in self.measures)])
        )

    def has(self, kind: type[Action]) -> bool:
        """Return whether an action of this kind is among the actions."""
        return any(isinstance(action, kind) for action in self.actions)


@dataclass(frozen=True, repr=False)
class Trial(Summarised):
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

    def _summary(self) -> Summary:
        rows = [("duration", self.duration), *self.events.items(), *self.measures.items()]
        return Summary(f"Trial that ended by {self.outcome}, {counted(len(self.times), 'sample')}", rows)
