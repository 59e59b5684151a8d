"""The plan of a run: all that is known before its first step."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from deodar.batch import pieces
from deodar.batch.points import SweepPoints
from deodar.batch.simulation_request import SimulationRequest
from deodar.compiler import device as devices
from deodar.compiler import division, hosts
from deodar.compiler.copy_batch import Batch
from deodar.elements.field import Field
from deodar.errors import ParameterError, WorkerError
from deodar.model import find
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.model import Model
from deodar.numerics.axes import shape
from deodar.parameters import show
from deodar.precision import Arithmetic
from deodar.recording.probe import Probe, probes
from deodar.recording.provenance import stored
from deodar.session import memory
from deodar.session.run import gaps, require_sampled, require_step, whole
from deodar.session.session import LARGEST_SEED, require_model, require_seed
from deodar.sweep import Points
from deodar.worlds._base import World

MOST_OWN = 2**16
"""Number of points, and of trials, that have noise of their own under one seed."""


class Sampling(NamedTuple):
    """The samples of a run: after `start` steps and then after each `gap`, `most` of them.

    `probes` states for each variable how many gaps lie between its samples, and their condition.
    """

    start: int
    gap: int
    most: int
    dt: float
    probes: Sequence[tuple[int, str | None]] = ()

    def times(self, doc: Document, first: int, n: int) -> np.ndarray:
        """Return the times of `n` samples from number `first` on."""
        return doc.t0 + (self.start + (first + np.arange(n)) * self.gap) * self.dt


class RunPlan:
    """A run of `simulate`, or one piece of it, before its first step.

    Args:
        model: the model in its present state.
        request: what is asked for.
        world: the world of its sensors.
        writes: whether samples are written into a file.

    Attributes:
        request: what is asked for, with the step, and with paths as the document writes them.
        arithmetic: precision and accuracy.
        steps: number of steps.
        points: the points of its sweep.
        labels: the trials of the dimension `trial`; None without it.
        numbers: the number of each trial.
        ports: id and port of what is recorded.
        sampling: when it is recorded.
        devices: the devices that share the copies.
        across: whether these belong to several hosts.
        cut: its pieces.
    """

    def __init__(self, model: Model, request: SimulationRequest, world: World | None, writes: bool) -> None:
        self.arithmetic = Arithmetic.of(request.precision)
        self.devices = devices.several(request.on.devices, request.on.device)
        self.across = hosts.span(self.devices)
        hosts.require_one("a world", self.across and world is not None)
        self.model, self.world, self.doc = model, world, require_model(model).document
        model.require()
        step = self.doc.step if request.dt is None else request.dt
        require_step(self.doc, step)
        seed = require_seed(request.seed)
        self.steps = whole(request.duration, step, "the duration")
        asked_for, gap, strides = _probes(request, step, self.steps, writes)
        self.labels, self.numbers = _trials(request.trials)
        self.points = SweepPoints(self.doc, request.sweep, request.first)
        for document in self.points.documents():
            require_step(document, step)
        self.ports, strides = _ports(self.doc, asked_for, strides)
        start, gap = (self.steps, self.steps + 1) if request.record is None else (0, gap)
        count = 0 if start > self.steps else 1 + (self.steps - start) // gap
        self.sampling = Sampling(start, gap, count, float(step), strides)
        paths = [dc.replace(probe, path=find.written(self.doc, probe.path)) for probe in asked_for]
        self.request = dc.replace(
            request,
            duration=float(request.duration),
            dt=float(step),
            seed=seed,
            record=list(map(str, paths)) or None,
        )
        self.cut = self._memory(0 if writes else count)

    @property
    def copies(self) -> Batch:
        """The copies of the run."""
        points = self.points.size if self.points.paths else None
        return Batch(points, None if self.labels is None else len(self.numbers))

    @property
    def stated(self) -> dict[str, Any]:
        """What the record states of the copies, and of where they are computed."""
        on, points = self.request.on, self.points
        labels = None if self.labels is None else list(self.numbers)
        copies = {"trials": labels, "sweep": points.asked, "workers": on.workers, "device": on.device}
        copies |= {"devices": len(self.devices)} if on.devices is not None else {}
        return copies | ({"own_noise": True} if points.own_noise else {})

    @property
    def settings(self) -> dict[str, Any]:
        """Further parts of the request that the record states; others are known only after the start."""
        settings = {name: getattr(self.request, name) for name in ("duration", "seed", "every")}
        return {**settings, "accuracy": self.arithmetic.accuracy, "record": self.request.record}

    def require_same(self, writes: bool) -> None:
        """Raise HostsError unless all hosts compute the same."""
        if self.across:
            hosts.require_equal("the model", stored(self.doc))
            arguments = {**self.stated, **self.settings, "out": writes, "dt": self.request.dt}
            arguments |= {"precision": self.request.precision, "batch": self.request.on.batch}
            hosts.require_equal("the arguments of simulate", arguments)

    def pieces(self) -> list[SimulationRequest]:
        """Return the requests of the pieces."""
        sweep_points, labels = self.points.asked, None if self.labels is None else list(self.numbers)
        sweep = (
            Points(sweep_points, self.points.own_noise) if isinstance(sweep_points, list) else sweep_points
        )
        return self.cut.requests(self.request, labels, sweep)

    def filled(self) -> tuple[division.Distribution | None, Batch]:
        """Return how devices share the copies, and the copies with those that fill the piece and the devices
        up.
        """
        copies, points = self.copies, self.points
        more_points = more_trials = 0
        dimension, length = self.request.width or ("", 0)
        if dimension in points.grid:
            row = len(points.grid[dimension])
            more_points = points.size // row * (length - row)
        elif dimension:
            more_trials = length - len(self.numbers)
        wide = Batch(
            None if copies.points is None else copies.points + more_points,
            None if copies.trials is None else copies.trials + more_trials,
            tuple(map(tuple, points.leaves)),
            own_noise=points.own_noise,
        )
        return division.distributed(wide, self.devices)

    def values(self, filled: Batch) -> list[np.ndarray] | None:
        """Return for each path of the sweep its value in each copy; None without a sweep."""
        padding = (filled.points or self.points.size) - self.points.size
        values = [np.concatenate([v, np.repeat(v[-1:], padding)]) for v in self.points.values]
        return values if self.points.paths else None

    def noise(self, filled: Batch) -> Sequence[Any]:
        """Return the number under which each trial, or with noise of its own each copy, draws noise."""
        padding = (filled.trials or len(self.numbers)) - len(self.numbers)
        trials = [*self.numbers, *[self.numbers[-1]] * padding]
        if not self.points.own_noise:
            return trials
        return _numbered(self.request.first, filled.points or self.points.size, trials)

    def _memory(self, samples: int) -> pieces.Pieces:
        """Return the pieces of the run; raise if they need more memory than there is.

        `samples`: number of samples of each copy that stay in memory.
        """
        nodes = graph(self.doc).nodes
        rebuilt, precision = self.points.rebuilt(), self.arithmetic.precision
        cut = self._cut(memory.copy_bytes(nodes, precision, rebuilt, len(self.numbers)))
        of = {node.id: node for node in nodes}
        cells = sum(math.prod(shape(of[ident].axes(port))) for ident, port in self.ports)
        recorded = cells * samples * self.copies.size * (2 if cut.count > 1 else 1)
        beside = min(self.request.on.workers or 0, cut.count) if cut.count > 1 else 0
        swept = min(self.points.size, cut.batch)
        memory.require(nodes, self.arithmetic.name, cut.batch, recorded, rebuilt, swept, beside)
        return cut

    def _cut(self, bytes_a_copy: int) -> pieces.Pieces:
        lengths = {} if self.labels is None else {"trial": len(self.labels)}
        lengths |= {path: len(values) for path, values in self.points.grid.items()}
        on, count = self.request.on, len(self.devices)
        on_cpu = self.devices[0].platform == devices.DEFAULT
        if on.workers is not None and (not on_cpu or count > 1):
            argument = "device" if not on_cpu else "devices"
            named = repr(on.device) if not on_cpu else f"{count} devices"
            raise WorkerError(
                f"worker processes run on the cores of the CPU, not on {named}",
                fix=f"Leave out workers, or {argument}",
            )
        return pieces.cut(lengths, bytes_a_copy if on_cpu else 0, on.workers or 1, on.batch, count)


def _probes(
    request: SimulationRequest, step: float, total: int, writes: bool
) -> tuple[list[Probe], int, list[tuple[int, str | None]]]:
    """Return the probes of a run, the steps between two of its samples, and for each probe how many samples
    lie between two of its own, and its condition.

    Without probes, the final state of all fields is recorded.
    """
    recorded = [] if request.record is None else probes(request.record)
    _require_alone(recorded, request, writes)
    every = [request.every if probe.every is None else probe.every for probe in recorded]
    steps = gaps(every or [request.every], step)
    for interval, n in zip(every or [request.every], steps, strict=False):
        require_sampled(interval, n, total, step)
    gap = math.gcd(*steps)
    return recorded, gap, [(n // gap, probe.when) for n, probe in zip(steps, recorded, strict=False)]


def _require_alone(recorded: Sequence[Probe], request: SimulationRequest, writes: bool) -> None:
    """Raise an error for probes with an interval or a condition, unless a single run is written to a file."""
    alone = [probe for probe in recorded if probe.alone]
    copies = request.trials is not None or bool(request.sweep)
    if alone and (copies or not writes):
        where = "into a file" if not writes else "of a single run"
        raise ParameterError(
            "an interval or a condition of its own needs a record that is written " + where,
            where=str(alone[0]),
            fix="Give `out`" if not writes else "Leave out trials and sweep",
        )


def _ports(
    doc: Document, recorded: Sequence[Probe], strides: Sequence[tuple[int, str | None]]
) -> tuple[list[tuple[str, str]], list[tuple[int, str | None]]]:
    """Return the ports to record, each once, and their strides and conditions."""
    if not recorded:
        fields = [(e.id, "activation") for e in doc.entries if isinstance(e.element, Field)]
        if not fields:
            raise ParameterError(
                "the model has no field, so the ports to record must be named",
                fix="For example record=['left.output']",
            )
        return fields, [(1, None)] * len(fields)
    ports: dict[tuple[str, str], tuple[int, str | None]] = {}
    for probe, stride in zip(recorded, strides, strict=True):
        entry, port = find.shown(doc, probe.path)
        if ports.setdefault((entry.id, port), stride) != stride:
            raise ParameterError(
                "is recorded with two intervals or conditions", where=probe.path, fix="Record it once"
            )
    return list(ports), list(ports.values())


def _numbered(first: int, points: int, trials: Sequence[int]) -> list[list[int]]:
    """Return the number under which each copy draws noise, points first.

    It depends on point and trial alone, not on how the run is cut; at point 0 it is the trial.
    """
    if first + points > MOST_OWN or max(trials) >= MOST_OWN:
        raise ParameterError(
            f"own_noise serves {MOST_OWN} points, and trials below {MOST_OWN}",
            fix="Run the rest with another seed",
        )
    return [[point * MOST_OWN + trial for trial in trials] for point in range(first, first + points)]


def _trials(trials: int | Sequence[int] | None) -> tuple[Sequence[int] | None, Sequence[int]]:
    """Return labels of the dimension (None without the dimension), and trial numbers."""
    if trials is None:
        return None, [0]
    if isinstance(trials, (int, np.integer)) and not isinstance(trials, bool) and 1 <= trials <= LARGEST_SEED:
        return range(int(trials)), range(int(trials))  # not a list: memory is checked later
    if isinstance(trials, (str, bool, int, np.integer)) or not np.iterable(trials):
        raise ParameterError(
            f"trials is {show(trials)}; expected a number of trials, at least 1, or a list of trial numbers"
        )
    numbers = [require_seed(t) for t in trials]
    if not numbers or len(set(numbers)) < len(numbers):
        raise ParameterError(f"trials is {show(trials)}; expected at least one trial, each named once")
    return numbers, numbers
