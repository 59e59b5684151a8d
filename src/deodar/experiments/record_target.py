"""The store into which the pieces of an experiment write their records, one object for each piece.

A row names the object of its record, and is returned after the object was put. The name of an object depends
on the trials of its piece alone, so that a piece that runs twice puts the same object again.
"""

from __future__ import annotations

import hashlib
import socket
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import xarray

from deodar import codec, file_version, regular_file, sealed
from deodar.codec import Json, JsonObject
from deodar.errors import (
    Fix,
    OutputError,
    OutputExists,
    ParameterError,
    RecordError,
    WorkerError,
    first_line,
    option,
    reading,
)
from deodar.experiments.rows import Row, different
from deodar.model import output
from deodar.recording.archive import ArchiveWriter
from deodar.recording.record_store import AGAIN, RecordStore
from deodar.recording.store_address import StoreAddress

RECORD = "record"
"""Key of the object of a row: its name, its size in bytes and its checksum (CRC-32C)."""

MARK = "experiment.json"
"""Name of the file of a store that states its experiment."""

PLACE = "records.json"
"""Name of the file beside the rows that states the address of the store, without credentials."""

OBJECTS = "records"
"""Name of the folder of the objects."""

SUFFIX = ".zarr.zip"

TRIALS_A_FOLDER = 1000
"""Trials whose objects are in one folder: a folder has at most as many entries."""

VERSION = 1
"""Version of the store and its objects."""

OBJECT_VERSION = "deodar_records"
"""Name of the attribute with the version of an object."""


@dataclass(frozen=True)
class RecordTarget:
    """A store that is ready for the records of one experiment; it can be sent to other processes.

    Attributes:
        address: where it is.
        mark: content of the file that states the experiment; a process that cannot read it does not see the
            store.
    """

    address: StoreAddress
    mark: bytes = field(repr=False)

    def require_seen(self) -> None:
        """Raise OutputError unless this process sees the store; called before the trials of each piece."""
        try:
            mark = self.address.open().get(MARK)
        except RecordError as error:
            raise OutputError(error.problems[0].what, where=self.address.shown, fix=AGAIN) from None
        if mark != self.mark:
            problem = "does not see the store of the records" if mark is None else "sees another store"
            raise OutputError(
                f"the process on {socket.gethostname()} {problem}: {MARK} in it is"
                f" {'missing' if mark is None else 'of another experiment'}",
                where=self.address.shown,
                fix=f"Connect the store there. {AGAIN}",
            )

    def put(self, trials: Sequence[int], content: bytes) -> JsonObject:
        """Store the object of a piece; return its entry in the rows.

        Raises:
            OutputError: the store is full, read-only or gone.
        """
        store, name = self.address.open(), object_name(trials)
        if store.fades:
            self.require_seen()  # where it was unmounted meanwhile, an empty folder of this machine is left
        store.put(name, content)
        return {"object": name, "size": len(content), "crc32c": sealed.checksum(content)}


class PieceRecords:
    """The records of the trials of a piece, until they are put.

    Args:
        target: the store.
        trials: numbers of the trials.

    Raises:
        OutputError: this process does not see the store.
    """

    def __init__(self, target: RecordTarget, trials: Sequence[int]) -> None:
        target.require_seen()
        self._target, self._trials = target, trials
        self._writer = ArchiveWriter()
        self._entries: list[Json] = []

    def add(self, row: Row, records: Mapping[str, xarray.Dataset]) -> None:
        """Add the records of a trial: that of the trial under "", snapshots under their labels."""
        trial = int(row["trial"])
        groups: dict[str, str] = {}
        for number, (label, record) in enumerate(records.items()):
            groups[label] = f"{trial:08}" if not label else f"{trial:08}-snapshot-{number}"
            self._writer.add(groups[label], record)
        entry = {"trial": trial, "levels": row["levels"], "outcome": row["outcome"], "groups": groups}
        self._entries.append(codec.parse(codec.line(entry)))

    def put(self) -> JsonObject:
        """Store all records as one object; return its entry in the rows."""
        attributes = {OBJECT_VERSION: VERSION, file_version.KEY: file_version.HERE, "trials": self._entries}
        content = self._writer.close(attributes)
        return self._target.put(self._trials, content)


def object_name(trials: Sequence[int]) -> str:
    """Return the name of the object of a piece: its first and last trial; if there are gaps between its
    trials, also a digest of their numbers.

    >>> object_name(range(12340, 12360))
    'records/0012/00012340-00012359.zarr.zip'
    """
    first, last = trials[0], trials[-1]
    name = f"{first:08}-{last:08}"
    if list(trials) != list(range(first, last + 1)):
        name += f"-{hashlib.sha256(codec.line(list(trials)).encode()).hexdigest()[:12]}"
    return f"{OBJECTS}/{first // TRIALS_A_FOLDER:04}/{name}{SUFFIX}"


