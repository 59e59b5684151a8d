"""The course of one trial: what was seen of it, and what happened when."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deodar.experiments.events import Event

TIME = "time"
"""Outcome of a trial that was ended by nothing but its limit."""


@dataclass(frozen=True)
class Course:
    """One trial, run.

    Attributes:
        times: document time of each look, the first at the start.
        values: for each thing that was looked at its values, looks first.
        events: document time of each event; None: it did not happen.
        outcome: the event that ended the trial, or `time`.
    """

    times: np.ndarray
    values: Mapping[str, np.ndarray]
    events: Mapping[str, float | None]
    outcome: str

    @property
    def duration(self) -> float:
        """Document time from the first look to the last."""
        return float(self.times[-1] - self.times[0])


class Notes:
    """What has been seen of a trial that runs.

    Attributes:
        outcome: the event that ended it, or `time`; empty while it runs.
    """

    def __init__(self, events: Sequence[Event]) -> None:
        self.outcome = ""
        self._events = events
        self._times: list[float] = []
        self._looks: list[Mapping[str, np.ndarray]] = []
        self._counts = [0] * len(events)
        self._found: dict[str, float | None] = {e.name: None for e in events}

    def take(self, time: float, look: Mapping[str, np.ndarray], last: bool) -> None:
        """Take down a look, and what it shows to have happened; after the last one nothing but the limit ends the trial."""
        self._times.append(time)
        self._looks.append(look)
        for k, event in enumerate(self._events):
            if self._found[event.name] is not None:
                continue
            self._counts[k] += event.holds(look, self._looks[0])
            if self._counts[k] >= event.times:
                self._found[event.name] = time
                self.outcome = self.outcome or (event.name if event.ends else "")
        self.outcome = self.outcome or (TIME if last else "")

    def course(self, wanted: Sequence[str]) -> Course:
        """The course up to the last look."""
        values = {name: np.stack([look[name] for look in self._looks]) for name in wanted}
        return Course(np.asarray(self._times), values, self._found, self.outcome)
