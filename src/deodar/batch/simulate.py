"""`simulate`: one call, one labelled record; trials and sweeps as one batched program, or as several in
parallel.
"""

from __future__ import annotations

import dataclasses as dc
import functools
import math
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar.batch.cluster_pieces import run as on_cluster
from deodar.batch.compute import Spread, compute
from deodar.batch.run_file import Output, RunOutput
from deodar.batch.simulation_request import SimulationRequest
from deodar.batch.workers import run as in_workers
from deodar.cluster import Cluster
from deodar.compiler import device as places
from deodar.compiler import hosts
from deodar.errors import DeodarError, Interrupted, NotFinite, RunWarning
from deodar.model.model import Handle, Model
from deodar.parameters import real
from deodar.precision import Arithmetic
from deodar.recording.probe import Probe
from deodar.resources import Resources, use_resources
from deodar.session import agreement
from deodar.session.run import MOST_STEPS
from deodar.session.session import require_model
from deodar.sweep import Sweep
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray

TICKS = 2**32
"""Number of steps that the counter of the noise can distinguish."""

LONG_STEPS = 10**9
"""Number of steps from which on a warning announces a run: the fastest models need an hour for them, most a
day.
"""


def simulate(
    model: Model,
    duration: float,
    *,
    dt: float | None = None,
    seed: int = 0,
    record: Probe | Handle | str | Sequence[Probe | Handle | str] | None = None,
    every: float | None = None,
    trials: int | Sequence[int] | None = None,
    sweep: Sweep | None = None,
    world: World | None = None,
    precision: str = "float32",
    out: Output | str | Path | None = None,
    on: Resources = Resources(),
) -> xarray.Dataset:
    """Run a model and return its record.

    Trials and points of a sweep are copies of the model in one batch. A batch that would exceed the
    processor's cache is cut into pieces, along the longest of these dimensions; workers run the pieces in
    processes of one core each. The noise has the same bits for any cut, and float64 results agree to 1e-10. A
    worker takes one to two seconds to start, so a short run is faster without.

    In float32 the last digits of a copy depend on the number of points and trials that are computed together,
    because the compiler orders sums by the size of arrays: results of other widths agree to 1e-4. At the same
    width all bits agree, for any place of a copy, number of pieces, chunks, workers and restarts, and order
    of declaration. All pieces of a run have the same width: `batch` in the record; the last one is filled up.
    With `on=dd.Resources(batch=1)` each trial has the bits of a single run. `python benchmarks/bits.py` tests
    this with random combinations.

    Args:
        model: the model in its present state.
        duration: document time; a whole number of steps.
        dt: Euler step; none: the document's own, else 1.
        seed: seed of all noise, 0 to 2^32 - 1.
        record: paths of ports; the path of a field alone means its activation. With `out` a `dd.Probe`, or
            its text `u,every=10,when=peak`, gives a port an interval or a condition of its own. None: the
            activation of every field and node, at the end only.
        every: sampling interval in document time; none: dt. The first sample is the initial state.
        trials: number of trials (0 to n - 1 of the seed), or a list of trial numbers; trials differ in their
            noise.
        sweep: for each parameter path its values; several entries form a grid. Or a list of points, each a
            mapping of values by path, which have one dimension, `point`. All points share the noise, except
            those of `dd.Points(list, own_noise=True)`.
        world: the world that provides the sensors of the model.
        precision: float32, float64, or float32-exact: single precision with every kernel by its matrix, even
            where that is slower. float32 is at most 1e-4 off in activation. Double precision is always exact,
            and so are elements of which a width is swept.
        out: write the record to this place during the run: a name that ends in .zarr, or a folder,
            which gets the record and the model; or a `dd.Output`, which may replace an existing record.
            Memory does not grow with what is recorded, and if the process is killed the record ends less than
            a second before (`dd.resume` continues it). Of several hosts the first one writes; the others
            return a Dataset without samples.
        on: devices, workers or a cluster, and whether to show progress. From 10^9 steps on a `RunWarning`
            states their number, and progress is shown unless it is False: without a terminal as lines.

    Returns:
        A Dataset with one variable for each path; dimensions: those of the sweep (its paths, or `point`, with
        the value of each path as a coordinate), `trial` (if given), `time`, axes.
        All values of copies that diverge are NaN, at all times; the coordinate `diverged` gives the reason of
        each, the attribute `diverged` counts them, and a `RunWarning` repeats it.

    Raises:
        NotFinite: a single run diverges, or all copies diverge.
        Interrupted: on Ctrl-C; its `data` holds the samples recorded before; of a run in pieces the complete
            pieces, if any.
        DeviceError: the device does not exist, or fewer devices than `devices`; or the fields cannot be
            divided.
        HostsError: a host has ended, differs from the others, or cannot do on several what it is asked.
        WorkerError: a part of the model cannot be sent to another process, or a process has died.
        OutputExists: `out` exists.
        OutputError: samples cannot be written; those before are in the file.
    """
    require_model(model)
    use_resources(on, "dd.simulate", "device", "devices", "workers", "cluster", "batch", "progress")
    steps = expected_steps(duration, model.document.step if dt is None else dt)
    if steps >= LONG_STEPS:
        step = model.document.step if dt is None else dt
        repetition = "" if steps <= TICKS else f"; the noise of an element repeats after {TICKS:.3g} steps"
        warnings.warn(
            f"{steps:.3g} steps of dt = {step:g}: a smaller number may be meant{repetition}",
            RunWarning,
            stacklevel=2,
        )
        on = dc.replace(on, progress=True if on.progress is None else on.progress)
    agreement.warn(model.document, world, stacklevel=2)
    used_step = real(model.document.step if dt is None else dt)
    if used_step is not None and used_step > 0:  # else the run is refused
        agreement.warn_of_rounding(model.document, used_step, Arithmetic.of(precision)[0], stacklevel=2)
    request = SimulationRequest(duration, dt, seed, record, every, trials, sweep, precision, on)
    with hosts.together(places.of_all_hosts(on.devices, on.device)):
        across = hosts.count() > 1 and hosts.span(places.several(on.devices, on.device))
        file = None if out is None else RunOutput(Output.of(out), here=hosts.first() or not across)
        run_record = warned(model, request, world, file)
        # an error after the last chunk, as of a disk, also reaches the others in this call
        hosts.any_of("the end of the run", True, across)
        return run_record


