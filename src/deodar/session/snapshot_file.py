"""Snapshots of sessions as files, read by other processes."""

from __future__ import annotations

import base64
import dataclasses as dc
from pathlib import Path
from typing import Any

import numpy as np

from deodar.errors import RecordError
from deodar.model import document_files, output
from deodar.model.model import Model
from deodar.parameters import show
from deodar.recording import provenance, stored
from deodar.session.checkpoint import world_from_file, world_to_file
from deodar.session.clock import Clock
from deodar.session.session_snapshot import SessionSnapshot, StateRow

KIND = "snapshot of a session"


def save_snapshot(snapshot: SessionSnapshot, path: str | Path, force: bool = False) -> Path:
    """Write a snapshot of a session to a file, which `load_snapshot` reads, also in another process.

    It holds the document, the states of all elements with their learned weights, the clock, the seed and the
    state of the world. The noise follows from seed and tick.

    Args:
        snapshot: what `Session.snapshot` returned.
        path: the file; .npz is the usual ending.
        force: whether to replace an existing file.

    Raises:
        OutputExists: the file exists.
        OutputError: it cannot be written.
        RecordError: the world keeps something that a file cannot hold.
    """
    if not isinstance(snapshot, SessionSnapshot):
        raise RecordError(
            f"expected a snapshot, got {show(snapshot)}", fix="Take one with session.snapshot()"
        )
    place = output.claim(path, force)
    arrays: list[np.ndarray] = []

    def append(row: StateRow) -> list[str]:
        arrays.extend(np.asarray(values) for values in row.values())
        return list(row)

    rows = {ident: [append(visible), append(coming)] for ident, (visible, coming) in snapshot.states.items()}
    document, document_arrays = document_files.to_data(snapshot.document)
    world, world_arrays = world_to_file(snapshot.world)
    header = {
        "document": document,
        "arrays": base64.b64encode(document_files.pack(document_arrays)).decode() if document_arrays else "",
        "rows": rows,
        "clock": dc.asdict(snapshot.clock),
        "seed": snapshot.seed,
        "precision": snapshot.precision,
        "world": world,
    }
    stored.write(place, header, [*arrays, *world_arrays], KIND)
    output.note(place)
    return place


def load_snapshot(path: str | Path, trust: bool = False) -> SessionSnapshot:
    """Read a snapshot for `Session.restore`.

    The session must have the model of the snapshot or one with common elements, its precision, and a world of
    its kind if it had one.

    Args:
        path: the file.
        trust: whether functions that its document names may be imported.

    Raises:
        RecordError: there is no such file, it is damaged, or of a newer version.
        Untrusted: its document names a function, and `trust` is not given.
    """
    header: Any
    header, arrays = stored.read(Path(path), KIND)
    try:
        document = Model(document=provenance.document(header), trusted=trust).document
        unread = iter(arrays)
        states = {
            ident: tuple({name: next(unread) for name in names} for names in pair)
            for ident, pair in header["rows"].items()
        }
        world = world_from_file(header["world"], list(unread))
        clock, seed, precision = Clock(**header["clock"]), int(header["seed"]), str(header["precision"])
    except (KeyError, TypeError, ValueError, StopIteration, RuntimeError) as error:
        raise RecordError(
            f"is damaged: its content cannot be read ({type(error).__name__}: {error})", where=str(path)
        ) from None
    return SessionSnapshot(document, states, clock, seed, precision, world)  # type: ignore[arg-type]
