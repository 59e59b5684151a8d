"""Run many trials of one model as one batch, whose width shrinks as trials end."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import jax
import numpy as np

from deodar.batch.driven import driven
from deodar.compiler.executable import RARELY, Batch, Executable, executable
from deodar.compiler.plan import Leaf
from deodar.errors import NotFinite, ParameterError, RunWarning, TimeError, WorldError
from deodar.experiments.events import Event
from deodar.experiments.measures import BaseMeasure
from deodar.experiments.observable import Observable
from deodar.experiments.observations import DIVERGED, Observations
from deodar.experiments.reader import ReadPlace, with_readers
from deodar.experiments.trial import Trial
from deodar.model import find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.resolve import resolve
from deodar.session import agreement, memory
from deodar.session.exchange import embodied
from deodar.session.run import Run, whole
from deodar.session.session import require_model, require_seed
from deodar.worlds._base import World

LOOKS = 24
"""Number of sampling times per call of the program.

The steps of a trial after its end are discarded: on average half of a call.
"""

SHRINKS = 0.5
"""Share of running copies at which the batch is halved, so that few compiled programs serve every width."""

WORTH = 1e8
"""Number of samples of ports times steps that a smaller batch must save: compiling takes about half a second
(measured: 3 ns per sample).
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
) -> list[Trial]:
    """Run trials in one batch; the result of each equals that of `run_trial` up to rounding.

    When half of the copies have ended, the others continue in a batch of half the width: always in a world,
    otherwise where this saves more time than compiling takes. The widths follow from the trials alone, so the
    same call gives the same bits each time. Beside other trials the widths may differ: activations then agree
    same call gives the same bits each time. In a batch with other trials the widths may differ: activations
    then agree to 1e-4 in float32 and to 1e-10 in float64, until the model amplifies the difference. A world
    is computed inside the step, so each trial has its own; values of sensors of the world are read from the
    model's sensors. The reduction of a field for events and measures (for example its maximum) is computed
    inside the step too; only watched ports are copied whole.

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
        values: for parameter paths the value of each trial; not together with a world.
        measures: the measures of each trial.
        tolerant: return the results although all trials diverge, and do not warn.
        watched: the trials whose values of `watch` are returned; none: all.

    Returns:
        The result of each trial. One that diverges before it ends has the outcome `diverged` and an `error`
        with the reason; its values are NaN, its events and measures None. The others are not affected. A
        `RunWarning` counts those that diverged.

    Raises:
        NotFinite: all trials diverge.
    """
    doc = require_model(model).document
    step = doc.step if dt is None else dt
    steps, gap = whole(limit, step, "the limit"), 1 if every is None else whole(every, step, "every")
    if gap == 0:
        raise TimeError("every is 0; expected at least one step")
    numbers = [require_seed(t) for t in trials]
    if not numbers or len(set(numbers)) < len(numbers):
        raise ParameterError(f"expected trial numbers, each of them once, not {list(trials)}")
    observed = Observations(events, measures, len(numbers))
    views = list(dict.fromkeys([*(v for e in events for v in e.views), *(m.view for m in measures)]))
    ports = [(entry.id, port) for entry, port in (find.shown(doc, name) for name in watch)]
    if world is not None and embodied(doc, world) is None:
        raise WorldError(
            f"the world {type(world).__name__} cannot be computed for a batch of copies",
            fix="Run them one by one: dd.run_trial(...)",
        )
    agreement.warn(doc, world, stacklevel=2)
    if world is not None and values:
        raise WorldError(
            "trials in a world have the same parameters in one batch",
            fix="Run the trials of each value separately",
        )
    read, at = with_readers(doc, views)
    places = {view: at.get(view) or _place(doc, view) for view in views}
    order = list(dict.fromkeys([*ports, *places.values()])) or [_anything(doc)]
    swept = {path: np.asarray(v, float) for path, v in (values or {}).items()}
    leaves = [driven(doc, path) for path in swept]
    copies = _RunningCopies(
        model, read, precision, float(step), require_seed(seed), numbers, world, leaves, [*swept.values()]
    )
    axes = {p: copies.batch.program.axes(copies.batch.program.port(*p)) for p in order}
    kept: list[list[Sequence[np.ndarray]]] = [[] for _ in numbers]
    wanted = [row for row, number in enumerate(numbers) if watched is None or number in watched]
    looks = np.zeros(len(numbers), int)
    times: list[float] = []

    def take(first: int, arrays: Sequence[np.ndarray]) -> None:
        """Take the samples after `first` steps and each `gap` more: (trials, sampling times, ...)."""
        ticks = [min(first + n * gap, steps) for n in range(arrays[0].shape[1])]
        new = [doc.t0 + tick * float(step) for tick in ticks]
        times.extend(new)
        good = copies.good(np.asarray(ticks))
        by = {p: _blank(a, good) for p, a in zip(order, arrays, strict=True)}
        seen = {v: v.given(by[p]) if v in at else v.seen(by[p], axes[p], 2) for v, p in places.items()}
        counts = observed.take(copies.rows, np.asarray(new), seen, ticks[-1] == steps, good)
        looks[copies.rows] += counts
        for k, n in enumerate(counts):
            if ports and n and copies.rows[k] in wanted:
                kept[copies.rows[k]].append([np.array(by[p][k, :n]) for p in ports])

    ahead = 0
    while True:
        begun = copies.batch.clock.tick
        read_ports = [copies.batch.program.port(*p) for p in order]
        first = min(gap, ahead)
        copies.batch.record(
            ahead, read_ports, first, gap, lambda k, seen, at=begun + first: take(at + k * gap, seen)
        )
        running = [k for k, row in enumerate(copies.rows) if not observed.outcome[row]]
        if between is not None:
            between(len(running))
        if not running:
            break
        left = steps - copies.batch.clock.tick
        copies.shrink(running, left)
        ahead = min(LOOKS * gap, left - left % gap if left >= gap else left)
    out: list[Trial] = []
    for row, n in enumerate(looks):
        found = np.asarray(times[:n])
        error = copies.errors[row] if observed.outcome[row] == DIVERGED else None
        whole_ = {
            name: np.concatenate([part[i] for part in kept[row]])
            for i, name in enumerate(watch if row in wanted else ())
        }
        whole_ = (
            whole_
            if error is None
            else {name: np.full_like(values, np.nan) for name, values in whole_.items()}
        )
        out.append(
            Trial(
                found,
                whole_,
                observed.events_of(row),
                observed.outcome[row],
                observed.measures_of(row, {view: axes[p] for view, p in places.items()}),
                found,
                error=error,
            )
        )
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


