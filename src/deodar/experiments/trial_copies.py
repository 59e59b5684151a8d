"""The copies of a model that are the trials of one call: a batch, or one beside a world on the host."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import jax
import numpy as np

from deodar.compiler.copy_batch import Batch
from deodar.compiler.driven import driven
from deodar.compiler.dynamics import Dynamics
from deodar.errors import NotFinite, ParameterError
from deodar.experiments.field_reader import ReadPlace
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.unit import unit_seconds
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import real
from deodar.session import memory
from deodar.session.adopt import adopt
from deodar.session.carry import nodes_of, put_rows, put_states
from deodar.session.keep import put_learned, with_learned
from deodar.session.run import Run, host, require_step
from deodar.session.session_snapshot import rows
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar.worlds._pure import PureWorld

SHRINKS = 0.5
"""Share of running copies at which the batch is halved, so that few compiled programs serve every width."""

WORTH = 1e8
"""Number of samples of ports times steps that a smaller batch must save: compiling takes about half a second
(measured: 3 ns per sample).
"""

WORLD = ""
"""In the place of an element: a sensor of a world on the host, which is read beside the model."""

TakeSamples = Callable[[int, Sequence[np.ndarray]], None]
"""Function of the number of a sample, and of the values of places from that sample on, (copies, samples,
...).
"""


@dc.dataclass(frozen=True)
class Numbered:
    """The trials of a call.

    Attributes:
        seed: seed of all noise.
        trials: number of each trial of the seed.
        swept: for the path of each parameter in which trials differ, or that actions change, its value in
            each trial.
    """

    seed: int
    trials: Sequence[int]
    swept: Mapping[str, np.ndarray] = dc.field(default_factory=dict[str, np.ndarray])


class TrialCopies:
    """The copies of a model that are the trials of one call.

    In a batch each has its world inside the step, parameters in which it differs, and may diverge without the
    others; the batch shrinks as trials end. Beside a world on the host, `alone`, there is one copy, of which
    any parameter may change.

    Attributes:
        run: the running copies.
        rows: for each copy, the index of its trial in `trials`.
        trials: the numbers of the trials.
        swept: for the path of each parameter in which trials differ, the present value in each trial.
        errors: for the row of each copy that diverged, the reason; its trial may have ended before.
    """

    def __init__(
        self, dynamics: Dynamics, dt: float, numbered: Numbered, world: World | None, alone: bool
    ) -> None:
        self.dynamics, self.dt, self.world, self.alone = dynamics, dt, world, alone
        self.seed, self.trials = numbered.seed, numbered.trials
        self.swept = {path: np.array(values, float) for path, values in numbered.swept.items()}
        self.rows = list(range(len(self.trials)))
        self.errors: dict[int, NotFinite] = {}
        self._documents: dict[int, Document] = {}
        self._worlds: dict[int, PureWorld] = {}
        leaves = tuple(tuple(driven(dynamics.doc, path)) for path in self.swept)
        self._batch = Batch(sweep=leaves, begun=len(self.rows), own_noise=bool(leaves))
        self.run = self._begun(self.rows)

    def _begun(self, copies: Sequence[int]) -> Run:
        """Return a run of some trials at its start: trials of one batch, or points of a sweep if parameters
        differ.
        """
        trials, count = [self.trials[row] for row in copies], len(copies)
        if self.alone:
            return Run(self.dynamics, Batch(), self.dt, self.seed, trials, self.world)
        if self.swept:
            batch, numbers = dc.replace(self._batch, points=count), [[trial] for trial in trials]
        else:
            batch, numbers = dc.replace(self._batch, trials=count), trials
        columns = [values[copies] for values in self.swept.values()] if self.swept else None
        run = Run(self.dynamics, batch, self.dt, self.seed, numbers, self.world, columns)
        run.tolerated = count
        return run

    # ------------------------------------------------------------------------------------ running and reading

    def record(
        self, steps: int, places: Sequence[ReadPlace], first: int, gap: int, take: TakeSamples
    ) -> None:
        """Advance by some steps; take samples after the first `first` of them, then after each `gap`.

        One copy alone is read between its steps, so that a world on the host is at the time of the sample. If
        it diverges, it stays where it was, and `errors` has the reason.
        """
        if not self.alone:
            self.run.record(steps, self._ports(places), first, gap, take)
            return
        done = 0
        try:
            for k, at in enumerate(range(first, steps + 1, gap)):
                self.run.advance(at - done)
                done = at
                take(k, self._read(places))
            self.run.advance(steps - done)
        except NotFinite as error:
            self.errors[0] = error

    def _read(self, places: Sequence[ReadPlace]) -> list[np.ndarray]:
        """Return one sample of the one copy, (1, 1, ...)."""
        ports = self._ports([place for place in places if place[0] != WORLD])
        self.run.sense()
        values = [np.asarray(a) for a in self.run.read(ports)] if ports else []
        # the output of a coupling may be infinite although all states are finite
        self.run.require_finite(ports, [a[None] for a in values], 1)
        sensed = self._sensed([name for ident, name in places if ident == WORLD])
        unread = iter(values)
        return [
            np.array(sensed[name] if ident == WORLD else next(unread))[None, None] for ident, name in places
        ]

    def _sensed(self, names: Sequence[str]) -> dict[str, np.ndarray]:
        world = self.world
        if world is None or not names:
            return {}
        requests = [(name, axes_of(world, name)) for name in names]
        moment = self.run.clock.time * unit_seconds(self.run.doc.time_unit) * 1e3
        with errors_of(world, "sense"):
            readings = world.sense_all(requests, moment)
        return {
            name: np.array(reading[0] if world.sensors[name].each else reading)
            for name, reading in zip(names, readings, strict=True)
        }

    def _ports(self, places: Sequence[ReadPlace]) -> list[Any]:
        return [self.run.program.port(*place) for place in places]

    def good(self, ticks: np.ndarray) -> np.ndarray:
        """Return for each copy how many of these ticks, in ascending order, come before it diverged."""
        out = np.full(len(self.rows), len(ticks))
        for (k, *_), error in self.run.lost.items():
            self.errors[self.rows[k]] = error
            out[k] = np.searchsorted(ticks, error.step)
        return out

    def shrink(self, running: Sequence[int], steps_left: int) -> None:
        """Halve the batch while the running copies fit and the remaining steps save more time than compiling
        takes.

        Some copies that have ended stay, to fill the batch.
        """
        size = len(self.rows)
        while len(running) <= SHRINKS * size:
            size = (size + 1) // 2
            if size == 1:
                break
        if size == len(self.rows):
            return
        cells = memory.copy_bytes(graph(self.run.doc).nodes, "float32") // 4
        if self.world is None and (len(self.rows) - size) * cells * steps_left < WORTH:
            return
        ended = [k for k in range(len(self.rows)) if k not in set(running)]
        keep = sorted([*running, *ended[: size - len(running)]])
        fewer, before, at = self._begun([self.rows[k] for k in keep]), self.run, np.asarray(keep)
        fewer.state, fewer.keys = jax.tree.map(lambda a: np.asarray(a)[at], (before.state, before.keys))
        fewer.shared, fewer.clock = before.shared, before.clock
        fewer.lost = {(n,): before.lost[k,] for n, k in enumerate(keep) if (k,) in before.lost}
        self.rows, self.run = [self.rows[k] for k in keep], fewer

    # --------------------------------------------------------------------------------------------- one trial

    def document(self, row: int) -> Document:
        """Return the document with the present parameters of a trial."""
        if self.alone:
            return self.run.doc
        if row not in self._documents:
            doc = self.dynamics.doc
            for path, values in self.swept.items():
                doc = edit.change(doc, path, float(values[row]))
            self._documents[row] = doc
        return self._documents[row]

    def set(self, row: int, path: str, value: Any) -> None:
        """Give a parameter another value in one trial; in a batch one of `swept`."""
        changed = edit.change(self.document(row), path, value)
        if self.alone:
            adopt(self.run, changed, (self.dt,))
            return
        require_step(changed, self.dt)
        self._documents[row] = changed
        number = real(value)
        assert number is not None
        self.swept[path][row] = number
        self.run.sweep([values[self.rows] for values in self.swept.values()])

    def read(self, row: int, path: str) -> np.ndarray:
        """Return the present value of a port in one trial."""
        entry, port = find.shown(self.run.doc, path)
        values = self.run.read(self._ports([(entry.id, port)]))[0]
        return np.array(values if self.alone else values[self.rows.index(row)])

    def keep_start(self) -> None:
        """Store the present states, for `restart`."""
        self._start = self.run.program, host(self.run.state)

    def restart(self, row: int, keep_learned: bool) -> None:
        """Reset the states of all elements of one trial to those of `keep_start`; states that were learned
        only if `keep_learned` is false.
        """
        run = self.run
        first = () if self.alone else (row,)
        states, before = rows(*self._start, first), nodes_of(self._start[0])
        if self.alone:
            learned_rows = rows(run.program, host(run.state)) if keep_learned else {}
            put_states(run, states, before)
            if keep_learned:
                put_learned(run, learned_rows)
            return
        state, copy = run.state.copy(), (self.rows.index(row),)
        state["groups"], state["held"] = jax.tree.map(_writable, (state["groups"], state["held"]))
        if keep_learned:
            states = with_learned(run.doc, rows(run.program, state, copy), states)
        put_rows(run.program, state, states, before, copy)
        run.state = state

    def world_of(self, row: int) -> World | None:
        """Return the world of a trial, which actions change."""
        if self.alone or not isinstance(self.world, PureWorld):
            return self.world
        if row not in self._worlds:
            self._worlds[row] = self.world.for_trial(self.trials[row])
        return self._worlds[row]

    def use_world(self, row: int) -> None:
        """Use the changed objects of the world of a trial from now on."""
        if self.alone:
            return
        keys: Any = self.run.keys
        arrays = dict(keys["world"])
        for name, values in self._worlds[row].own_values(self.trials[row]).items():
            arrays[name] = _writable(arrays[name])
            arrays[name][self.rows.index(row)] = values
        self.run.keys = {**keys, "world": arrays}


def axes_of(world: World, name: str) -> Axes:
    """Return axes for a sensor of a world on the host.

    Raises:
        ParameterError: a model states the axes.
    """
    shape = world.sensors[name].shape
    if shape is None:
        raise ParameterError(
            "is sampled over axes that a model states",
            where=name,
            fix="Watch the port of a Sensor that reads it",
        )
    return tuple(Axis(f"of {k}", 0.0, float(max(n - 1, 1)), n) for k, n in enumerate(shape))


def _writable(values: Any) -> np.ndarray:
    """Return an array of the host that may be changed: this one, if it is one, else a copy."""
    return values if isinstance(values, np.ndarray) and values.flags.writeable else np.array(values)