def warned(
    model: Model,
    request: SimulationRequest,
    world: World | None,
    out: RunOutput | None,
    spread: Spread | None = None,
) -> xarray.Dataset:
    """Compute a run, in memory or into a file; return its record, with a warning if copies diverged.

    `spread` runs pieces on a cluster that is connected; none: where the request says.

    Raises:
        NotFinite: a single run diverges, or all copies diverge.
        Interrupted: on Ctrl-C, with the record until then.
    """
    run_record, lost = _computed(model, request, world, out, spread)
    if lost is not None:
        raise lost
    if "diverged" in run_record.attrs:
        warnings.warn(str(run_record.attrs["diverged"]), RunWarning, stacklevel=3)
    return run_record


def _computed(
    model: Model,
    request: SimulationRequest,
    world: World | None,
    out: RunOutput | None,
    spread: Spread | None,
) -> tuple[xarray.Dataset, NotFinite | None]:
    """Return the record, and the error if all copies diverged."""
    if spread is None and request.on.cluster is not None:
        spread = functools.partial(on_cluster, Cluster.of(request.on.cluster))
    elif spread is None and request.on.workers is not None:
        spread = functools.partial(in_workers, request.on.workers)
    if out is None:
        run_record, _, lost = compute(model, request, world, spread)
        assert run_record is not None
        return run_record, lost
    try:
        _, _, lost = compute(model, request, world, spread, out)
    except BaseException as error:
        run_record = out.abandon()
        if isinstance(error, Interrupted):
            error.data = run_record if run_record is not None else error.data
        elif isinstance(error, DeodarError) and run_record is not None:
            error.advise(out.kept(run_record, error))
        raise
    return out.close(), lost


def expected_steps(duration: Any, dt: Any) -> int:
    """Return the number of steps of a run; 0 if the run will be refused."""
    length, step = real(duration), real(dt)
    good = length is not None and step is not None and 0 < step < math.inf and 0 <= length < math.inf
    steps = length / step if good and length is not None and step is not None else 0.0
    return int(steps) if steps <= MOST_STEPS else 0