@dataclass
class _RunningCopies:
    """Copies of a model that run in one batch, and their trials.

    Attributes:
        rows: for each copy, the index of its trial in `trials`.
        batch: the running copies.
        errors: for the row of each copy that diverged, the reason; its trial may have ended before.
    """

    model: Model
    doc: Document
    precision: str
    dt: float
    seed: int
    trials: Sequence[int]
    world: World | None
    leaves: Sequence[Sequence[Leaf]]
    swept: Sequence[np.ndarray]

    def __post_init__(self) -> None:
        self.rows: list[int] = list(range(len(self.trials)))
        self.errors: dict[int, NotFinite] = {}
        self._cells = memory.copy_bytes(resolve(self.doc)[0], "float32") // 4
        self.batch = self._begin(self.rows)
        if self.leaves:
            self.batch.state, self.batch.keys = self._start(self.batch.program, self.batch.values)

    def good(self, ticks: np.ndarray) -> np.ndarray:
        """Return for each copy how many of these ticks, in ascending order, come before it diverged."""
        out = np.full(len(self.rows), len(ticks))
        for (k, *_), error in self.batch.lost.items():
            self.errors[self.rows[k]] = error
            out[k] = np.searchsorted(ticks, error.step)
        return out

    def shrink(self, running: Sequence[int], left: int) -> None:
        """Halve the batch while the running copies fit and the remaining steps save more time than compiling
        takes.

        Some copies that have ended stay, to fill the batch.
        """
        size = len(self.rows)
        while len(running) <= SHRINKS * size:
            size = (size + 1) // 2
            if size == 1:
                break
        saved = (len(self.rows) - size) * self._cells * left
        if size == len(self.rows) or (self.world is None and saved < WORTH):
            return
        ended = [k for k in range(len(self.rows)) if k not in set(running)]
        keep = sorted([*running, *ended[: size - len(running)]])
        fewer = self._begin([self.rows[k] for k in keep])
        at = np.asarray(keep)
        fewer.state = jax.tree.map(lambda a: np.asarray(a)[at], self.batch.state)
        if self.leaves:
            fewer.keys = jax.tree.map(lambda a: np.asarray(a)[at], self.batch.keys)
        fewer.clock = self.batch.clock
        fewer.lost = {(n,): self.batch.lost[k,] for n, k in enumerate(keep) if (k,) in self.batch.lost}
        self.rows, self.batch = [self.rows[k] for k in keep], fewer

    def _begin(self, rows: Sequence[int]) -> Run:
        """Return a run of some trials at its start: trials of one batch, or points of a sweep if parameters
        differ.
        """
        sweep = tuple(map(tuple, self.leaves))
        copies = Batch(len(rows), None, sweep) if sweep else Batch(None, len(rows))
        program = executable(
            self.model, self.doc, self.precision, copies, body=embodied(self.doc, self.world)
        )
        trials = [self.trials[r] for r in rows]
        if self.leaves:
            run = Run(
                program,
                self.doc,
                self.dt,
                self.seed,
                trials[:1],
                None,
                [values[rows] for values in self.swept],
            )
        else:
            run = Run(program, self.doc, self.dt, self.seed, trials, self.world)
        run.tolerated = len(rows)
        return run

    def _start(self, program: Executable, values: Any) -> tuple[Any, Any]:
        """Return state and noise keys at the start of points that are separate trials: points of a sweep
        share the noise of one.
        """
        own = {**dict.fromkeys(values), "swept": tuple(0 for _ in values["swept"])}
        many = jax.vmap(program.program.init, in_axes=(own, None, 0))
        given = values, np.uint32(self.seed), np.asarray(self.trials, np.uint32)
        start, _ = program.compile(many, *given, options=RARELY)
        return program.call(start, *given)
