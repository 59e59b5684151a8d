"""Sessions that continue a recorded run from one of its moments."""

from __future__ import annotations

import dataclasses as dc
import functools
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar import codec
from deodar.errors import RecordError, TimeError
from deodar.model import find
from deodar.model.migrations import VALUES_CHANGED, kind_lookup, value_of_3
from deodar.model.model import Model
from deodar.progress import telling
from deodar.resources import Resources, use_resources
from deodar.session.journal import Change, from_file, repeat_changes, until
from deodar.session.run import whole
from deodar.session.session import Session
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray

    from deodar.model.document import Document


def session_at(
    path: str | Path,
    time: float,
    world: World | None = None,
    trust: bool = False,
    on: Resources = Resources(),
) -> Session:
    """Return a session in the state that a recorded run had at a time.

    The run is repeated from its start, with the changes of a recorded session, and compared with the last
    sample of each port up to that time. The session continues with the same noise.

    Args:
        path: the record of a single run, or of a session from its start.
        time: document time; a whole number of steps after the start.
        world: the world of its sensors; None: that of the record, opened again.
        trust: whether functions that its document names may be imported and run.
        on: its `progress` counts the steps that are taken.

    Raises:
        RecordError: the record has several trials or points of a sweep, or began during a session, or a
            change in it cannot be repeated; or the repeated run has other values than the record.
        TimeError: the time is before the start or after the end of the record, or not a whole number of
            steps after the start.
        Untrusted: its document names a function, and `trust` is not given.
    """
    # start-up time: these import xarray
    from deodar.recording import files
    from deodar.recording.record import about
    from deodar.recording.repeat import request, world_of

    progress = use_resources(on, "dd.session_at", "progress").progress
    stored = files.open_record(Path(path))
    description = about(stored)
    changes: list[Change] = []
    if "session" in description:
        model, settings = _of_session(stored, description, trust)
        changes = _changes(stored, description, model.document)
    else:
        model, settings = request(stored, trust)
    if settings.get("trials") is not None or settings.get("sweep"):
        raise RecordError(
            "has several trials or points of a sweep, which were computed together; a session of one of them"
            " would have other last digits",
            where=str(path),
            fix="Record a single run",
        )
    world = world or world_of(stored)
    resources = dc.replace(settings["on"], workers=None, batch=None)
    session = Session(model, settings["dt"], settings["seed"], settings["precision"], world, on=resources)
    tick = whole(time - session.time, session.dt, "the time from the start")
    _require_recorded(stored, time, description, session.time + settings.get("duration", 0.0), str(path))
    stops = _comparisons(session, stored, time, str(path))
    with telling(progress, "repeating", "steps") as tell:
        repeat_changes(session, until(changes, tick), tick, tell, stops)
    return session


def _changes(data: xarray.Dataset, description: Any, doc: Document) -> list[Change]:
    """Return the changes of a recorded session; their values are of the version of its document."""
    entries: Any = codec.parse(str(data.attrs.get("changes", "[]")))
    if description["document"]["deodar"] < VALUES_CHANGED:
        kind_of = kind_lookup(doc)
        entries = [e | {"value": value_of_3(e["what"], e["value"], kind_of)} for e in entries]
    return list(map(from_file, entries))


def _of_session(data: xarray.Dataset, description: Any, trust: bool) -> tuple[Model, dict[str, Any]]:
    from deodar.recording import provenance  # start-up time: this imports xarray

    if description["session"]["tick"] != 0:
        raise RecordError(
            f"began at step {description['session']['tick']} of a session, whose state it does not contain",
            fix="Start recording before the first step, or save a snapshot",
        )
    settings = {key: description[key] for key in ("dt", "seed", "precision")}
    several = (devices := provenance.devices_of(description)) > 1
    settings["on"] = (
        Resources(description["made_by"]["device"].split()[0], devices) if several else Resources()
    )
    return Model(document=provenance.document(description), trusted=trust), settings


def _require_recorded(data: xarray.Dataset, time: float, description: Any, end: float, where: str) -> None:
    """Raise TimeError for a time of which the record does not describe the run.

    A complete run is described up to its `end`; a session, and a run that is still written, up to its last
    sample, because later changes may be missing.
    """
    if "session" in description or not description.get("complete", True):
        end = max((times[-1] for _, _, times in _samples(data) if len(times)), default=0.0)
    if time > end:
        raise TimeError(f"the record ends at {end:g}, before {time:g}", where=where)


def _samples(data: xarray.Dataset) -> Iterator[tuple[str, str, np.ndarray]]:
    """Yield name, time dimension and times of each recorded port."""
    from deodar.recording.record import time_dimension  # start-up time: this imports xarray

    for name, variable in data.data_vars.items():
        dimension = time_dimension(variable)
        if dimension is not None:
            yield str(name), dimension, np.asarray(data[dimension].values)


def _comparisons(
    session: Session, data: xarray.Dataset, time: float, where: str
) -> dict[int, Callable[[], None]]:
    """Return for ticks a function that raises RecordError if the record has other values than the session.

    Each port is compared with its last sample up to `time`.
    """
    ports: dict[int, list[tuple[str, str, int]]] = {}
    for name, dimension, times in _samples(data):
        k = int(np.searchsorted(times, time + 0.5 * session.dt)) - 1
        if k >= 0:
            tick = session.tick + round((float(times[k]) - session.time) / session.dt)
            ports.setdefault(tick, []).append((name, dimension, k))

    def compare(tick: int) -> None:
        for name, dimension, k in ports[tick]:
            entry, port = find.port(session.document, name)
            recorded = data[name].isel({dimension: k}).values
            if recorded.tobytes() != session.read(f"{entry.path}.{port}").tobytes():
                raise RecordError(
                    f"the repeated run has other values of {name} at {session.time:g} than the record",
                    where=where,
                    fix="Use the versions and the machine of the record; deodar run RECORD lists them",
                )

    return {tick: functools.partial(compare, tick) for tick in ports}
