"""The records of an experiment in a store, read trial by trial."""

from __future__ import annotations

import io
import os
import re
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from deodar import file_version, sealed
from deodar.errors import DeodarError, RecordError, RunWarning, did_you_mean, reading
from deodar.experiments import record_index
from deodar.experiments.record_index import INDEX, IndexedObject
from deodar.experiments.record_target import (
    MARK,
    OBJECT_VERSION,
    OBJECTS,
    PLACE,
    SUFFIX,
    VERSION,
    experiment_of,
    object_name,
    stored_place,
)
from deodar.recording.archive import Archive
from deodar.recording.record_store import RecordStore
from deodar.recording.store_address import StoreAddress
from deodar.summary import Summarised, Summary, counted

if TYPE_CHECKING:
    import xarray

_NAME = re.compile(r"(?:.*/)?(\d{8,})-(\d{8,})(-[0-9a-f]{12})?" + re.escape(SUFFIX))


class _Opened:
    """The object that was read last, which stays open for its next trial."""

    def __init__(self, store: RecordStore) -> None:
        self.store = store
        self.name = ""
        self.archive: Archive | None = None

    def __del__(self) -> None:
        self.close()

    def get(self, name: str) -> Archive:
        """Return an object, opened; raise RecordError if it is of a later version."""
        if self.archive is None or name != self.name:
            self.close()
            self.name = ""
            self.archive = Archive(self.store.open(name), f"{self.store.shown}/{name}")
            attributes = self.archive.attributes
            with reading(self.archive.where, RecordError):
                version = attributes.get(OBJECT_VERSION, 1)
                file_version.require_readable(
                    "an object of a store", version, VERSION, attributes, RecordError
                )
            self.name = name
        return self.archive

    def close(self) -> None:
        """Close the object."""
        archive, self.archive = self.archive, None
        if archive is not None:
            archive.close()


class StoredRecords(Summarised):
    """The records of an experiment by their trials, as `dd.open_records` returns them.

    `records[12]` reads the record of trial 12, as `dd.load_record` reads a file; of its object only the parts
    that it needs. `len(records)`, `12 in records` and `for trial in records` read no record. The object that
    was read last stays open until `close`, or the end of a `with` statement.
    """

    def __init__(self, store: RecordStore, objects: Mapping[int, IndexedObject], opened: _Opened) -> None:
        self._store, self._objects, self._opened = store, objects, opened

    def __getitem__(self, trial: int) -> xarray.Dataset:
        """Return the record of a trial.

        Raises:
            RecordError: there is none, or it is damaged.
        """
        return self._read(trial, "")

    def __iter__(self) -> Iterator[int]:
        """Return the numbers of the trials in their order."""
        return iter(self._objects)

    def __len__(self) -> int:
        """Return the number of trials."""
        return len(self._objects)

    def __contains__(self, trial: object) -> bool:
        """Return whether the store has a trial."""
        return trial in self._objects

    def _summary(self) -> Summary:
        return Summary(f"Records of {counted(len(self), 'trial')} in {self._store.shown}")

    def __enter__(self) -> Self:
        """Return these records."""
        return self

    def __exit__(self, *error: object) -> None:
        """Close the object that was read last."""
        self.close()

    def close(self) -> None:
        """Close the object that was read last; reading another trial opens one again."""
        self._opened.close()

    def levels(self, trial: int) -> Mapping[str, Any]:
        """Return the level of each factor in a trial."""
        record = self._object(trial)
        return self._attributes(record, trial)["levels"] if record.levels is None else record.levels[trial]

    def snapshots(self, trial: int) -> list[str]:
        """Return the labels of the snapshots of a trial."""
        return [label for label in self._attributes(self._object(trial), trial)["groups"] if label]

    def snapshot(self, trial: int, label: str) -> xarray.Dataset:
        """Return a snapshot of a trial.

        Raises:
            RecordError: there is none, or it is damaged.
        """
        return self._read(trial, label)

    def select(self, levels: Mapping[str, Any] | None = None, **named: Any) -> StoredRecords:
        """Return the records of the trials with these levels: `records.select(distance="near")`.

        Args:
            levels: levels by the names of their factors, for names that Python does not allow.
            named: the same as keywords.

        Raises:
            RecordError: there is no such factor, or no trial with these levels.
        """
        chosen = {**(levels or {}), **named}
        levels_of = {trial: self.levels(trial) for trial in self}
        for name in chosen:
            factors = list(next(iter(levels_of.values()), {}))
            if name not in factors:
                raise RecordError(
                    f"there is no factor {name!r}", where=self._store.shown, fix=did_you_mean(name, factors)
                )
        objects = {
            trial: self._objects[trial]
            for trial, level in levels_of.items()
            if all(level[name] == value for name, value in chosen.items())
        }
        if not objects:
            labels = {
                name: list(dict.fromkeys(level[name] for level in levels_of.values())) for name in chosen
            }
            raise RecordError(
                f"there is no trial with {_in_words(chosen)}",
                where=self._store.shown,
                fix="Levels: "
                + "; ".join(f"{n} {', '.join(map(str, values))}" for n, values in labels.items()),
            )
        return StoredRecords(self._store, objects, self._opened)

    def damaged(self) -> dict[str, str]:
        """Read all objects of these trials whole; return the damaged ones with the reasons.

        Sizes and checksums are compared with those of the index; without an index the checksums inside the
        objects are compared.
        """
        out: dict[str, str] = {}
        for record in dict.fromkeys(self._objects.values()):
            try:
                content = self._store.get(record.name)
                if content is None:
                    out[record.name] = "it is missing"
                elif not record.crc32c:
                    Archive(io.BytesIO(content), record.name).require_sound()
                elif len(content) != record.size:
                    out[record.name] = f"it has {len(content)} bytes, not {record.size}"
                elif sealed.checksum(content) != record.crc32c:
                    out[record.name] = "its checksum is that of another content"
            except RecordError as error:
                out[record.name] = error.problems[0].what
        return out

    def _object(self, trial: int) -> IndexedObject:
        if trial not in self._objects:
            of = f"trials {min(self._objects)} to {max(self._objects)}" if self._objects else "no trials"
            raise RecordError(
                f"there is no trial {trial!r}", where=self._store.shown, fix=f"It has {of} ({len(self)})"
            )
        return self._objects[trial]

    def _attributes(self, record: IndexedObject, trial: int) -> Mapping[str, Any]:
        archive = self._opened.get(record.name)
        try:
            return next(
                attributes for attributes in archive.attributes["trials"] if attributes["trial"] == trial
            )
        except (LookupError, TypeError, StopIteration):
            raise RecordError(f"holds no trial {trial}", where=archive.where) from None

    def _read(self, trial: int, label: str) -> xarray.Dataset:
        record = self._object(trial)
        groups: Mapping[str, str] = self._attributes(record, trial)["groups"]
        if label not in groups:
            labels = [name for name in groups if name]
            content = f"no snapshot {label!r}" if label else "only snapshots"
            raise RecordError(
                f"trial {trial} has {content}",
                where=self._store.shown,
                fix=f"Read one: snapshot({trial}, {labels[0]!r})" if labels else "",
            )
        return self._opened.get(record.name).read(groups[label])


