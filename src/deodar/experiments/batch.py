"""Many trials of one model as one batch, which those that have ended leave."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import jax
import numpy as np

from deodar.compiler.executable import Batch, executable
from deodar.errors import ParameterError, TimeError
from deodar.experiments.course import Course, Notes
from deodar.experiments.events import Event
from deodar.experiments.run import require
from deodar.model import find
from deodar.model.model import Model
from deodar.runtime.run import Run, whole
from deodar.runtime.session import require_model, require_seed

SHRINKS = 0.5
"""Share of the copies below which those that have ended leave: each size of a batch is a program of its own, which has to be compiled."""


def run_batch(
    model: Model,
    limit: float,
    trials: Sequence[int],
    watch: Sequence[str] = (),
    events: Sequence[Event] = (),
    seed: int = 0,
    every: float | None = None,
    dt: float | None = None,
    precision: str = "float32",
    between: Callable[[int], None] | None = None,
) -> list[Course]:
    """Run trials of a model that needs no world, all at once; the course of each is that of `run` but for rounding.

    When half of the copies have ended, the rest goes on in a batch of its own size. The same trials in one call give the same bits each time.

    Args:
        model: the model, as it now is.
        limit: document time after which each trial ends at the latest.
        trials: which trials of the seed.
        watch: paths of ports to look at, besides those that events need.
        events: what may happen; those that `ends` says end a trial.
        seed: seed of all noise.
        every: document time between looks; none: dt.
        dt: Euler step; none: the document's own.
        precision: float32 or float64.
        between: told after each look how many trials still run.
    """
    doc = require_model(model).document
    step = doc.step if dt is None else dt
    steps, gap = whole(limit, step, "the limit"), 1 if every is None else whole(every, step, "every")
    if gap == 0:
        raise TimeError("every is 0; it is at least one step")
    numbers = [require_seed(t) for t in trials]
    if not numbers or len(set(numbers)) < len(numbers):
        raise ParameterError(f"trials are numbers, each of them once, not {list(trials)}")
    require(events)
    wanted = list(dict.fromkeys([*watch, *(name for e in events for name in e.needs)]))
    if not wanted:
        raise ParameterError("there is nothing to look at", fix="Name ports to watch, or give events")
    places = [find.port(doc, name) for name in wanted]
    batch = Run(executable(model, doc, precision, Batch(None, len(numbers))), doc, float(step), require_seed(seed), numbers, None)
    notes = {t: Notes(events) for t in numbers}
    while True:
        running = [t for t in batch.trials if not notes[t].outcome]
        if len(running) <= SHRINKS * len(batch.trials) and running:
            batch = _fewer(model, batch, [k for k, t in enumerate(batch.trials) if not notes[t].outcome])
        seen = batch.read([batch.program.port(entry.id, port) for entry, port in places])
        for k, t in enumerate(batch.trials):
            if not notes[t].outcome:
                look = {name: np.array(values[k]) for name, values in zip(wanted, seen, strict=True)}
                notes[t].take(batch.clock.time, look, batch.clock.tick >= steps)
        left = sum(not note.outcome for note in notes.values())
        if between is not None:
            between(left)
        if not left:
            break
        batch.advance(min(gap, steps - batch.clock.tick))
    return [notes[t].course(wanted) for t in numbers]


def _fewer(model: Model, batch: Run, keep: Sequence[int]) -> Run:
    """The run of some of its copies, at the same moment. Noise belongs to trials, so it goes on as it would have."""
    program = executable(model, batch.doc, batch.program.precision, Batch(None, len(keep)))
    fewer = Run(program, batch.doc, batch.clock.dt, batch.seed, [batch.trials[k] for k in keep], None)
    at = np.asarray(keep)
    fewer.state = jax.tree.map(lambda a: np.asarray(a)[at], batch.state)
    fewer.clock = batch.clock
    return fewer
