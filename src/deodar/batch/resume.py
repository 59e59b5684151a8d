"""`resume`: continue a run from its record."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.batch.output import RunOutput
from deodar.batch.progress import Shown
from deodar.batch.request import SimulationRequest
from deodar.batch.simulate import warned
from deodar.compiler import device as devices
from deodar.errors import RecordError
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
) -> xarray.Dataset:
    """Continue a run that was killed or stopped, or make a complete one longer; return its record, opened.

    The run continues from the state that was stored last; samples after it are computed again. With the same
    versions on the same machine the record gets the same bits as that of an undisturbed run.

    Args:
        path: the record, or the folder of a run: what `out` of `simulate` named.
        duration: document time of the whole run; None: that of the record.
        world: the world of its sensors; None: that of the record, opened again.
        trust: whether functions that its document names may be imported and run.
        progress: as in `simulate`.
        accept: called with what differs from the versions and the machine of the record, if anything does;
            returns whether to continue. Samples after the stored state are then dropped at once. None:
            differences are an error.

    Raises:
        RecordError: the record is complete and not made longer, another process writes it, or versions or
            machine differ.
        Untrusted: its document names a function, and `trust` is not given.
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
    device = devices.several(settings["devices"], settings["device"])[0]
    used = provenance.devices_of(made)  # it follows from the request
    now = {**made, "made_by": provenance.made_by(device, settings["precision"], used)}
    found = differences(made, now)
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
    asked = SimulationRequest(**settings)
    return warned(model, dc.replace(asked, duration=whole), world or world_of(data), progress, out)
