"""Copies of a closed loop that advance together: in one compiled step, or one copy in a world on the host."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from deodar.compiler.build import Build
from deodar.compiler.copy_batch import Batch
from deodar.compiler.driven import driven
from deodar.compiler.dynamics import Dynamics
from deodar.experiments.field_reader import ReadPlace, with_readers
from deodar.experiments.observable import Observable
from deodar.model import find
from deodar.model.document_graph import graph
from deodar.session import agreement, memory
from deodar.session.exchange import embodied
from deodar.session.run import Run
from deodar_robots.environments.loop import ClosedLoop

PortValues = Mapping[ReadPlace, np.ndarray]
"""The values of ports, with copies first."""


class LoopCopies:
    """Copies of a loop, each in an episode of its own, with the time and the noise of a run of its trial.

    Copies in one compiled step have their worlds in it; in a world on the host there is one copy.
    """

    def __init__(self, loop: ClosedLoop, copies: int) -> None:
        self.loop, doc = loop, loop.model.document
        agreement.warn(doc, loop.world, stacklevel=4)
        self._doc, self._at = with_readers(doc, loop.views)
        memory.require(graph(self._doc).nodes, loop.precision, copies, 0)
        leaves = tuple(tuple(driven(self._doc, path)) for path in loop.act)
        self._first = [np.full(copies, float(find.value(self._doc, path))) for path in loop.act]
        body = embodied(self._doc, loop.world)
        dynamics = Dynamics(loop.model, Build(self._doc, loop.precision, body=body))
        batch = Batch(copies, None, leaves, restarts=loop.steps, own_noise=True)
        starts = _numbers([0] * copies)
        self._run = Run(dynamics, batch, loop.dt, loop.seed, starts, loop.world, self._first)
        self._now = self._first
        seen = [(ident, port) for ident, port, _ in loop.see.values()]
        rewarded = [] if loop.rewarded is None else [loop.rewarded]
        self._looked = {view: self._at.get(view) or self._place(view) for view in loop.views}
        self._places = list(dict.fromkeys([*seen, *rewarded, *self._looked.values()]))
        program = self._run.program
        self._ports = [program.port(*place) for place in self._places]
        self._axes = {p: program.axes(port) for p, port in zip(self._places, self._ports, strict=True)}

    def begin(self, seed: int, trials: Sequence[int]) -> PortValues:
        """Begin an episode in each copy, at time 0, and return the values of its start."""
        self._sweep([values.copy() for values in self._first])
        self._run.begin(seed, _numbers(trials))
        return self._read()

    def restart(self, ended: np.ndarray, trials: Sequence[int]) -> PortValues:
        """Begin another episode in some copies, and return the values of all.

        Args:
            ended: which copies begin another episode; the others keep theirs.
            trials: the trial of the next episode of each copy.
        """
        rows = np.flatnonzero(ended)
        for now, first in zip(self._now, self._first, strict=True):
            now[rows] = first[rows]
        self._sweep(self._now)
        self._run.restart(rows, _numbers(trials))
        return self._read()

    def step(self, actions: np.ndarray) -> PortValues:
        """Set the parameters, (copies, parameters), advance by a period, and return the values after it."""
        self._sweep([np.array(column, float) for column in actions.T])
        last: list[np.ndarray] = []

        def take(_: int, arrays: Sequence[np.ndarray]) -> None:
            last.extend(np.array(values[:, -1]) for values in arrays)

        steps = self.loop.steps
        self._run.record(steps, self._ports, steps, 1, take, most=1)
        return dict(zip(self._places, last, strict=True))

    def views(self, values: PortValues) -> dict[Observable, np.ndarray]:
        """Return what the events look at, (copies, 1, ...)."""
        out: dict[Observable, np.ndarray] = {}
        for view, place in self._looked.items():
            now = values[place][:, None]
            out[view] = view.from_reader(now) if view in self._at else view.seen(now, self._axes[place], 2)
        return out

    def _sweep(self, columns: list[np.ndarray]) -> None:
        self._now = columns
        self._run.sweep(columns)

    def _read(self) -> PortValues:
        return dict(zip(self._places, map(np.array, self._run.read(self._ports)), strict=True))

    def _place(self, view: Observable) -> ReadPlace:
        entry, port = view.place(self.loop.model.document)
        return entry.id, port


def _numbers(trials: Sequence[int]) -> list[list[int]]:
    """Return the trial of each point of a batch, each of which has noise of its own."""
    return [[trial] for trial in trials]
