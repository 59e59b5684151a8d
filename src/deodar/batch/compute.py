"""Compute a run: its trials and sweep points in one batch, or piece by piece."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import math
from collections.abc import Callable, Generator, Mapping, Sequence
from typing import Any

import numpy as np

from deodar.batch import pieces
from deodar.batch.points import SweepPoints
from deodar.batch.progress import Shown, bar
from deodar.batch.run_file import OutputPart, RunOutput, Sampling
from deodar.batch.simulation_request import SimulationRequest
from deodar.compiler import device as devices
from deodar.compiler import division, hosts
from deodar.compiler.copy_batch import Batch
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.executable import Executable
from deodar.compiler.program import Port
from deodar.elements.field import Field
from deodar.errors import Interrupted, NotFinite, ParameterError, TimeError, WorkerError
from deodar.model import find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.resolve import Node, resolve
from deodar.numerics.axes import shape
from deodar.parameters import show
from deodar.precision import Arithmetic
from deodar.recording.probe import Probe, probes
from deodar.recording.provenance import provenance, stored
from deodar.session import memory
from deodar.session.exchange import embodied
from deodar.session.interrupt import stoppable
from deodar.session.run import Run, require_step, whole
from deodar.session.session import LARGEST_SEED, require_model, require_seed
from deodar.sweep import Points
from deodar.worlds._base import World

Spread = Callable[
    [Model, World | None, Sequence[SimulationRequest], RunOutput | None, Callable[[int], None]],
    list[pieces.PieceResult | None],
]
"""A function that runs pieces in other processes, as `workers.run` and `cluster_pieces.run` do."""


MOST_OWN = 2**16
"""Number of points, and of trials, that have noise of their own under one seed."""


def compute(
    model: Model,
    request: SimulationRequest,
    world: World | None = None,
    spread: Spread | None = None,
    out: RunOutput | OutputPart | None = None,
) -> pieces.PieceResult:
    """Compute a whole run of `simulate`, or one piece of it.

    If all copies diverge, the error is returned beside the record.

    `spread` runs pieces in other processes. With `out` the samples are written to a file; the result has
    none.
    """
    on, device = request.on, request.on.device
    precision, accuracy = Arithmetic.of(request.precision)
    places = devices.several(on.devices, device)
    across = hosts.span(places)
    hosts.require_one("a world", across and world is not None)
    doc = require_model(model).document
    model.require()
    step = doc.step if request.dt is None else request.dt
    require_step(doc, step)
    seed = require_seed(request.seed)
    steps = whole(request.duration, step, "the duration")
    asked_for, gap, strides = _probes(request, step, out)
    names, numbers = _trials(request.trials)
    points = SweepPoints(doc, request.sweep, request.first)
    for document in points.documents():
        require_step(document, step)
    ports, strides = _ports(doc, asked_for, strides)
    start, gap = (steps, steps + 1) if request.record is None else (0, gap)
    count = 0 if start > steps else 1 + (steps - start) // gap
    swept = bool(points.paths)
    copies = Batch(points.size if swept else None, len(numbers) if names else None)
    nodes, _ = resolve(doc)
    size = memory.copy_bytes(nodes, precision, points.rebuilt(), len(numbers))
    cut = _cut(size, names, points, request, places)
    kept = 0 if out is not None else count * copies.size
    recorded = sum(_cells(nodes, entry, port) for entry, port in ports) * kept
    beside = min(on.workers or 0, cut.count) if cut.count > 1 else 0
    memory.require(
        nodes,
        precision,
        cut.batch,
        recorded * (2 if cut.count > 1 else 1),
        points.rebuilt(),
        min(points.size, cut.batch),
        beside,
    )
    paths = [dc.replace(probe, path=find.written(doc, probe.path)) for probe in asked_for]
    request = dc.replace(request, duration=float(request.duration), seed=seed)
    request = dc.replace(request, record=list(map(str, paths)) or None)
    labels, listed = list(numbers) if names else None, points.asked
    asked = {"trials": labels, "sweep": listed, "workers": on.workers, "device": device}
    asked |= {"devices": len(places)} if on.devices is not None else {}
    asked |= {"own_noise": True} if points.own_noise else {}
    if across:
        _require_same(doc, float(step), request, {**asked, "out": out is not None})
    if isinstance(out, RunOutput):
        out.plan(points, cut, asked)
    if cut.count > 1:
        hosts.require_one("workers or a cluster", across and spread is not None)
        sweep = Points(listed, points.own_noise) if isinstance(listed, list) else listed
        jobs = cut.requests(dc.replace(request, dt=float(step)), labels, sweep)
        assert not isinstance(out, OutputPart)
        with _watched(across, steps * len(jobs), on.progress) as tell:
            if spread is None:
                parts = _one_by_one(model, jobs, world, steps, out, tell)
            else:
                parts = spread(model, world, jobs, out, tell)
        return _whole(cut, parts, asked)
    stopped, nothing = False, None
    with stoppable(across) as check:
        more_points, more_trials = _missing(request.width, points, len(numbers))
        wide = Batch(
            points.size + more_points if swept else None,
            len(numbers) + more_trials if names else None,
            tuple(map(tuple, points.leaves)),
            own_noise=points.own_noise,
        )
        distribution, filled = division.distributed(wide, places)
        more_points = (filled.points or points.size) - points.size
        more_trials = (filled.trials or len(numbers)) - len(numbers)
        place = distribution or device
        dynamics = Dynamics(model, doc, precision, accuracy, place, embodied(doc, world))
        values = [np.concatenate([v, np.repeat(v[-1:], more_points)]) for v in points.values]
        numbered = [*numbers, *[numbers[-1]] * more_trials]
        if points.own_noise:
            numbered = _numbered(request.first, points.size + more_points, numbered)
        run = Run(dynamics, filled, float(step), seed, numbered, world, values if swept else None)
        program = run.program
        run.tolerated = filled.size - 1
        found = [program.port(i, port) for i, port in ports]
        settings = _settings(request)
        about = provenance(doc, run, **settings, **asked, batch=cut.batch)
        sampling = Sampling(start, gap, count, float(step), strides)
        part = out.part(0) if isinstance(out, RunOutput) else out
        store = _Store(program, found, filled, count if part is None else 0)
        try:
            with bar(steps, on.progress) as shown:
                if part is not None:
                    places = [(ident, port, p) for (ident, port), p in zip(ports, found, strict=True)]
                    part.begin(program, places, sampling, about)
                    part.record(run, steps, found, check, shown)
                else:

                    def between(done: int) -> None:
                        check()
                        shown(done)

                    run.record(steps, found, start, gap, store.collect, between)
        except KeyboardInterrupt:
            stopped = True
        except NotFinite as error:
            if len(run.lost) < filled.size or not filled.shape:
                raise
            store.fill()
            nothing = error
    kept = {
        copy: error
        for copy, error in run.lost.items()
        if all(k < n for k, n in zip(copy, copies.shape, strict=True))
    }
    reasons = {points.place(copy, names is not None): error.problems[0].what for copy, error in kept.items()}
    said = f"stopped at {run.clock.time:g} of {request.duration:g} {doc.time_unit}"
    # start-up time: these import xarray, which takes 0.3 s; sessions do not need it
    from deodar.recording.diverged import marked
    from deodar.recording.record import dataset

    if part is not None:
        if stopped:
            raise Interrupted(said, None)
        part.end(reasons)
        return pieces.EMPTY._replace(lost=nothing)
    times = doc.t0 + (start + np.arange(store.taken) * gap) * float(step)
    data = dataset(
        doc,
        [
            (doc.by_id()[i], port, program.axes(p), a[*map(slice, copies.shape), : store.taken])
            for (i, port), p, a in zip(ports, found, store.arrays, strict=True)
        ],
        times,
        names,
        points.grid,
        about | {"complete": not stopped},
        points.beside,
    )
    data = marked(data, [*points.grid, *(["trial"] if names is not None else [])], reasons)
    if stopped:
        raise Interrupted(said, data)
    return pieces.PieceResult(data, True, nothing)


def _require_same(doc: Document, step: float, request: SimulationRequest, asked: Mapping[str, Any]) -> None:
    """Raise HostsError unless all hosts compute the same."""
    hosts.require_equal("the model", stored(doc))
    about = {**asked, "dt": step, **_settings(request), "precision": request.precision}
    hosts.require_equal("the arguments of simulate", {**about, "batch": request.on.batch})


def _settings(request: SimulationRequest) -> dict[str, Any]:
    """Return the parts of a request that every record states; others are known only after the start."""
    return {
        "duration": request.duration,
        "seed": request.seed,
        "every": request.every,
        "accuracy": Arithmetic.of(request.precision).accuracy,
        "record": request.record,
    }


def _whole(
    cut: pieces.Pieces, parts: Sequence[pieces.PieceResult | None], settings: Mapping[str, Any]
) -> pieces.PieceResult:
    """Return the result of all pieces; raise Interrupted if some are not complete."""
    data = pieces.joined(cut, parts, settings)
    complete = sum(part is not None and part.complete for part in parts)
    if complete < len(parts):
        raise Interrupted(f"stopped when {complete} of {len(parts)} pieces of the batch were complete", data)
    errors = [part.lost for part in parts if part is not None]
    return pieces.PieceResult(data, True, errors[0] if all(error is not None for error in errors) else None)


def _missing(width: tuple[str, int] | None, points: SweepPoints, trials: int) -> tuple[int, int]:
    """Return the number of points and trials that a piece lacks to be as wide as the others."""
    if width is None:
        return 0, 0
    dimension, length = width
    if dimension in points.grid:
        own = len(points.grid[dimension])
        return points.size // own * (length - own), 0
    return 0, length - trials


@contextlib.contextmanager
def _watched(across: bool, steps: int, progress: Shown) -> Generator[Callable[[int], None]]:
    """Return a function that receives the number of completed steps, shows it and checks for Ctrl-C."""
    with stoppable(across) as check, bar(steps, progress) as shown:

        def between(done: int) -> None:
            check()
            shown(done)

        yield between


def _one_by_one(
    model: Model,
    jobs: Sequence[SimulationRequest],
    world: World | None,
    steps: int,
    out: RunOutput | None,
    between: Callable[[int], None],
) -> list[pieces.PieceResult | None]:
    """Compute the pieces one after another; `between` receives the number of completed steps of all."""
    parts: list[pieces.PieceResult | None] = [None] * len(jobs)
    for k, job in enumerate(jobs):
        if out is not None and k in out.done:
            parts[k] = pieces.EMPTY
            continue
        part = None if out is None else out.part(k)
        try:
            parts[k] = compute(
                model, watching(job, lambda done, k=k: between(k * steps + done)), world, out=part
            )
        except Interrupted as error:
            parts[k] = pieces.PieceResult(error.data, False)
            break
    return parts


def _cut(
    bytes_a_copy: int,
    trials: Sequence[int] | None,
    points: SweepPoints,
    request: SimulationRequest,
    places: Sequence[devices.Device],
) -> pieces.Pieces:
    lengths = ({} if trials is None else {"trial": len(trials)}) | {
        path: len(values) for path, values in points.grid.items()
    }
    workers, device = request.on.workers, request.on.device
    on_cpu = places[0].platform == devices.DEFAULT
    if workers is not None and (not on_cpu or len(places) > 1):
        given = "device" if not on_cpu else "devices"
        named = repr(device) if not on_cpu else f"{len(places)} devices"
        raise WorkerError(
            f"worker processes run on the cores of the CPU, not on {named}",
            fix=f"Leave out workers, or {given}",
        )
    return pieces.cut(lengths, bytes_a_copy if on_cpu else 0, workers or 1, request.on.batch, len(places))


def watching(request: SimulationRequest, progress: Callable[[int], None]) -> SimulationRequest:
    """Return the request of a piece with a function that receives its completed steps."""
    return dc.replace(request, on=dc.replace(request.on, progress=progress))


class _Store:
    """Arrays for all recorded values, filled during the run."""

    def __init__(self, program: Executable, ports: Sequence[Port], batch: Batch, count: int) -> None:
        self.lead = len(batch.shape)
        self.count = count
        self.taken = 0
        self.arrays = [
            np.empty((*batch.shape, count, *shape(program.axes(p))), program.program.dtype) for p in ports
        ]

    def collect(self, k: int, seen: tuple[np.ndarray, ...]) -> None:
        n = seen[0].shape[self.lead] if seen else 0
        for array, part in zip(self.arrays, seen, strict=True):
            array[(slice(None),) * self.lead + (slice(k, k + n),)] = part
        self.taken = k + n

    def fill(self) -> None:
        """Fill all arrays with NaN: every copy has diverged."""
        for array in self.arrays:
            array[...] = np.nan
        self.taken = self.count


def _probes(
    request: SimulationRequest, step: float, out: object
) -> tuple[list[Probe], int, list[tuple[int, str | None]]]:
    """Return the probes of a run, the steps between two of its samples, and for each probe how many samples
    lie between two of its own, and its condition.

    Without probes, the final state of all fields is recorded.
    """
    found = [] if request.record is None else probes(request.record)
    own = [probe for probe in found if probe.alone]
    copies = request.trials is not None or bool(request.sweep)
    if own and (out is None or copies):
        where = "into a file" if out is None else "of a single run"
        raise ParameterError(
            "an interval or a condition of its own needs a record that is written " + where,
            where=str(own[0]),
            fix="Give `out`" if out is None else "Leave out trials and sweep",
        )
    every = [request.every if probe.every is None else probe.every for probe in found]
    gaps = [1 if time is None else whole(time, step, "every") for time in every or [request.every]]
    if 0 in gaps:
        raise TimeError("every is 0; expected at least one step")
    gap = math.gcd(*gaps)
    return found, gap, [(n // gap, probe.when) for n, probe in zip(gaps, found, strict=False)]


def _ports(
    doc: Document, found: Sequence[Probe], strides: Sequence[tuple[int, str | None]]
) -> tuple[list[tuple[str, str]], list[tuple[int, str | None]]]:
    """Return the ports to record, each once, and their strides and conditions."""
    if not found:
        fields = [(e.id, "activation") for e in doc.entries if isinstance(e.element, Field)]
        if not fields:
            raise ParameterError(
                "the model has no field, so the ports to record must be named",
                fix="For example record=['left.output']",
            )
        return fields, [(1, None)] * len(fields)
    ports: dict[tuple[str, str], tuple[int, str | None]] = {}
    for probe, stride in zip(found, strides, strict=True):
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


def _cells(nodes: Sequence[Node], ident: str, port: str) -> int:
    node = next(n for n in nodes if n.id == ident)
    return math.prod(shape(node.axes(port)))


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
