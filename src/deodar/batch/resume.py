"""`resume`: continue a run from its record."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
from collections.abc import Callable, Generator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.batch.cluster_pieces import in_pool, require_one_kind
from deodar.batch.on_cluster import ClusterPool
from deodar.batch.pieces import cut
from deodar.batch.run_file import Output, RunOutput
from deodar.batch.simulate import warned
from deodar.batch.simulation_request import SimulationRequest
from deodar.cluster import Cluster
from deodar.compiler import device as devices
from deodar.compiler import hosts
from deodar.errors import Fix, RecordError, WorkerError, option
from deodar.precision import Arithmetic
from deodar.recording import provenance
from deodar.resources import Resources, use_resources
from deodar.sweep import POINT, checked
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray

    from deodar.recording.repeat import Difference


def resume(
    path: str | Path,
    duration: float | None = None,
    world: World | None = None,
    trust: bool = False,
    accept: Callable[[tuple[Difference, ...]], bool] | None = None,
    on: Resources = Resources(),
) -> xarray.Dataset:
    """Continue a run that was killed or stopped, or make a complete one longer; return its record, opened.

    The run continues from the state that was stored last; samples after it are computed again. With the same
    versions on the same machine the record gets the same bits as that of an undisturbed run.

    A run in pieces may continue in another place than where it began: in this process, in as many worker
    processes as its record states, or on a cluster. Its pieces and their bits do not depend on the place;
    workers compute with one core.

    Args:
        path: the record, or the folder of a run: what `out` of `simulate` named.
        duration: document time of the whole run; None: that of the record.
        world: the world of its sensors; None: that of the record, opened again.
        trust: whether functions that its document names may be imported and run.
        accept: called with what differs from the versions and the machine of the record, if anything does;
            returns whether to continue. Samples after the stored state are then dropped at once. None:
            differences are an error. On a cluster the versions and the machine are those of its workers.
        on: a cluster that shares the remaining pieces (a run in one piece continues in this process), and
            whether to show progress.

    Raises:
        RecordError: the record is complete and not made longer, another process writes it, or versions or
            machine differ.
        Untrusted: its document names a function, and `trust` is not given.
        WorkerError: the workers cannot run the pieces.
        Interrupted: on Ctrl-C; the state is stored.
    """
    # start-up time: these import xarray
    from deodar.recording import files
    from deodar.recording.record import about
    from deodar.recording.repeat import differences, request, world_of

    use_resources(on, "dd.resume", "cluster", "progress")
    path = Path(path)
    record = files.open_record(path)
    if not files.grows(path):
        raise RecordError(
            "was written as a whole, without the states of its run, so it cannot be resumed",
            where=str(path),
            fix="Run its model again, with `out`",
        )
    description = about(record)
    model, settings = request(record, trust)
    whole = settings["duration"] if duration is None else float(duration)
    if whole < settings["duration"]:
        raise RecordError(
            f"the run is {settings['duration']:g} long; resuming cannot make it shorter", where=str(path)
        )
    if description.get("complete", True) and whole == settings["duration"]:
        raise RecordError(
            "is complete", where=str(path), fix=option("Give a longer one, for example", "duration", "1000")
        )
    hosts.require_one("resuming a run", hosts.count() > 1)
    run_request = dc.replace(SimulationRequest(**settings), duration=whole)
    resumed_on = None if on.cluster is None or _pieces(run_request) == 1 else Cluster.of(on.cluster)
    workers = run_request.on.workers if resumed_on is None else None
    run_request = dc.replace(
        run_request, on=dc.replace(run_request.on, workers=workers, progress=on.progress)
    )
    world = world or world_of(record)
    with _connected(resumed_on, run_request, world) as pool:
        if pool is None:
            device = devices.several(run_request.on.devices, run_request.on.device)[0]
            used = provenance.devices_of(description)  # it follows from the request
            made_by = provenance.made_by(device, Arithmetic.of(run_request.precision).precision, used)
        else:
            made_by = pool.made_by
        changes = differences(description, {**description, "made_by": made_by})
        if workers is not None:  # a worker process uses one core, however many this one uses
            changes = tuple(d for d in changes if d.what != "cores")
        if changes and (accept is None or not accept(changes)):
            raise RecordError(
                "was made by other versions or on another machine, so the rest would not have the same bits: "
                + "; ".join(map(str, changes)),
                where=str(path),
                fix=Fix(
                    "Accept the differences: accept=lambda differences: True", "Accept the differences: --yes"
                ),
            )
        out = RunOutput(Output(path), resume=True, cut=bool(changes))
        if whole > settings["duration"]:
            out.lengthen(whole)
        spread = None if pool is None else functools.partial(in_pool, pool)
        return warned(model, run_request, world, out, spread)


@contextlib.contextmanager
def _connected(
    cluster: Cluster | None, run_request: SimulationRequest, world: World | None
) -> Generator[ClusterPool | None]:
    """Connect to a cluster whose workers can run the pieces; None without a cluster.

    Raises:
        WorkerError: they cannot.
    """
    if cluster is None:
        yield None
        return
    used = {"devices": run_request.on.devices, "device": run_request.on.device}
    device = next((f"{name} = {value}" for name, value in used.items() if value not in (None, "cpu")), "")
    if device:
        raise WorkerError(
            f"the workers of a cluster use one core each, and the run has {device}",
            fix="Resume it without a cluster",
        )
    require_one_kind(cluster, world)
    with ClusterPool(cluster, Arithmetic.of(run_request.precision).precision) as pool:
        yield pool


def _pieces(run_request: SimulationRequest) -> int:
    """Return the number of pieces of a recorded run."""
    lengths: dict[str, int] = {}
    if run_request.trials is not None:
        lengths = {
            "trial": run_request.trials if isinstance(run_request.trials, int) else len(run_request.trials)
        }
    sweep = checked(run_request.sweep)
    if isinstance(sweep, Mapping):
        lengths |= {path: len(values) for path, values in sweep.items()}
    else:
        lengths |= {POINT: len(sweep.values)}
    return cut(lengths, 0, batch=run_request.on.batch).count
