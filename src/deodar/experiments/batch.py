"""Many trials of one model as one batch, which those that have ended leave."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import jax
import numpy as np

from deodar.compiler.executable import Batch, executable
from deodar.errors import ParameterError, TimeError, WorldError
from deodar.experiments.course import Course, Notes
from deodar.experiments.events import Event
from deodar.experiments.run import require
from deodar.model import find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.runtime.exchange import embodied
from deodar.runtime.run import Run, whole
from deodar.runtime.session import require_model, require_seed
from deodar.worlds._base import World

LOOKS = 24
"""Looks that are taken in one call of the program. What a trial does after it has ended is thrown away: on average half of them."""

SHRINKS = 0.5
"""Share of the copies below which those that have ended leave: each size of a batch is a program of its own, which has to be compiled."""


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
) -> list[Course]:
    """Run trials all at once; the course of each is that of `run` but for rounding.

    When half of the copies have ended, the rest goes on in a batch of its own size. The same trials in one call give the same bits each time.
    A world is computed inside the step, so each trial has its own; sensors of the world are looked at through the model's own.

    Args:
        model: the model, as it now is.
        limit: document time after which each trial ends at the latest.
        trials: which trials of the seed.
        watch: paths of ports to look at, besides those that events need.
        events: what may happen; those that `ends` says end a trial.
        seed: seed of all noise.
        world: what the model's sensors read and its motors move, one of pure functions such as an arena; of starts and goals given for each
            trial each takes its own.
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
    if world is not None and embodied(doc, world) is None:
        raise WorldError(f"the world {type(world).__name__} cannot be computed for a batch of copies", fix="Run the trials one by one: run(...)")
    batch = _copies(model, doc, precision, float(step), require_seed(seed), numbers, world)
    notes = {t: Notes(events) for t in numbers}

    def take(first: int, seen: Sequence[np.ndarray]) -> None:
        """Looks after `first` steps and each `gap` more: (trials, looks, ...)."""
        for n in range(seen[0].shape[1]):
            tick = min(first + n * gap, steps)
            for k, t in enumerate(batch.trials):
                if not notes[t].outcome:
                    look = {name: np.array(values[k, n]) for name, values in zip(wanted, seen, strict=True)}
                    notes[t].take(doc.t0 + tick * float(step), look, tick == steps)

    ahead = 0
    while True:
        begun = batch.clock.tick
        ports = [batch.program.port(entry.id, port) for entry, port in places]
        first = min(gap, ahead)
        batch.record(ahead, ports, first, gap, lambda k, seen, at=begun + first: take(at + k * gap, seen))
        running = [k for k, t in enumerate(batch.trials) if not notes[t].outcome]
        if between is not None:
            between(len(running))
        if not running:
            break
        if len(running) <= SHRINKS * len(batch.trials):
            batch = _fewer(model, batch, running)
        left = steps - batch.clock.tick
        ahead = min(LOOKS * gap, left - left % gap if left >= gap else left)
    return [notes[t].course(wanted) for t in numbers]


def _copies(model: Model, doc: Document, precision: str, dt: float, seed: int, trials: Sequence[int], world: World | None) -> Run:
    program = executable(model, doc, precision, Batch(None, len(trials)), body=embodied(doc, world))
    return Run(program, doc, dt, seed, trials, world)


def _fewer(model: Model, batch: Run, keep: Sequence[int]) -> Run:
    """The run of some of its copies, at the same moment. Noise belongs to trials, so it goes on as it would have."""
    fewer = _copies(model, batch.doc, batch.program.precision, batch.clock.dt, batch.seed, [batch.trials[k] for k in keep], batch.world)
    at = np.asarray(keep)
    fewer.state = jax.tree.map(lambda a: np.asarray(a)[at], batch.state)
    fewer.clock = batch.clock
    return fewer
