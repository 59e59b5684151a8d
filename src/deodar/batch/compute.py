"""Compute a run: its trials and sweep points in one batch, or piece by piece."""

from __future__ import annotations

import contextlib
import dataclasses as dc
from collections.abc import Callable, Generator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar.batch import pieces
from deodar.batch.piece_record import RecordedPiece
from deodar.batch.run_file import RunOutput
from deodar.batch.run_plan import RunPlan
from deodar.batch.simulation_request import SimulationRequest
from deodar.compiler import hosts
from deodar.compiler.build import Build
from deodar.compiler.copy_batch import Batch
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.executable import Executable
from deodar.compiler.program import Port
from deodar.errors import Interrupted, NotFinite
from deodar.model.model import Model
from deodar.numerics.axes import shape
from deodar.progress import Shown, bar
from deodar.recording.provenance import provenance
from deodar.session.exchange import embodied
from deodar.session.interrupt import stoppable
from deodar.session.run import Run
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray

Spread = Callable[
    [Model, World | None, Sequence[SimulationRequest], RunOutput | None, Callable[[int], None]],
    list[pieces.PieceResult | None],
]
"""A function that runs pieces in other processes, as `workers.run` and `cluster_pieces.run` do."""


def compute(
    model: Model,
    request: SimulationRequest,
    world: World | None = None,
    spread: Spread | None = None,
    out: RunOutput | RecordedPiece | None = None,
) -> pieces.PieceResult:
    """Compute a whole run of `simulate`, or one piece of it.

    If all copies diverge, the error is returned beside the record.

    `spread` runs pieces in other processes. With `out` the samples are written to a file; the result has
    none.
    """
    plan = RunPlan(model, request, world, out is not None)
    plan.require_same(out is not None)
    if isinstance(out, RunOutput):
        out.plan(plan.points, plan.cut, plan.stated)
    if plan.cut.count == 1:
        return _in_one(plan, out.piece(0) if isinstance(out, RunOutput) else out)
    hosts.require_one("workers or a cluster", plan.across and spread is not None)
    assert not isinstance(out, RecordedPiece)
    jobs = plan.pieces()
    with _watched(plan.across, plan.steps * len(jobs), plan.request.on.progress) as tell:
        if spread is None:
            parts = _one_by_one(plan, jobs, out, tell)
        else:
            parts = spread(model, world, jobs, out, tell)
    return _whole(plan, parts)


def watching(request: SimulationRequest, progress: Callable[[int], None]) -> SimulationRequest:
    """Return the request of a piece with a function that receives its completed steps."""
    return dc.replace(request, on=dc.replace(request.on, progress=progress))


# ----------------------------------------------------------------------------------------------- in one piece


def _in_one(plan: RunPlan, part: RecordedPiece | None) -> pieces.PieceResult:
    """Compute all copies of a plan in one program."""
    stopped, nothing = False, None
    with stoppable(plan.across) as check:
        distribution, filled = plan.filled()
        place = distribution or plan.request.on.device
        body = embodied(plan.doc, plan.world)
        dynamics = Dynamics(plan.model, Build(plan.doc, *plan.arithmetic, place, body))
        noise, values = plan.noise(filled), plan.values(filled)
        run = Run(dynamics, filled, plan.sampling.dt, plan.request.seed, noise, plan.world, values)
        program = run.program
        run.tolerated = filled.size - 1
        ports = [program.port(i, port) for i, port in plan.ports]
        description = provenance(plan.doc, run, **plan.settings, **plan.stated, batch=plan.cut.batch)
        sink = _Store(filled) if part is None else part
        sink.begin(plan, program, ports, description)
        try:
            with bar(plan.steps, plan.request.on.progress) as show:
                sink.record(run, check, show)
        except KeyboardInterrupt:
            stopped = True
        except NotFinite as error:
            if len(run.lost) < filled.size or not filled.shape:
                raise
            nothing = error
    record = sink.end(_reasons(plan, run), not stopped, nothing is not None)
    if stopped:
        end = f"{run.clock.time:g} of {plan.request.duration:g} {plan.doc.time_unit}"
        raise Interrupted(f"stopped at {end}", record)
    return pieces.PieceResult(record, True, nothing)


def _reasons(plan: RunPlan, run: Run) -> dict[tuple[int, ...], str]:
    """Return why copies diverged, without those that only fill a piece up."""
    axis_lengths = plan.copies.shape
    return {
        plan.points.place(copy, plan.labels is not None): error.problems[0].what
        for copy, error in run.lost.items()
        if all(k < n for k, n in zip(copy, axis_lengths, strict=True))
    }


