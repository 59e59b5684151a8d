"""`resume`: continue a run from its record."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
from collections.abc import Callable, Generator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar.batch.cluster import Cluster
from deodar.batch.cluster_pieces import in_pool, require_one_kind
from deodar.batch.on_cluster import ClusterPool
from deodar.batch.pieces import cut
from deodar.batch.points import POINT
from deodar.batch.progress import Shown
from deodar.batch.run_file import RunOutput
from deodar.batch.simulate import warned
from deodar.batch.simulation_request import SimulationRequest
from deodar.compiler import device as devices
from deodar.compiler import hosts
from deodar.errors import RecordError, WorkerError
from deodar.recording import provenance
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray

    from deodar.recording.repeat import Difference


def resume(
    path: str | Path,
    duration: float | None = None,
    world: World | None = None,
    trust: bool = False,
    progress: Shown = None,
    accept: Callable[[tuple[Difference, ...]], bool] | None = None,
    cluster: Cluster | str | None = None,
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
        progress: as in `simulate`.
        accept: called with what differs from the versions and the machine of the record, if anything does;
            returns whether to continue. Samples after the stored state are then dropped at once. None:
            differences are an error. On a cluster the versions and the machine are those of its workers.
        cluster: workers on this or many machines that share the remaining pieces, as in `simulate`; a run in
            one piece continues in this process.

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

    path = Path(path)
    data = files.open_record(path)
    if not files.grows(path):
        raise RecordError(
            "was written as a whole, without the states of its run, so it cannot be resumed",
            where=str(path),
            fix="Run its model again, with `out`",
        )
    made = about(data)
    model, settings = request(data, trust)
    whole = settings["duration"] if duration is None else float(duration)
    if whole < settings["duration"]:
        raise RecordError(
            f"the run is {settings['duration']:g} long; resuming cannot make it shorter", where=str(path)
        )
    if made.get("complete", True) and whole == settings["duration"]:
        raise RecordError(
            "is complete", where=str(path), fix="Give a longer duration, for example --duration 1000"
        )
    hosts.require_one("resuming a run", hosts.count() > 1)
    there = None if cluster is None else Cluster.of(cluster)
    if _pieces(settings) == 1:
        there = None
    elif there is not None:
        settings["workers"] = None
    world = world or world_of(data)
    with _connected(there, settings, world) as pool:
        if pool is None:
            device = devices.several(settings["devices"], settings["device"])[0]
            used = provenance.devices_of(made)  # it follows from the request
            made_by = provenance.made_by(device, settings["precision"], used)
        else:
            made_by = pool.made_by
        found = differences(made, {**made, "made_by": made_by})
        if settings["workers"] is not None:  # a worker process uses one core, however many this one uses
            found = tuple(d for d in found if d.what != "cores")
        if found and (accept is None or not accept(found)):
            raise RecordError(
                "was made by other versions or on another machine, so the rest would not have the same bits: "
                + "; ".join(map(str, found)),
                where=str(path),
                fix="Accept the differences: --yes, or accept=lambda differences: True",
            )
        out = RunOutput(path, resume=True, cut=bool(found))
        if whole > settings["duration"]:
            out.lengthen(whole)
        asked = dc.replace(SimulationRequest(**settings), duration=whole)
        spread = None if pool is None else functools.partial(in_pool, pool)
        return warned(model, asked, world, progress, out, spread)


@contextlib.contextmanager
def _connected(
    cluster: Cluster | None, settings: Mapping[str, Any], world: World | None
) -> Generator[ClusterPool | None]:
    """Connect to a cluster whose workers can run the pieces; None without a cluster.

    Raises:
        WorkerError: they cannot.
    """
    if cluster is None:
        yield None
        return
    given = next((name for name in ("devices", "device") if settings[name] not in (None, "cpu")), "")
    if given:
        raise WorkerError(
            f"the workers of a cluster use one core each, and the run has {given} = {settings[given]}",
            fix="Resume it without a cluster",
        )
    require_one_kind(cluster, world)
    with ClusterPool(cluster, settings["precision"]) as pool:
        yield pool


def _pieces(settings: Mapping[str, Any]) -> int:
    """Return the number of pieces of a run, from the settings of its record."""
    trials, sweep = settings["trials"], settings["sweep"] or {}
    lengths: dict[str, int] = {} if trials is None else {"trial": len(trials)}
    if isinstance(sweep, Mapping):
        lengths |= {path: len(values) for path, values in sweep.items()}
    else:
        lengths |= {POINT: len(sweep)}
    return cut(lengths, 0, batch=settings["batch"]).count
