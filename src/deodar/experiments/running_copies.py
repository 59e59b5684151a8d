"""Copies of a model that run in one batch, and the trials that they are, as actions access them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import jax
import numpy as np

from deodar.compiler.arguments import ProgramState
from deodar.compiler.copy_batch import Batch
from deodar.compiler.driven import driven
from deodar.compiler.dynamics import Dynamics
from deodar.errors import NotFinite
from deodar.experiments.running import RunningTrial, ScheduledAction
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.resolve import resolve
from deodar.numerics.pytree import PyTree
from deodar.parameters import real
from deodar.session import memory
from deodar.session.exchange import embodied
from deodar.session.keep import learned_states
from deodar.session.run import Run, host, require_step
from deodar.worlds._base import World
from deodar.worlds._pure import PureWorld

SHRINKS = 0.5
"""Share of running copies at which the batch is halved, so that few compiled programs serve every width."""

WORTH = 1e8
"""Number of samples of ports times steps that a smaller batch must save: compiling takes about half a second
(measured: 3 ns per sample).
"""


@dataclass
class RunningCopies:
    """Copies of a model that run in one batch, and their trials.

    Attributes:
        rows: for each copy, the index of its trial in `trials`.
        batch: the running copies.
        swept: for the path of each parameter in which trials differ, the present value in each trial.
        errors: for the row of each copy that diverged, the reason; its trial may have ended before.
    """

    model: Model
    doc: Document
    precision: str
    dt: float
    seed: int
    trials: Sequence[int]
    world: World | None
    swept: Mapping[str, np.ndarray]
    restarts: bool = False

    def __post_init__(self) -> None:
        self.rows: list[int] = list(range(len(self.trials)))
        self.errors: dict[int, NotFinite] = {}
        self.leaves = [driven(self.doc, path) for path in self.swept]
        self._cells = memory.copy_bytes(resolve(self.doc)[0], "float32") // 4
        self.batch = self._begin(self.rows)
        self._first = host(self.batch.state) if self.restarts else None

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
        fewer.state, fewer.keys = jax.tree.map(
            lambda a: np.asarray(a)[at], (self.batch.state, self.batch.keys)
        )
        fewer.shared = self.batch.shared
        fewer.clock = self.batch.clock
        fewer.lost = {(n,): self.batch.lost[k,] for n, k in enumerate(keep) if (k,) in self.batch.lost}
        self.rows, self.batch = [self.rows[k] for k in keep], fewer

    # ------------------------------------------------------------------------------- changes of single copies

    def set(self, row: int, path: str, value: float) -> None:
        """Give a swept parameter another value in one trial."""
        self.swept[path][row] = value
        given = [values[self.rows] for values in self.swept.values()]
        values = self.batch.values.copy()
        values["swept"] = self.batch.program.layout.points(given)
        self.batch.values = values

    def restart(self, row: int, keep_learned: bool) -> None:
        """Reset the states of all elements of one trial, those that were learned only if `keep_learned` is
        false.
        """
        assert self._first is not None
        k = self.rows.index(row)
        state = self.batch.state.copy()
        state["groups"], state["held"] = jax.tree.map(_writable, (state["groups"], state["held"]))
        learned = [(a, r, a[k, r].copy()) for a, r in self._learned(state, k)] if keep_learned else []
        first = self._first["groups"], self._first["held"]
        jax.tree.map(lambda now, begun: _put(now, k, begun[row]), (state["groups"], state["held"]), first)
        for values, r, kept in learned:
            values[k, r] = kept
        self.batch.state = state

    def _learned(self, state: ProgramState, copy: int) -> Iterator[tuple[Any, int]]:
        """Yield the arrays of learned states, and the row of the element in them."""
        elements = {e.id: e.element for e in self.doc.entries}
        for ident, (g, r) in self.batch.program.plan.row.items():
            if ident in elements:
                shown = {name: np.asarray(values[copy, r]) for name, values in state["groups"][g].items()}
                for name in learned_states(elements[ident], shown):
                    for part in (state["groups"][g], state["held"].get(str(g), {})):
                        if name in part:
                            yield part[name], r

    def put_world(self, row: int, arrays: Mapping[str, np.ndarray]) -> None:
        """Replace the arrays of the world of one trial."""
        keys: Any = self.batch.keys
        own = dict(keys["world"])
        for name, values in arrays.items():
            own[name] = _writable(own[name])
            own[name][self.rows.index(row)] = values
        self.batch.keys = {**keys, "world": own}

    def read(self, row: int, path: str) -> np.ndarray:
        """Return the present value of a port in one trial."""
        entry, port = find.shown(self.doc, path)
        found = self.batch.read([self.batch.program.port(entry.id, port)])[0]
        return np.array(found[self.rows.index(row)])

    # ----------------------------------------------------------------------------------------------- programs

    def _begin(self, rows: Sequence[int]) -> Run:
        """Return a run of some trials at its start: trials of one batch, or points of a sweep if parameters
        differ.
        """
        sweep, count, begun = tuple(map(tuple, self.leaves)), len(rows), len(self.trials)
        own = Batch(count, None, sweep, begun, own_noise=True)
        trials = [self.trials[r] for r in rows]
        numbers = [[trial] for trial in trials] if sweep else trials
        swept = [values[rows] for values in self.swept.values()] if sweep else None
        dynamics = Dynamics(self.model, self.doc, self.precision, body=embodied(self.doc, self.world))
        copies = own if sweep else Batch(None, count, begun=begun)
        run = Run(dynamics, copies, self.dt, self.seed, numbers, self.world, swept)
        run.tolerated = count
        return run


class CopyTrial(RunningTrial):
    """A trial that is one copy of a batch.

    Attributes:
        row: index of the trial in the batch.
    """

    def __init__(
        self,
        copies: RunningCopies,
        row: int,
        actions: Sequence[ScheduledAction],
        pushes: Mapping[Any, str],
    ) -> None:
        super().__init__(copies.trials[row], actions, copies.batch.clock.time, copies.dt, pushes)
        self._copies, self.row = copies, row
        self._doc: Document | None = None
        self._world: PureWorld | None = None

    @property
    def tick(self) -> int:
        return self._copies.batch.clock.tick

    @property
    def time(self) -> float:
        return self._copies.batch.clock.time

    @property
    def world(self) -> World | None:
        if self._world is None and isinstance(self._copies.world, PureWorld):
            self._world = self._copies.world.for_trial(self._copies.trials[self.row])
        return self._world

    @property
    def document(self) -> Document:
        """The document with the parameters of this trial."""
        if self._doc is None:
            self._doc = self._copies.doc
            for path, values in self._copies.swept.items():
                self._doc = edit.change(self._doc, path, float(values[self.row]))
        return self._doc

    def get(self, path: str) -> Any:
        return find.value(self.document, path)

    def set(self, path: str, value: Any) -> None:
        changed = edit.change(self.document, path, value)
        require_step(changed, self.dt)
        self._doc = changed
        number = real(value)
        assert number is not None
        self._copies.set(self.row, path, number)

    def read(self, path: str) -> np.ndarray:
        return self._copies.read(self.row, path)

    def restart(self, keep_learned: bool) -> None:
        self._copies.restart(self.row, keep_learned)

    def _world_changed(self) -> None:
        assert self._world is not None
        self._copies.put_world(self.row, self._world.own_values(self._copies.trials[self.row]))


def _writable(values: Any) -> np.ndarray:
    """Return an array of the host that may be changed: this one, if it is one, else a copy."""
    return values if isinstance(values, np.ndarray) and values.flags.writeable else np.array(values)


def _put(values: np.ndarray, copy: int, new: PyTree) -> None:
    values[copy] = new