class _Store:
    """The samples of a run in memory: arrays for all recorded values, filled during the run."""

    def __init__(self, batch: Batch) -> None:
        self._batch, self._taken = batch.shape, 0

    def begin(
        self, plan: RunPlan, program: Executable, ports: Sequence[Port], description: Mapping[str, Any]
    ) -> None:
        """Set what is recorded, as `RecordedPiece.begin` does."""
        self._plan, self._ports, self._about = plan, ports, description
        self._axes = [program.axes(port) for port in ports]
        self._arrays = [
            np.empty((*self._batch, plan.sampling.most, *shape(axes)), program.program.dtype)
            for axes in self._axes
        ]

    def record(self, run: Run, check: Callable[[], None], show: Callable[[int], object]) -> None:
        """Advance a run to its end, as `RecordedPiece.record` does."""
        plan = self._plan

        def between(done: int) -> None:
            check()
            show(done)

        run.record(plan.steps, self._ports, plan.sampling.start, plan.sampling.gap, self._collect, between)

    def _collect(self, k: int, seen: tuple[np.ndarray, ...]) -> None:
        lead = len(self._batch)
        n = seen[0].shape[lead] if seen else 0
        for array, part in zip(self._arrays, seen, strict=True):
            array[(slice(None),) * lead + (slice(k, k + n),)] = part
        self._taken = k + n

    def end(self, reasons: Mapping[tuple[int, ...], str], complete: bool, lost: bool) -> xarray.Dataset:
        """Return the record; `lost`: every copy has diverged."""
        # start-up time: these import xarray, which takes 0.3 s; sessions do not need it
        from deodar.recording.diverged import marked
        from deodar.recording.record import dataset

        plan, doc = self._plan, self._plan.doc
        taken = plan.sampling.most if lost else self._taken
        for array in self._arrays if lost else ():
            array[...] = np.nan
        region = *map(slice, plan.copies.shape), slice(taken)
        variables = [
            (doc.by_id()[ident], port, axes, array[region])
            for (ident, port), axes, array in zip(plan.ports, self._axes, self._arrays, strict=True)
        ]
        times, description = plan.sampling.times(doc, 0, taken), {**self._about, "complete": complete}
        record = dataset(
            doc, variables, times, plan.labels, plan.points.grid, description, plan.points.beside
        )
        trials = ["trial"] if plan.labels is not None else []
        return marked(record, [*plan.points.grid, *trials], reasons)


# -------------------------------------------------------------------------------------------------- in pieces


@contextlib.contextmanager
def _watched(across: bool, steps: int, progress: Shown) -> Generator[Callable[[int], None]]:
    """Return a function that receives the number of completed steps, shows it and checks for Ctrl-C."""
    with stoppable(across) as check, bar(steps, progress) as show:

        def between(done: int) -> None:
            check()
            show(done)

        yield between


def _one_by_one(
    plan: RunPlan,
    jobs: Sequence[SimulationRequest],
    out: RunOutput | None,
    between: Callable[[int], None],
) -> list[pieces.PieceResult | None]:
    """Compute the pieces one after another; `between` receives the number of completed steps of all."""
    parts: list[pieces.PieceResult | None] = [None] * len(jobs)
    for k, job in enumerate(jobs):
        if out is not None and k in out.done:
            parts[k] = pieces.EMPTY
            continue
        part = None if out is None else out.piece(k)
        job = watching(job, lambda done, k=k: between(k * plan.steps + done))
        try:
            parts[k] = compute(plan.model, job, plan.world, out=part)
        except Interrupted as error:
            parts[k] = pieces.PieceResult(error.data, False)
            break
    return parts


def _whole(plan: RunPlan, parts: Sequence[pieces.PieceResult | None]) -> pieces.PieceResult:
    """Return the result of all pieces; raise Interrupted if some are not complete."""
    record = pieces.joined(plan.cut, parts, plan.stated)
    complete = sum(part is not None and part.complete for part in parts)
    if complete < len(parts):
        raise Interrupted(
            f"stopped when {complete} of {len(parts)} pieces of the batch were complete", record
        )
    errors = [part.lost for part in parts if part is not None]
    return pieces.PieceResult(record, True, errors[0] if all(error is not None for error in errors) else None)