def claimed(
    address: StoreAddress,
    identity: Mapping[str, Json],
    rows: Mapping[str, Row],
    folder: Path,
    read: Callable[[JsonObject], JsonObject],
) -> RecordTarget:
    """Return the store of an experiment, which is made or continued.

    Args:
        address: where it is.
        identity: the identity of the experiment, as its rows state it.
        rows: the rows that exist.
        folder: their folder, which keeps the address.
        read: function that converts an identity to the present version.

    Raises:
        OutputExists: it holds records of another experiment, or something else.
        RecordError: rows exist whose records are not in it.
        OutputError: it cannot be written.
    """
    store = address.open()
    _require_objects(address, rows, folder)
    store.create()
    mark = _marked(store, identity)
    changed = different(identity, read(experiment_of(mark, address.shown)))
    if changed:
        raise OutputExists(
            f"holds records of another experiment: {', '.join(changed)} differ",
            where=address.shown,
            fix=option("Name another store:", "records", "STORE", "..."),
        )
    place = (codec.line({"store": address.shown}) + "\n").encode()
    if not (folder / PLACE).is_file() or regular_file.read_bytes(folder / PLACE) != place:
        output.write(folder / PLACE, place)
    return RecordTarget(address, mark)


def experiment_of(mark: bytes, where: str) -> JsonObject:
    """Return the identity of the experiment of a store.

    Raises:
        RecordError: the file that states it is damaged, of a later version, or that of a folder of rows.
    """
    try:
        content = codec.parse(mark)
        if not isinstance(content, dict):
            raise TypeError
        if "records" not in content and "limit" in content:
            raise RecordError(
                "is the folder of the rows of an experiment, and no store of records",
                where=where,
                fix="Name another folder for the store; records in files beside rows are read by"
                " dd.load_record",
            )
        version, identity = content["records"], content.get("experiment")
        with reading(where, RecordError):
            file_version.require_readable("a store", version, VERSION, identity, RecordError)
        if not isinstance(identity, dict):
            raise TypeError
    except (ValueError, LookupError, TypeError):
        raise RecordError(
            f"{MARK} in it is damaged, or of another program", where=where, fix="Name another store"
        ) from None
    return identity


def require_here(rows: Mapping[str, Row], folder: Path) -> None:
    """Refuse to continue rows whose records are in a store without naming it.

    Raises:
        RecordError: rows name objects of a store.
    """
    count = sum(RECORD in row for row in rows.values())
    if count:
        where = stored_place(folder) or "STORE"
        raise RecordError(
            f"the records of {count} trials are in the store {where}, which this call does not name",
            where=str(folder),
            fix=option("Continue with", "records", where, repr(where)),
        )


def require_visible(target: RecordTarget, answers: Sequence[str]) -> None:
    """Raise WorkerError unless every worker sees the store; `answers`: what `unseen` returned on each."""
    bad = next((text for text in answers if text), None)
    if bad is not None:
        raise WorkerError(
            f"a worker does not see the store of the records ({bad})",
            where=target.address.shown,
            fix="Use a store that all machines reach, with the same packages and settings of fsspec",
        )


def require_shared(address: StoreAddress) -> None:
    """Raise WorkerError if the store is in the memory of this process, which workers do not see."""
    if address.local:
        raise WorkerError(
            "the store of the records is in the memory of this process, which workers do not see",
            where=address.shown,
            fix="Use a folder or an object store, or run without workers",
        )


def unseen(target: RecordTarget) -> str:
    """Return why this process does not see a store; empty: it does."""
    try:
        target.require_seen()
    except (OutputError, RecordError, ParameterError) as error:
        return error.problems[0].what
    except Exception as error:  # packages of fsspec may raise any exception
        return target.address.hidden(f"{type(error).__name__}: {first_line(error)}")
    return ""


def stored_place(folder: Path) -> str:
    """Return the address of the store of the rows in a folder, without credentials; empty: there is none."""
    try:
        return str(codec.parse(regular_file.read_text(folder / PLACE))["store"])
    except (OSError, ValueError, LookupError, TypeError):
        return ""


def _marked(store: RecordStore, identity: Mapping[str, Json]) -> bytes:
    """Return the content of the file that states the experiment of a store; an empty store gets one."""
    names: list[str] = []
    for _ in range(2):
        mark = store.get(MARK)
        if mark is not None:
            return mark
        # a file under its first name may be this file, which another part of the experiment writes now
        names = sorted(name for name in store.sizes() if not name.rpartition("/")[2].startswith("."))
        if MARK not in names:
            break
    if names:
        raise OutputExists(
            f"is not a store of records, so nothing is written into it: it holds {names[0]}",
            where=store.shown,
            fix="Name an empty folder or address, or a new one",
        )
    mark = (codec.text({"records": VERSION, "experiment": dict(identity)}) + "\n").encode()
    store.put(MARK, mark)
    return mark


def _require_objects(address: StoreAddress, rows: Mapping[str, Row], folder: Path) -> None:
    """Refuse a store that lacks the records of rows."""
    if not rows:
        return
    objects, beside = dict[str, int](), 0
    for row in rows.values():
        if RECORD in row:
            objects[row[RECORD]["object"]] = row[RECORD]["size"]
        else:
            beside += 1
    if beside:
        raise RecordError(
            f"{beside} trials have rows whose records are not in a store, but in {OBJECTS}/ beside them",
            where=str(folder),
            fix=Fix(
                "Leave out records, or begin in another folder",
                "Leave out --records, or begin in another folder: --out",
            ),
        )
    sizes = address.open().sizes(OBJECTS)
    missing = sorted(name for name, size in objects.items() if sizes.get(name) != size)
    if missing:
        before = stored_place(folder)
        same = before in ("", address.shown)
        fix = Fix("Connect the store") if same else option("Continue with", "records", before, repr(before))
        raise RecordError(
            f"it lacks {len(missing)} of the {len(objects)} objects with the records of existing rows, the"
            f" first is {missing[0]}",
            where=address.shown,
            fix=fix.then("Or copy them there. To run all trials again, name another folder"),
        )
