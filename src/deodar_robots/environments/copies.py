"""Copies of a closed loop that advance together: in one compiled step, or one copy in a world on the host."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import jax
import numpy as np

from deodar.compiler.copy_batch import Batch
from deodar.compiler.driven import driven
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.executable import BEGUN, RARELY
from deodar.experiments.field_reader import ReadPlace, with_readers
from deodar.experiments.observable import Observable
from deodar.model import find
from deodar.model.resolve import resolve
from deodar.session import memory
from deodar.session.exchange import embodied
from deodar.session.port_reader import port_reader
from deodar.session.run import Run
from deodar.session.session import Session
from deodar_robots.environments.loop import ClosedLoop

PortValues = Mapping[ReadPlace, np.ndarray]
"""The values of ports, with copies first."""


class LoopCopies(Protocol):
    """Copies of a loop, each in an episode of its own."""

    def begin(self, seed: int, trials: Sequence[int]) -> PortValues:
        """Begin an episode in each copy, at time 0, and return the values of its start."""
        ...

    def restart(self, ended: np.ndarray, trials: Sequence[int]) -> PortValues:
        """Begin another episode in some copies, and return the values of all.

        Args:
            ended: which copies begin another episode; the others keep theirs.
            trials: the trial of the next episode of each copy.
        """
        ...

    def step(self, actions: np.ndarray) -> PortValues:
        """Set the parameters, (copies, parameters), advance by a period, and return the values after it."""
        ...

    def views(self, values: PortValues) -> dict[Observable, np.ndarray]:
        """Return what the events look at, (copies, 1, ...)."""
        ...


@dataclass(frozen=True)
class _Starts:
    """State and keys of each copy at the start of a trial."""

    trials: tuple[int, ...]
    state: Any
    keys: Any


class StepCopies:
    """Copies of a loop inside one compiled step, with their worlds.

    All copies count the same ticks. The time of each copy begins with its episode (`Batch.restarts`); its
    noise is that of its trial, at the ticks of the batch. In the first episode, which begins at tick 0, it is
    that of a run of the trial.
    """

    def __init__(self, loop: ClosedLoop, copies: int) -> None:
        self.loop, self.count = loop, copies
        model = loop.model
        self._doc, self._at = with_readers(model.document, loop.views)
        self._places = _places(loop, self._doc, self._at)
        memory.require(resolve(self._doc)[0], loop.precision, copies, 0)
        leaves = tuple(tuple(driven(self._doc, path)) for path in loop.act)
        self._first = [np.full(copies, float(find.value(self._doc, path))) for path in loop.act]
        batch = Batch(copies, None, leaves, restarts=True)
        body = embodied(self._doc, loop.world)
        program = Dynamics(model, self._doc, loop.precision, body=body).compiled(batch)
        self._run = Run(program, self._doc, loop.dt, loop.seed, [0], loop.world, self._first)
        given = self._run.values, np.uint32(0), np.zeros(copies, np.uint32)
        own = {**dict.fromkeys(self._run.values), "swept": tuple(0 for _ in self._run.values["swept"])}
        # points of a sweep share the noise of one trial; these have one each
        each = jax.vmap(program.program.init, in_axes=(own, None, 0))
        self._init, _ = program.compile(each, *given, options=RARELY)
        self._ports = [program.port(*place) for place in self._places]
        self._axes = {place: program.axes(program.port(*place)) for place in self._places}
        self._swept = self._first
        self._starts = _Starts((), {}, {})

    def begin(self, seed: int, trials: Sequence[int]) -> PortValues:
        run = self._run
        run.seed = seed
        run.reset()
        self._swept = [values.copy() for values in self._first]
        self._put()
        self._starts = _Starts((), {}, {})
        begun = self._start(trials)
        run.state, run.keys = begun.state, begun.keys
        return self._read()

    def restart(self, ended: np.ndarray, trials: Sequence[int]) -> PortValues:
        run, rows = self._run, np.flatnonzero(ended)
        for now, first in zip(self._swept, self._first, strict=True):
            now[rows] = first[rows]
        self._put()
        if not self._starts.trials or any(self._starts.trials[r] != trials[r] for r in rows.tolist()):
            # of all copies at once: each of the others takes its own when its episode ends
            self._starts = self._start(trials)
        begun = self._starts

        def taken(now: Any, start: Any) -> np.ndarray:
            found = np.array(now)
            found[rows] = start[rows]
            return found

        begun.keys[BEGUN][rows] = run.clock.tick % 2**32
        run.state, run.keys = jax.tree.map(taken, (run.state, run.keys), (begun.state, begun.keys))
        return self._read()

    def step(self, actions: np.ndarray) -> PortValues:
        self._swept = [np.array(column, float) for column in actions.T]
        self._put()
        found: list[np.ndarray] = []

        def take(_: int, arrays: Sequence[np.ndarray]) -> None:
            found.extend(np.array(values[:, -1]) for values in arrays)

        steps = self.loop.steps
        self._run.record(steps, self._ports, steps, 1, take, most=1)
        return dict(zip(self._places, found, strict=True))

    def views(self, values: PortValues) -> dict[Observable, np.ndarray]:
        out: dict[Observable, np.ndarray] = {}
        for view in self.loop.views:
            place = self._at.get(view) or _place(self.loop, view)
            now = values[place][:, None]
            out[view] = view.given(now) if view in self._at else view.seen(now, self._axes[place], 2)
        return out

    def _put(self) -> None:
        values = self._run.values.copy()
        values["swept"] = self._run.program.layout.points(self._swept)
        self._run.values = values

    def _read(self) -> PortValues:
        return dict(zip(self._places, map(np.array, self._run.read(self._ports)), strict=True))

    def _start(self, trials: Sequence[int]) -> _Starts:
        """Return all copies at the start of these trials, at the present tick."""
        run = self._run
        values = run.values.copy()
        values["swept"] = run.program.layout.points(self._first)
        state, keys = run.program.call(self._init, values, np.uint32(run.seed), np.asarray(trials, np.uint32))
        if run.exchange.inside:
            assert self.loop.world is not None
            self.loop.world.reset(run.seed, list(trials), self.loop.precision)
            run.shared, state, keys = run.program.embodied(self.loop.world, state, keys)
        begun = np.full(self.count, run.clock.tick % 2**32, np.uint32)
        return _Starts(tuple(trials), *jax.tree.map(np.asarray, (state, {**keys, BEGUN: begun})))


class HostCopy:
    """One copy of a loop in a world that is computed on the host: a session for each episode."""

    count = 1

    def __init__(self, loop: ClosedLoop) -> None:
        self.loop = loop
        self._places = _places(loop, loop.model.document, {})
        self._session = self._begun(loop.seed, 0)
        self._reader = port_reader(self._session.program, self._places)
        self._axes = {
            place: self._session.program.axes(self._session.program.port(*place)) for place in self._places
        }

    def begin(self, seed: int, trials: Sequence[int]) -> PortValues:
        self._session = self._begun(seed, trials[0])
        return self._read()

    def restart(self, ended: np.ndarray, trials: Sequence[int]) -> PortValues:
        return self.begin(self._session.seed, trials) if ended[0] else self._read()

    def step(self, actions: np.ndarray) -> PortValues:
        self._session.set(dict(zip(self.loop.act, actions[0].tolist(), strict=True)))
        self._session.step(self.loop.steps)
        return self._read()

    def views(self, values: PortValues) -> dict[Observable, np.ndarray]:
        places = {view: _place(self.loop, view) for view in self.loop.views}
        return {v: v.seen(values[place][:, None], self._axes[place], 2) for v, place in places.items()}

    def _begun(self, seed: int, trial: int) -> Session:
        of = self.loop
        return Session(of.model, of.dt, seed, of.precision, of.world, trial)

    def _read(self) -> PortValues:
        if self._reader.program is not self._session.program:
            self._reader = port_reader(self._session.program, self._places)
        arrays = self._session.read_ports(self._reader, self._places)
        return {place: np.array(arrays[place])[None] for place in self._places}


def _places(loop: ClosedLoop, doc: Any, at: Mapping[Observable, ReadPlace]) -> list[ReadPlace]:
    """Return all ports to read, each once."""
    seen = [(ident, port) for ident, port, _ in loop.see.values()]
    rewarded = [] if loop.rewarded is None else [loop.rewarded]
    return list(dict.fromkeys([*seen, *rewarded, *(at.get(v) or _place(loop, v) for v in loop.views)]))


def _place(loop: ClosedLoop, view: Observable) -> ReadPlace:
    entry, port = view.place(loop.model.document)
    return entry.id, port
