"""The samples of trials that run together, and the ticks at which the trials stop."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import numpy as np

from deodar.errors import ParameterError
from deodar.experiments.actions import Record
from deodar.experiments.field_reader import ReadPlace
from deodar.experiments.observable import Observable
from deodar.experiments.observations import DIVERGED, Observations
from deodar.experiments.running_trial import RunningTrial
from deodar.experiments.trial import Trial, TrialPlan
from deodar.experiments.trial_copies import WORLD, TrialCopies, axes_of
from deodar.model import find
from deodar.model.document import Document, Entry
from deodar.numerics.axes import Axes, shape
from deodar.worlds._base import World

LOOKS = 24
"""Number of sampling times per call of the program.

The steps of a trial after its end are discarded: on average half of a call.
"""


class Stops:
    """The ticks up to which trials run in one go: samples, actions, and the end.

    Attributes:
        gap: steps between two samples.
        steps: steps of a trial that times out.
        looks: most samples up to the next stop.
    """

    def __init__(self, gap: int, steps: int, looks: int = LOOKS) -> None:
        self.gap, self.steps, self.looks = gap, steps, looks

    def sampled(self, tick: int) -> bool:
        """Return whether all trials are sampled at a tick."""
        return tick % self.gap == 0 or tick == self.steps

    def next_sample(self, tick: int) -> int:
        """Return the tick of the first sample after a tick."""
        return min((tick // self.gap + 1) * self.gap, self.steps)

    def after(self, tick: int, running: Sequence[RunningTrial]) -> int:
        """Return the stop after a tick: not after the next action of any trial, nor after the first time at
        which an action may be due whose event has not occurred yet.
        """
        last = self.steps - self.steps % self.gap
        to = min((tick // self.gap + self.looks) * self.gap, last if tick < last else self.steps)
        for trial in running:
            if trial.due is not None:
                to = min(to, trial.due)
            if trial.delay is not None:
                to = min(to, self.next_sample(tick) + trial.delay)
        return to


class SampledPlaces:
    """What is sampled of a model and its world: the watched values, and those of events and measures.

    Attributes:
        watched: the place of each watched path.
        viewed: the place of each view.
        readers: the places of the views that a reader in the model reduces.
        all: all places, each once.
    """

    def __init__(
        self, doc: Document, plan: TrialPlan, world: World | None, readers: Mapping[Observable, ReadPlace]
    ) -> None:
        sensors = () if world is None else world.sensors

        def place(name: str, port: Callable[[], tuple[Entry, str]]) -> ReadPlace:
            if name in sensors:
                return WORLD, name
            entry, port_name = port()
            return entry.id, port_name

        self.watched = [place(name, lambda name=name: find.shown(doc, name)) for name in plan.watch]
        self.readers = readers
        self.viewed = {
            view: readers.get(view) or place(view.of, lambda view=view: view.place(doc))
            for view in plan.views
        }
        places = list(dict.fromkeys([*self.watched, *self.viewed.values()]))
        self.all = places or [_anything(doc)]


class TrialSamples:
    """The samples of all trials of a call.

    Args:
        copies: the copies that are the trials.
        plan: what is observed.
        places: what is sampled.
        watched: the trials whose watched values are returned; none: all.
    """

    def __init__(
        self, copies: TrialCopies, plan: TrialPlan, places: SampledPlaces, watched: Sequence[int] | None
    ) -> None:
        self.copies, self.plan, self.places = copies, plan, places
        count = len(copies.trials)
        self.observed = Observations(plan.events, plan.measures, count)
        self.axes = {place: self._axes(place) for place in places.all}
        self.is_watched = [watched is None or number in watched for number in copies.trials]
        self.t0, self.step = copies.run.doc.t0, copies.dt
        self.times: list[float] = []
        self.looks = np.zeros(count, int)
        self.last: dict[int, float] = {}
        self.pauses = plan.has(Record)
        self.recorded: list[list[slice]] = [[] for _ in range(count)]
        self.parts: list[list[list[np.ndarray]]] = [[] for _ in range(count)]
        self.latest: tuple[Mapping[ReadPlace, np.ndarray], Mapping[Observable, np.ndarray]] = ({}, {})

    def _axes(self, place: ReadPlace) -> Axes:
        if place[0] == WORLD:
            assert self.copies.world is not None
            return axes_of(self.copies.world, place[1])
        program = self.copies.run.program
        return program.axes(program.port(*place))

    def advance(self, to: int, stops: Stops, running: Sequence[RunningTrial]) -> None:
        """Run all copies up to a tick, and take the samples on the way; at the start that of the start."""
        begun = self.copies.run.clock.tick
        first = 0 if to == begun else stops.next_sample(begun) - begun

        def take(k: int, arrays: Sequence[np.ndarray]) -> None:
            count = arrays[0].shape[1]
            ticks = [min(begun + first + (k + n) * stops.gap, stops.steps) for n in range(count)]
            self._take(ticks, arrays, ticks[-1] == stops.steps, running)

        self.copies.record(to - begun, self.places.all, first, stops.gap, take)
        if self.copies.alone and self.copies.errors and not self.ended(0):
            self.observed.outcome[0] = DIVERGED

    def look(self) -> None:
        """Sample the present moment, which belongs to trials that end now."""
        tick = self.copies.run.clock.tick

        def take(_: int, arrays: Sequence[np.ndarray]) -> None:
            self.latest = self._seen(arrays, self.copies.good(np.asarray([tick])))

        self.copies.record(0, self.places.all, 0, 1, take)

    def end(self, trial: RunningTrial, sampled: bool) -> None:
        """End a trial by an action, at the latest sample; one that is not among those of all trials is an
        additional one.
        """
        row, (by, seen) = trial.row, self.latest
        k = self.copies.rows.index(row)
        if not sampled:
            self.last[row] = trial.time
            if trial.recording:
                self._keep(row, {place: values[k, -1:] for place, values in by.items()})
        self.observed.end(row, trial.outcome, seen, k)

    def ended(self, row: int) -> bool:
        """Return whether a trial has ended."""
        return bool(self.observed.outcome[row])

    @cached_property
    def moments(self) -> np.ndarray:
        """Document time of each sample, after the last one."""
        return np.asarray(self.times)

    def trial(self, trial: RunningTrial) -> Trial:
        """Return the result of a trial."""
        row = trial.row
        outcome, parts_of_trial = self.observed.outcome[row], self.parts[row]
        error = self.copies.errors[row] if outcome == DIVERGED else None
        values: dict[str, np.ndarray] = {}
        for i, name in enumerate(self.plan.watch if self.is_watched[row] else ()):
            nothing = np.zeros((0, *shape(self.axes[self.places.watched[i]])))
            samples = np.concatenate([part[i] for part in parts_of_trial]) if parts_of_trial else nothing
            values[name] = samples if error is None else np.full_like(samples, np.nan)
        last = [self.last[row]] if row in self.last else []
        times = recorded = np.concatenate([self.moments[: self.looks[row]], last])
        if self.pauses:
            parts = [self.moments[part] for part in self.recorded[row]]
            recorded = np.concatenate([*parts, last if trial.recording else []])
        axes = {view: self._axes_of(place) for view, place in self.places.viewed.items()}
        return Trial(
            times,
            values,
            self.observed.events_of(row),
            outcome,
            self.observed.measures_of(row, axes),
            recorded,
            trial.snapshots,
            error,
        )

    def _axes_of(self, place: ReadPlace) -> Axes | None:
        """Return the axes of a place of the model; None for a sensor of the world."""
        return None if place[0] == WORLD else self.axes[place]

    def _take(
        self, ticks: Sequence[int], arrays: Sequence[np.ndarray], last: bool, running: Sequence[RunningTrial]
    ) -> None:
        new, before = [self.t0 + tick * self.step for tick in ticks], len(self.times)
        self.times.extend(new)
        rows, good = self.copies.rows, self.copies.good(np.asarray(ticks))
        self.latest = by, seen = self._seen(arrays, good)
        counts = self.observed.take(rows, np.asarray(new), seen, last, good)
        self.looks[rows] += counts
        watched = self.places.watched
        for k, n in enumerate(counts.tolist() if watched or self.pauses else ()):
            if n and running[rows[k]].recording:
                if self.pauses:
                    self.recorded[rows[k]].append(slice(before, before + n))
                self._keep(rows[k], {place: by[place][k, :n] for place in watched})

    def _keep(self, row: int, values: Mapping[ReadPlace, np.ndarray]) -> None:
        if self.places.watched and self.is_watched[row]:
            self.parts[row].append([np.array(values[place]) for place in self.places.watched])

    def _seen(
        self, arrays: Sequence[np.ndarray], good: np.ndarray
    ) -> tuple[dict[ReadPlace, np.ndarray], dict[Observable, np.ndarray]]:
        """Return samples (copies, sampling times, ...) by place and by view."""
        places = self.places
        by = {place: _blank(a, good) for place, a in zip(places.all, arrays, strict=True)}
        seen = {
            view: view.from_reader(by[place])
            if view in places.readers
            else view.seen(by[place], self._axes_of(place), 2)
            for view, place in places.viewed.items()
        }
        return by, seen


def _blank(values: np.ndarray, good: np.ndarray) -> np.ndarray:
    """Return samples, (copies, sampling times, ...), with 0 from number `good` of each copy on.

    Events then need no rule for values like NaN.
    """
    bad = np.arange(values.shape[1]) >= good[:, None]
    return np.where(bad.reshape(*bad.shape, *[1] * (values.ndim - 2)), 0, values) if bad.any() else values


def _anything(doc: Document) -> ReadPlace:
    """Return the smallest port, to read where only the time is needed."""
    if not doc.entries:
        raise ParameterError("the model is empty, so there is nothing to run")
    return doc.entries[0].id, find.outputs(doc.entries[0])[0]
