"""What is done and observed in each of several trials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deodar.experiments.actions import Action
from deodar.experiments.events import Event
from deodar.experiments.measures import BaseMeasure
from deodar.experiments.observable import Observable


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