def open_records(store: str | os.PathLike[str]) -> StoredRecords:
    """Open the records of an experiment that were written into a store.

    The index of the store is read, or the names of its objects if there is none yet; records are read when
    they are used.

    Args:
        store: the folder or address that `experiment.run(records=...)` or `--records` named; or the folder of
            the rows.

    Raises:
        RecordError: it is no store of records, or cannot be read.
        ParameterError: no installed package reads such addresses.

    Warns:
        RunWarning: the index is damaged, or a trial is in several objects.
    """
    address = StoreAddress.of(store)
    place = stored_place(Path(address.full)) if (Path(address.full) / PLACE).is_file() else ""
    address = StoreAddress.of(place) if place else address
    opened_store = address.open()
    mark = opened_store.get(MARK)
    if mark is None:
        raise RecordError(
            f"is not a store of records: it has no {MARK}",
            where=opened_store.shown,
            fix="Name the store that records=... named; records in files are read by dd.load_record",
        )
    experiment_of(mark, opened_store.shown)
    opened, objects = _Opened(opened_store), dict[int, IndexedObject]()
    try:
        for record, trials in _objects(opened_store, opened):
            for trial in trials:
                if objects.setdefault(trial, record) is not record:
                    names = f"{objects[trial].name} and in {record.name}"
                    _warn(f"{opened_store.shown}: trial {trial} is in {names}")
    finally:
        opened.close()
    return StoredRecords(opened_store, dict(sorted(objects.items())), opened)


def _objects(store: RecordStore, opened: _Opened) -> Iterator[tuple[IndexedObject, list[int]]]:
    """Yield the objects of a store with their trials."""
    content = store.get(INDEX)
    if content is not None:
        try:
            for record in record_index.parse(content):
                yield record, list(record.levels or {})
            return
        except ValueError:
            _warn(f"{store.shown}/{INDEX} is damaged, so that the objects of the store are listed instead")
    for name, size in sorted(store.sizes(OBJECTS).items()):
        match = _NAME.fullmatch(name)
        if match is None:
            continue  # a file under its first name
        record = IndexedObject(name, size, "", None)
        trials = list(range(int(match[1]), int(match[2]) + 1))
        if match[3]:
            trials = _listed(opened, name)
        if trials and object_name(trials) == name:
            yield record, trials


def _listed(opened: _Opened, name: str) -> list[int]:
    """Return the trials that the metadata of an object state; none if it is damaged."""
    try:
        return [int(attributes["trial"]) for attributes in opened.get(name).attributes["trials"]]
    except (DeodarError, LookupError, TypeError, ValueError):
        _warn(f"{opened.store.shown}/{name} is damaged, and its trials are left out")
        return []


def _in_words(levels: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in levels.items())


def _warn(message: str) -> None:
    warnings.warn(message, RunWarning, stacklevel=3)
