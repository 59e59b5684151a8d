"""Run many trials of one model as one batch, whose width shrinks as trials end."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import numpy as np

from deodar.compiler.program import Port
from deodar.errors import ParameterError, RunWarning, TimeError, WorldError
from deodar.experiments.actions import Action, End, Record, Reset, require_targets
from deodar.experiments.actions import require as require_actions
from deodar.experiments.events import Event
from deodar.experiments.field_reader import ReadPlace, with_readers
from deodar.experiments.levels import acted
from deodar.experiments.measures import BaseMeasure
from deodar.experiments.observable import Observable
from deodar.experiments.observations import DIVERGED, Observations
from deodar.experiments.pushes import with_pushes
from deodar.experiments.running_copies import CopyTrial, RunningCopies
from deodar.experiments.trial import Trial
from deodar.model import find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.numerics.axes import shape
from deodar.session import agreement
from deodar.session.exchange import embodied
from deodar.session.run import whole
from deodar.session.session import require_model, require_seed
from deodar.worlds._base import World

LOOKS = 24
"""Number of sampling times per call of the program.

The steps of a trial after its end are discarded: on average half of a call.
"""


def run_batch(
    model: Model,
    limit: float,
    trials: Sequence[int],
    watch: Sequence[str] = (),
    events: Sequence[Event] = (),
    seed: int = 0,
    world: World | None = None,
    every: float | None = None,
    dt: float | None = None,
    precision: str = "float32",
    between: Callable[[int], None] | None = None,
    values: Mapping[str, Sequence[float]] | None = None,
    measures: Sequence[BaseMeasure] = (),
    tolerant: bool = False,
    watched: Sequence[int] | None = None,
    actions: Sequence[Action] = (),
) -> list[Trial]:
    """Run trials in one batch; the result of each equals that of `run_trial` up to rounding.

    When half of the copies have ended, the others continue in a batch of half the width: always in a world,
    otherwise where this saves more time than compiling takes. The widths follow from the trials alone, so the
    same call gives the same bits each time. In a batch with other trials the widths may differ: activations
    then agree to 1e-4 in float32 and to 1e-10 in float64, until the model amplifies the difference. A world
    is computed inside the step, so each trial has its own; values of sensors of the world are read from the
    model's sensors. The reduction of a field for events and measures (for example its maximum) is computed
    inside the step too; only watched ports are copied whole.

    The batch stops at each action of any trial, and at each sample while an action waits for an event; then
    only the copies of the trials in question change. Actions may set parameters that are live numbers.

    Args:
        model: the model in its present state.
        limit: document time after which a trial times out.
        trials: numbers of the trials of the seed.
        watch: paths of ports whose values are returned; the path of a field alone means its activation.
        events: the events to detect; events with `ends` end a trial.
        seed: seed of all noise.
        world: the world of the model's sensors and motors, one of pure functions such as an arena; if its
            starts and goals are given per trial, each trial has its own.
        every: sampling interval in document time; none: dt.
        dt: Euler step; none: the document's own.
        precision: float32 or float64.
        between: called after each call of the program with the number of trials that still run.
        values: for parameter paths the value of each trial.
        measures: the measures of each trial.
        tolerant: return the results although all trials diverge, and do not warn.
        watched: the trials whose values of `watch` are returned; none: all.
        actions: the actions on each trial, as of `run_trial`.

    Returns:
        The result of each trial. One that diverges before it ends has the outcome `diverged` and an `error`
        with the reason; its values are NaN, its events and measures None. The others are not affected. A
        `RunWarning` counts those that diverged.

    Raises:
        NotFinite: all trials diverge.
    """
    base = require_model(model)
    require_actions(actions, world)
    require_targets(actions, [e.name for e in events], base.document)
    staged, pushes = with_pushes(base, actions)
    doc = staged.document
    step = doc.step if dt is None else dt
    steps, gap = whole(limit, step, "the limit"), 1 if every is None else whole(every, step, "every")
    if gap == 0:
        raise TimeError("every is 0; expected at least one step")
    numbers = [require_seed(t) for t in trials]
    if not numbers or len(set(numbers)) < len(numbers):
        raise ParameterError(f"expected trial numbers, each of them once, not {list(trials)}")
    if world is not None and embodied(doc, world) is None:
        raise WorldError(
            f"the world {type(world).__name__} cannot be computed for a batch of copies",
            fix="Run them one by one: dd.run_trial(...)",
        )
    agreement.warn(doc, world, stacklevel=2)
    swept = acted(doc, actions, pushes, values or {}, len(numbers))
    read, at = with_readers(doc, views_of(events, measures))
    copies = RunningCopies(
        staged,
        read,
        precision,
        float(step),
        require_seed(seed),
        numbers,
        world,
        swept,
        any(isinstance(a, Reset) for a in actions),
    )
    observed = Observations(events, measures, len(numbers))
    pauses = any(isinstance(a, Record) for a in actions)
    records = _Records(copies, observed, doc, at, watch, watched, pauses)
    running = [CopyTrial(copies, row, actions, pushes) for row in range(len(numbers))]
    for trial in running:
        trial.recording = not any(isinstance(a, Record) and a.on for a in actions)
    ends = any(isinstance(a, End) for a in actions)
    clock = _Stops(gap, steps)
    to = 0
    while True:
        records.advance(to, clock, running)
        here = [running[row] for row in copies.rows if not records.ended(row)]
        for trial in here if actions else ():
            trial.notice(records.observed.events_of(trial.row))
        due = [trial for trial in here if trial.due == to]
        if ends and due and not clock.sampled(to):
            records.look()
        for trial in due:
            trial.do()
            if trial.outcome:
                records.end(trial, clock.sampled(to))
        left = [k for k, row in enumerate(copies.rows) if not records.ended(row)]
        if between is not None:
            between(len(left))
        if not left:
            break
        copies.shrink(left, steps - to)
        here = [running[row] for row in copies.rows if not records.ended(row)] if actions else []
        to = clock.after(to, here)
    out = [records.trial(trial) for trial in running]
    lost = [result.error for result in out if result.error is not None]
    if lost and not tolerant:
        if len(lost) == len(out):
            raise lost[0]
        warnings.warn(
            f"{len(lost)} of {len(out)} trials diverged, the first: {lost[0].problems[0].what}",
            RunWarning,
            stacklevel=2,
        )
    return out


def views_of(events: Sequence[Event], measures: Sequence[BaseMeasure]) -> list[Observable]:
    """Return what events and measures look at, each once."""
    return list(dict.fromkeys([*(v for e in events for v in e.views), *(m.view for m in measures)]))


class _Stops:
    """The ticks up to which a batch runs in one go: samples, actions, and the end.

    Attributes:
        gap: steps between two samples.
        steps: steps of a trial that times out.
    """

    def __init__(self, gap: int, steps: int) -> None:
        self.gap, self.steps = gap, steps

    def sampled(self, tick: int) -> bool:
        """Return whether all trials are sampled at a tick."""
        return tick % self.gap == 0 or tick == self.steps

    def next_sample(self, tick: int) -> int:
        """Return the tick of the first sample after a tick."""
        return min((tick // self.gap + 1) * self.gap, self.steps)

    def after(self, tick: int, running: Sequence[CopyTrial]) -> int:
        """Return the stop after a tick: not after the next action of any trial, nor after the first time at
        which an action may be due whose event has not occurred yet.
        """
        last = self.steps - self.steps % self.gap
        to = min((tick // self.gap + LOOKS) * self.gap, last if tick < last else self.steps)
        for trial in running:
            if trial.due is not None:
                to = min(to, trial.due)
            if trial.delay is not None:
                to = min(to, self.next_sample(tick) + trial.delay)
        return to


class _Records:
    """The samples of all trials of a batch; `pauses`: whether actions start and stop recording."""

    def __init__(
        self,
        copies: RunningCopies,
        observed: Observations,
        doc: Document,
        at: Mapping[Observable, ReadPlace],
        watch: Sequence[str],
        watched: Sequence[int] | None,
        pauses: bool,
    ) -> None:
        self.copies, self.observed, self.watch, self.at = copies, observed, watch, at
        count = len(copies.trials)
        views = views_of(observed.events, observed.measures)
        self.ports = [(entry.id, port) for entry, port in (find.shown(doc, name) for name in watch)]
        self.places = {view: at.get(view) or _place(doc, view) for view in views}
        self.order = list(dict.fromkeys([*self.ports, *self.places.values()])) or [_anything(doc)]
        program = copies.batch.program
        self.axes = {p: program.axes(program.port(*p)) for p in self.order}
        self.wanted = [watched is None or number in watched for number in copies.trials]
        self.t0, self.step = doc.t0, copies.dt
        self.times: list[float] = []
        self.looks = np.zeros(count, int)
        self.last: dict[int, float] = {}
        self.pauses = pauses
        self.recorded: list[list[slice]] = [[] for _ in range(count)]
        self.kept: list[list[list[np.ndarray]]] = [[] for _ in range(count)]
        self.latest: tuple[Mapping[ReadPlace, np.ndarray], Mapping[Observable, np.ndarray]] = ({}, {})

    def advance(self, to: int, stops: _Stops, running: Sequence[CopyTrial]) -> None:
        """Run all copies up to a tick, and take the samples on the way; at the start that of the start."""
        batch = self.copies.batch
        begun = batch.clock.tick
        first = 0 if to == begun else stops.next_sample(begun) - begun

        def take(k: int, arrays: Sequence[np.ndarray]) -> None:
            count = arrays[0].shape[1]
            ticks = [min(begun + first + (k + n) * stops.gap, stops.steps) for n in range(count)]
            self._take(ticks, arrays, ticks[-1] == stops.steps, running)

        batch.record(to - begun, self._read_ports(), first, stops.gap, take)

    def look(self) -> None:
        """Sample the present moment, which belongs to trials that end now."""
        tick = self.copies.batch.clock.tick

        def take(_: int, arrays: Sequence[np.ndarray]) -> None:
            self.latest = self._seen(arrays, self.copies.good(np.asarray([tick])))

        self.copies.batch.record(0, self._read_ports(), 0, 1, take)

    def end(self, trial: CopyTrial, sampled: bool) -> None:
        """End a trial by an action, at the latest sample; one that is not among those of all trials is an
        additional one.
        """
        row, (by, seen) = trial.row, self.latest
        k = self.copies.rows.index(row)
        if not sampled:
            self.last[row] = trial.time
            if trial.recording:
                self._keep(row, {port: values[k, -1:] for port, values in by.items()})
        self.observed.end(row, trial.outcome, seen, k)

    def ended(self, row: int) -> bool:
        """Return whether a trial has ended."""
        return bool(self.observed.outcome[row])

    @cached_property
    def moments(self) -> np.ndarray:
        """Document time of each sample, after the last one."""
        return np.asarray(self.times)

    def trial(self, trial: CopyTrial) -> Trial:
        """Return the result of a trial."""
        row = trial.row
        outcome, kept = self.observed.outcome[row], self.kept[row]
        error = self.copies.errors[row] if outcome == DIVERGED else None
        values: dict[str, np.ndarray] = {}
        for i, name in enumerate(self.watch if self.wanted[row] else ()):
            nothing = np.zeros((0, *shape(self.axes[self.ports[i]])))
            found = np.concatenate([part[i] for part in kept]) if kept else nothing
            values[name] = found if error is None else np.full_like(found, np.nan)
        last = [self.last[row]] if row in self.last else []
        times = recorded = np.concatenate([self.moments[: self.looks[row]], last])
        if self.pauses:
            parts = [self.moments[part] for part in self.recorded[row]]
            recorded = np.concatenate([*parts, last if trial.recording else []])
        return Trial(
            times,
            values,
            self.observed.events_of(row),
            outcome,
            self.observed.measures_of(row, {view: self.axes[p] for view, p in self.places.items()}),
            recorded,
            trial.snapshots,
            error,
        )

    def _take(
        self, ticks: Sequence[int], arrays: Sequence[np.ndarray], last: bool, running: Sequence[CopyTrial]
    ) -> None:
        new, before = [self.t0 + tick * self.step for tick in ticks], len(self.times)
        self.times.extend(new)
        rows, good = self.copies.rows, self.copies.good(np.asarray(ticks))
        self.latest = by, seen = self._seen(arrays, good)
        counts = self.observed.take(rows, np.asarray(new), seen, last, good)
        self.looks[rows] += counts
        for k, n in enumerate(counts.tolist() if self.ports or self.pauses else ()):
            if n and running[rows[k]].recording:
                if self.pauses:
                    self.recorded[rows[k]].append(slice(before, before + n))
                self._keep(rows[k], {port: by[port][k, :n] for port in self.ports})

    def _keep(self, row: int, values: Mapping[ReadPlace, np.ndarray]) -> None:
        if self.ports and self.wanted[row]:
            self.kept[row].append([np.array(values[port]) for port in self.ports])

    def _seen(
        self, arrays: Sequence[np.ndarray], good: np.ndarray
    ) -> tuple[dict[ReadPlace, np.ndarray], dict[Observable, np.ndarray]]:
        """Return samples (copies, sampling times, ...) by port and by view."""
        by = {p: _blank(a, good) for p, a in zip(self.order, arrays, strict=True)}
        seen = {
            view: view.given(by[p]) if view in self.at else view.seen(by[p], self.axes[p], 2)
            for view, p in self.places.items()
        }
        return by, seen

    def _read_ports(self) -> list[Port]:
        return [self.copies.batch.program.port(*p) for p in self.order]


def _blank(values: np.ndarray, good: np.ndarray) -> np.ndarray:
    """Return samples, (copies, sampling times, ...), with 0 from number `good` of each copy on.

    Events then need no rule for values like NaN.
    """
    bad = np.arange(values.shape[1]) >= good[:, None]
    return np.where(bad.reshape(*bad.shape, *[1] * (values.ndim - 2)), 0, values) if bad.any() else values


def _place(doc: Document, view: Observable) -> ReadPlace:
    entry, port = view.place(doc)
    return entry.id, port


def _anything(doc: Document) -> ReadPlace:
    """Return the smallest port, to read where only the time is needed."""
    if not doc.entries:
        raise ParameterError("the model is empty, so there is nothing to run")
    return doc.entries[0].id, find.outputs(doc.entries[0])[0]
