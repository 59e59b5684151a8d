"""Events and measures of trials that run together: the time of each event, and the value of each measure."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from graphlib import CycleError, TopologicalSorter

import numpy as np

from deodar.errors import KindError, ParameterError, UnknownName, did_you_mean, show
from deodar.experiments.events import Event, Samples
from deodar.experiments.measures import BaseMeasure
from deodar.experiments.observable import Observable
from deodar.kind_errors import errors_of_kind, position
from deodar.numerics.axes import Axes

TIME = "time"
"""Outcome of a trial that timed out."""

DIVERGED = "diverged"
"""Outcome of a trial in which a value became infinite or undefined."""


class Observations:
    """The results of all samples so far.

    Attributes:
        outcome: for each trial the event that ended it, or `time`; empty while it runs.
        found: document time of each event (by its number) in each trial; NaN: it did not occur.
        measured: for each measure and trial the sampled value; None: it was not taken.
    """

    def __init__(self, events: Sequence[Event], measures: Sequence[BaseMeasure], trials: int) -> None:
        require(events, measures)
        self.events, self.measures = tuple(events), tuple(measures)
        self._order = _order(events)
        self._number = {e.name: k for k, e in enumerate(events)}
        self.outcome = [""] * trials
        self.found = np.full((len(events), trials), np.nan)
        self.measured: list[list[np.ndarray | None]] = [[None] * trials for _ in measures]
        self._counts = np.zeros((len(events), trials), int)
        self._been = np.zeros((len(events), trials), bool)
        self._first: dict[Observable, np.ndarray] = {}

    def take(
        self,
        rows: Sequence[int],
        times: np.ndarray,
        seen: Mapping[Observable, np.ndarray],
        last: bool,
        good: np.ndarray | None = None,
    ) -> np.ndarray:
        """Evaluate samples of some trials: `times` of the samples, and the values, (trials, sampling times,
        ...).

        Args:
            rows: numbers of these trials.
            times: document time of each sample.
            seen: for each view the sampled values.
            last: whether the limit is reached at the last of these times.
            good: for each of these trials the number of samples before it diverges; none: all. A trial that
                has not ended by then diverges.

        Returns:
            For each of these trials the number of samples that belong to it: all while it runs, none after
            its end.
        """
        at, n = np.asarray(rows), len(times)
        if not self._first:
            self._first = {view: np.array(values[:, :1]) for view, values in seen.items()}
        samples = Samples(times, seen, {view: first[at] for view, first in self._first.items()})
        running = np.array([not self.outcome[r] for r in rows])
        valid = np.full(len(rows), n) if good is None else good
        before_it = np.arange(n) < valid[:, None]
        hits = np.full((len(self.events), len(rows)), n)
        for k in self._order:
            event = self.events[k]
            holds = np.broadcast_to(np.asarray(event.holds(samples)), (len(rows), n)) & before_it
            if event.turns:
                before = self._been[k, at][:, None] | np.logical_or.accumulate(~holds, axis=1)
                self._been[k, at] = before[:, -1]
                holds = holds & before
            samples.holds[event.name] = holds
            counts = self._counts[k, at][:, None] + np.cumsum(holds, axis=1)
            self._counts[k, at] = counts[:, -1]
            reached = counts >= event.times
            new = reached.any(axis=1) & np.isnan(self.found[k, at])
            hits[k, new] = reached.argmax(axis=1)[new]
        ends = np.full(len(rows), n)
        # of several at one time the first in the list is the outcome
        for k in reversed(range(len(self.events))):
            if self.events[k].ends:
                self._end(rows, running & (hits[k] < n) & (hits[k] <= ends), self.events[k].name)
                ends = np.minimum(ends, hits[k])
        self._end(rows, running & (ends == n) & (valid < n), DIVERGED)
        if last:
            self._end(rows, running & (ends == n) & (valid == n), TIME)
            ends = np.minimum(ends, n - 1)
        ends = np.minimum(ends, np.where(valid < n, valid - 1, n))
        happened = running & (hits <= ends) & (hits < n)
        for k in range(len(self.events)):
            self.found[k, at[happened[k]]] = times[hits[k, happened[k]]]
        for m, measure in enumerate(self.measures):
            when = hits[self._number[measure.when]] if measure.when else ends
            took = happened[self._number[measure.when]] if measure.when else running & (ends < n)
            for i in np.flatnonzero(took).tolist():
                self.measured[m][rows[i]] = np.array(seen[measure.view][i, when[i]])
        return np.where(running, np.minimum(ends + 1, n), 0)

    def restart(self, rows: Sequence[int], seen: Mapping[Observable, np.ndarray]) -> None:
        """Forget all samples of some trials, which begin again with other values; no event may name the time.

        Args:
            rows: numbers of these trials.
            seen: for each view the values at the start, as `take` gets them.
        """
        for row in rows:
            self.outcome[row] = ""
        at = np.asarray(rows, int)
        self.found[:, at], self._counts[:, at], self._been[:, at] = np.nan, 0, False
        for view in self._first:
            self._first[view][at] = seen[view][:, :1]

    def end(self, row: int, outcome: str, seen: Mapping[Observable, np.ndarray], copy: int) -> None:
        """End a trial with a given outcome, at the last of the samples of a copy."""
        self.outcome[row] = outcome
        for m, measure in enumerate(self.measures):
            if not measure.when:
                self.measured[m][row] = np.array(seen[measure.view][copy, -1])

    def events_of(self, row: int) -> dict[str, float | None]:
        """Return the document time of each event of a trial; None: it did not occur, or the trial
        diverged.
        """
        if self.outcome[row] == DIVERGED:
            return {e.name: None for e in self.events}
        return {
            e.name: None if np.isnan(t) else float(t)
            for e, t in zip(self.events, self.found[:, row], strict=True)
        }

    def measures_of(
        self, row: int, axes: Mapping[Observable, Axes | None]
    ) -> dict[str, float | list[float] | None]:
        """Return each measure of a trial; None: it was not taken, its value is undefined, or the trial
        diverged.

        Args:
            row: number of the trial.
            axes: for each view the axes of what it samples.
        """
        if self.outcome[row] == DIVERGED:
            return {m.name: None for m in self.measures}
        out: dict[str, float | list[float] | None] = {}
        for m, values in zip(self.measures, self.measured, strict=True):
            samples = values[row]
            out[m.name] = None if samples is None else _measured(m, samples, axes[m.view])
        return out

    def _end(self, rows: Sequence[int], which: np.ndarray, name: str) -> None:
        for i in np.flatnonzero(which).tolist():
            self.outcome[rows[i]] = name


def _measured(measure: BaseMeasure, samples: np.ndarray, axes: Axes | None) -> float | list[float] | None:
    """Return the value of a measure as plain numbers."""
    with errors_of_kind(measure, f"measures.{measure.name}"):
        value = measure.value(samples, axes)
        if value is None:
            return None
        numbers = np.asarray(value)
        if numbers.dtype.kind == "O":  # None among numbers is undefined
            with contextlib.suppress(TypeError, ValueError):
                numbers = numbers.astype(float)
        if numbers.dtype.kind not in "biuf":
            kind = type(measure)
            what = f"{position(kind, 'value')} returns {show(value)}; expected a number, several, or None"
            raise KindError(what, kind=kind.__name__)
        return numbers.astype(float).tolist()


def require(events: Sequence[Event], measures: Sequence[BaseMeasure] = ()) -> None:
    """Refuse events and measures with equal names, and events made of unknown events."""
    names = [*(e.name for e in events), *(m.name for m in measures)]
    twice = next((n for n in names if names.count(n) > 1 or n in (TIME, DIVERGED)), None)
    if twice is not None:
        problem = (
            "is the name of two events or measures"
            if names.count(twice) > 1
            else "is the name of an outcome that every experiment has"
        )
        raise ParameterError(problem, where=twice, fix="Give each a name of its own")
    names_of_events = [e.name for e in events]
    for name, others in [
        *((e.name, e.others) for e in events),
        *((m.name, (m.when,) if m.when else ()) for m in measures),
    ]:
        for other in others:
            if other not in names_of_events:
                raise UnknownName(
                    f"there is no event {other!r}", where=name, fix=did_you_mean(other, names_of_events)
                )
    _order(events)


def _order(events: Sequence[Event]) -> list[int]:
    """Return the numbers of the events in an order of evaluation: an event after those it is made of."""
    number = {e.name: k for k, e in enumerate(events)}
    try:
        return [number[name] for name in TopologicalSorter({e.name: e.others for e in events}).static_order()]
    except CycleError as error:
        name = min(error.args[1], key=lambda name: number[name])
        fix = "Leave its own name out of those it names"
        raise ParameterError("depends on itself", where=name, fix=fix) from None
