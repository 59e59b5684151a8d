"""A Zarr record that is written during a run.

The files are those of every Zarr record of deodar; the arrays grow along their dimensions of time. Chunks are
written first (`chunks.py`), each beside its final name and then renamed. One file commits them: `zarr.json`
of the group, which states the length of every array (Zarr's consolidated metadata) and is replaced as a
whole. So a reader finds all arrays up to one moment at any time, also after the writer was killed. Each chunk
has a checksum (CRC-32C).

A thread writes, twice a second. The last chunk of an array, which is not full yet, is written again each
time; the samples behind the end of the array are NaN. If the disk is full, as many of the waiting samples as
fit are written and committed before the error is raised.
"""

from __future__ import annotations

import contextlib
import math
import os
import threading
import time
import warnings
from collections.abc import Callable, Generator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray
import zarr

from deodar import codec, regular_file
from deodar.errors import DamagedFile, DeodarError, OutputError, Problem
from deodar.model import output
from deodar.recording import group_file, places, portable, writer_lock
from deodar.recording.chunks import COMPRESSORS, ChunkedArray
from deodar.recording.provenance import KEY

FLUSH_SECONDS = 0.4
"""Longest time between two commits, in seconds; with a chunk of a run (0.2 s) less than a second is lost."""

CHUNK_BYTES = 2**20
"""Bytes of a chunk before compression.

A guess: small enough to read one frame, large enough for few files.
"""

METADATA_SECONDS = 5.0
"""Time between two updates of the metadata of single arrays, in seconds.

Only readers that ignore the metadata of the group need them: a guess.
"""

LONGEST_CHUNK = 8192
"""Largest number of samples in a chunk."""

PENDING_BYTES = 64 * 2**20
"""Bytes that wait to be written at most; a run that is faster than the disk waits."""

Region = tuple[slice, ...]
"""The copies (points of a sweep, trials) that samples belong to: a slice of each leading dimension."""


TailKey = tuple[str, tuple[tuple[int, int], ...]]
"""An array and a region of it."""


class _Samples(NamedTuple):
    """Samples that wait: values of `arrays` (by name) at `times`, from number `first` on."""

    dimension: str
    first: int
    times: np.ndarray
    arrays: Mapping[str, np.ndarray]
    region: Region


class _Tail:
    """The last chunks of an array in one region, as far as they are known."""

    def __init__(
        self, array: ChunkedArray, axis: int, region: Region, samples_known: Callable[[], int]
    ) -> None:
        self.array, self.axis, self.samples_known = array, axis, samples_known
        self.frames = array.chunks[axis]
        self.start = -1
        bounds = [part.indices(n)[:2] for part, n in zip(region, array.shape, strict=False)]
        self.lead = [first for first, _ in bounds]
        self.shape = [*(stop - first for first, stop in bounds), self.frames, *array.shape[axis + 1 :]]
        self.values = np.empty(0)
        self.dirty = False

    def add(self, first: int, values: np.ndarray) -> None:
        """Add samples from number `first` on; chunks that are full are written."""
        taken, count, lead = 0, values.shape[self.axis], (slice(None),) * self.axis
        while taken < count:
            chunk = (first + taken) // self.frames * self.frames
            inside = first + taken - chunk
            n = min(self.frames - inside, count - taken)
            part = values[*lead, taken : taken + n]
            if n == self.frames:
                if chunk != self.start:
                    self.write()
                self._store(chunk, part)
                self.start, self.dirty = -1, False
            else:
                if chunk != self.start:
                    self.write()
                    self._begin(chunk)
                self.values[*lead, inside : inside + n] = part
                self.dirty = True
            taken += n

    def write(self) -> None:
        """Write the chunks."""
        if self.dirty:
            self._store(self.start, self.values)
            self.dirty = False

    def _store(self, chunk: int, values: np.ndarray) -> None:
        start = [*self.lead, chunk, *[0] * (len(self.shape) - self.axis - 1)]
        try:
            self.array.store(start, values)
        except DamagedFile as error:
            raise self._damaged(chunk, error) from None

    def _begin(self, chunk: int) -> None:
        """Begin chunks; the samples that the files have of them are read."""
        self.start = chunk
        if not self.values.size:
            self.values = np.empty(self.shape, self.array.dtype)
        self.values.fill(self.array.fill)
        stored = min(self.samples_known(), chunk + self.frames) - chunk
        if stored > 0:
            lead = (slice(None),) * self.axis
            start = [*self.lead, chunk, *[0] * (len(self.shape) - self.axis - 1)]
            shape = [*self.shape[: self.axis], stored, *self.shape[self.axis + 1 :]]
            try:
                self.values[*lead, :stored] = self.array.load(start, shape)
            except DamagedFile as error:
                raise self._damaged(chunk, error) from None

    def _damaged(self, chunk: int, error: DamagedFile) -> DamagedFile:
        return DamagedFile(
            f"is damaged: samples {chunk} to {chunk + self.frames} of {self.array.name} cannot be read"
            f" ({error.problems[0].what})",
            fix="Run it again",
        )


class GrowingRecord:
    """Writer of a record that grows; one process writes a record at a time.

    Args:
        path: the Zarr folder, which does not exist yet.
        empty: the record without samples: every growing dimension has length 0.
        growing: names of the growing dimensions, each with its coordinate of times.
        piece: for each leading dimension the number of copies that are written together.

    Raises:
        OutputError: the record cannot be written.
    """

    def __init__(
        self,
        path: Path,
        empty: xarray.Dataset,
        growing: Sequence[str] = ("time",),
        piece: Mapping[str, int] | None = None,
    ) -> None:
        self.path = path
        with _writing(path):  # a reader finds the whole record, or none
            places.write_folder(path, lambda beside: _create(beside, empty, growing, piece or {}))
        self._open(dict.fromkeys(growing, 0))

    @classmethod
    def resumed(
        cls,
        path: Path,
        lengths: Mapping[str, int],
        settings: Mapping[str, Any] | None = None,
        cut: bool = False,
    ) -> GrowingRecord:
        """Return a writer that continues an incomplete record, after `lengths` samples of each dimension.

        Later samples of the record stay until they are written again or the record is complete.

        Args:
            path: the record.
            lengths: number of samples of each growing dimension; 0 where a dimension is left out.
            settings: entries of the provenance that change from now on.
            cut: whether later samples are dropped at once: they are not those that the rest will have.

        Raises:
            RecordError: another process writes the record.
        """
        self = cls.__new__(cls)
        self.path = path
        self._open(lengths, {**(settings or {}), "complete": False}, cut)
        return self

    def _open(
        self, lengths: Mapping[str, int], settings: Mapping[str, Any] | None = None, cut: bool = False
    ) -> None:
        path = self.path
        self._lock = writer_lock.lock(path)
        try:
            with _writing(path):
                self._read(path, lengths)
                if settings is not None:
                    self._settle(settings)
                    if cut:
                        self.sample_counts = dict(self.lengths)
                    self._commit(self.lengths)
        except BaseException:
            self._unlock()
            raise
        self._tails: dict[TailKey, _Tail] = {}
        # samples of each dimension whose times are written; all pieces of a run have the same times
        self._timed = dict(self.lengths)
        self._waiting: list[_Samples] = []
        self._bytes = 0
        self._changed = threading.Condition()
        self._closing = False
        # commits that were asked for, and those that are in the file
        self._requested = self._committed = 0
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._loop, name="deodar-record", daemon=True)
        self._thread.start()

    def _read(self, path: Path, lengths: Mapping[str, int]) -> None:
        """Read the layout of the record, and open its arrays."""
        self._group: Any = group_file.read(path)
        layout = codec.parse(self._group["attributes"][portable.KEY])
        stored = {old: new for new, old in layout["names"].items()}
        self._names = stored
        self._arrays: dict[str, ChunkedArray] = {}
        self._axis: dict[str, int] = {}
        self._dimension: dict[str, str] = {}
        members = self._group["consolidated_metadata"]["metadata"]
        for name, layout_entry in layout["variables"].items():
            if dimension := layout_entry.get("grows"):
                self._arrays[name] = ChunkedArray(path / name, members[name])
                self._dimension[name] = dimension
                dims = [layout["names"].get(d, d) for d in members[name]["dimension_names"]]
                self._axis[name] = dims.index(dimension)
        self.lengths = {dimension: int(lengths.get(dimension, 0)) for dimension in self._dimension.values()}
        self.sample_counts = {
            dimension: int(members[name]["shape"][self._axis[name]])
            for name, dimension in self._dimension.items()
        }
        self._inode = (path / "zarr.json").stat().st_ino
        self._updated = time.monotonic()

    def _unlock(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def _settle(self, settings: Mapping[str, Any]) -> None:
        """Set entries of the provenance."""
        provenance = {**codec.parse(self._group["attributes"][KEY]), **settings}
        self._group["attributes"][KEY] = codec.line(provenance)

    # ---------------------------------------------------------------------------------- in the run's thread

    def put(
        self,
        dimension: str,
        times: np.ndarray,
        arrays: Mapping[str, np.ndarray],
        first: int | None = None,
        region: Region = (),
    ) -> None:
        """Add samples; the thread of the record writes them within FLUSH_SECONDS.

        Args:
            dimension: the growing dimension.
            times: times of the samples.
            arrays: values by name of the variable: the copies of the region, the samples, the axes. They are
                written later, so they may not be changed.
            first: number of the first sample; None: they follow the last ones.
            region: the copies that the values belong to.

        Raises:
            OutputError: an earlier sample could not be written. What was committed stays readable.
        """
        arrays = {name: _held(array) for name, array in arrays.items()}
        with self._changed:
            self._changed.wait_for(lambda: self._bytes < PENDING_BYTES or self._error is not None)
            self._require()
            start = self.lengths[dimension] if first is None else first
            self._waiting.append(_Samples(dimension, start, times, arrays, region))
            self._bytes += sum(array.nbytes for array in arrays.values())
            self.lengths[dimension] = max(self.lengths[dimension], start + len(times))
            if self._bytes > PENDING_BYTES // 2:
                self._changed.notify_all()

    def commit(self) -> None:
        """Wait until all samples so far are in the file.

        Raises:
            OutputError: a sample could not be written.
        """
        with self._changed:
            self._requested = mine = self._requested + 1
            self._changed.notify_all()
            self._changed.wait_for(lambda: self._committed >= mine or self._error is not None)
            self._require()

    def close(
        self,
        complete: bool,
        more: xarray.Dataset | None = None,
        settings: Mapping[str, Any] | None = None,
    ) -> None:
        """Write what waits, and close the record.

        Args:
            complete: whether the run came to its end.
            more: coordinates and attributes to add.
            settings: entries of the provenance that have changed.

        Raises:
            OutputError: a sample could not be written; the record stays readable up to the last commit.
        """
        with self._changed:
            self._closing = True
            self._changed.notify_all()
        self._thread.join()
        try:
            self._require()
            self._require_present()
            with _writing(self.path):
                self._settle({**(settings or {}), "complete": complete})
                if complete:  # what an earlier run had written beyond is dropped
                    self.sample_counts = dict(self.lengths)
                self._resize()
                if more is not None:
                    self._add(more)
                self._commit(self.lengths)
                output.sync_tree(self.path)
        finally:
            self._unlock()
        if complete:
            output.note(self.path)

    def annotate(self, name: str, text: str) -> None:
        """Set an attribute of the record; it is in the file after the next commit."""
        with self._changed:
            layout = codec.parse(self._group["attributes"][portable.KEY])
            layout["attributes"][name] = None
            attributes = {
                **self._group["attributes"],
                name: text,
                portable.KEY: codec.line(layout, ascii=True),
            }
            self._group = {**self._group, "attributes": attributes}
            self._requested += 1
            self._changed.notify_all()

    def abandon(self) -> None:
        """Close the record after an error: what was committed stays, and errors are not raised again."""
        with contextlib.suppress(DeodarError):
            self.close(False)

    def blank(self, copy: Sequence[int]) -> None:
        """Set all values of one copy to NaN; called after `commit`."""
        self.erase(tuple(slice(k, k + 1) for k in copy), 0)

    def erase(self, region: Region, first: int) -> None:
        """Set the values of copies to NaN, from sample number `first` on.

        Called after `commit`, or before the first sample is added.
        """
        with _writing(self.path):
            for name, array in self._arrays.items():
                count = self.sample_counts[self._dimension[name]] - first
                if (axis := self._axis[name]) and count > 0:  # not the times
                    copies = [part.stop - part.start for part in region]
                    shape = [*copies, count, *array.shape[axis + 1 :]]
                    start = [*(part.start for part in region), first, *[0] * (len(shape) - axis - 1)]
                    array.store(start, np.broadcast_to(array.dtype.type(np.nan), shape))

    def _resize(self) -> None:
        """Write the lengths into the metadata of each array, and remove the chunks behind its end."""
        self._update_arrays()
        for name, dimension in self._dimension.items():
            array: Any = zarr.open_array(self.path / name, mode="r+")
            shape = list(array.shape)
            shape[self._axis[name]] = max(self.lengths[dimension], self.sample_counts[dimension])
            array.resize(tuple(shape))

    def _update_arrays(self) -> None:
        """Write the metadata of each array, with the lengths of the last commit."""
        for name in self._dimension:
            member = self._group["consolidated_metadata"]["metadata"][name]
            output.replace(self.path / name / "zarr.json", codec.line(member).encode())
        self._updated = time.monotonic()

    def _add(self, extra: xarray.Dataset) -> None:
        """Write further coordinates, and attributes, into the folder and the metadata of the group."""
        stored = portable.pack(extra, narrow=False)
        layout = codec.parse(self._group["attributes"][portable.KEY])
        new = codec.parse(stored.attrs.pop(portable.KEY))
        for name in (str(n) for n in stored.coords if n not in stored.sizes):
            zarr.create_array(
                self.path / name,
                overwrite=True,
                data=stored[name].values,
                dimension_names=[str(d) for d in stored[name].dims],
                attributes=dict(stored[name].attrs),
            )
            member = codec.parse(regular_file.read_text(self.path / name / "zarr.json"))
            self._group["consolidated_metadata"]["metadata"][name] = member
            layout["variables"][name] = new["variables"][name]
            layout["coords"] = [*(c for c in layout["coords"] if c != name), name]
            layout["names"] |= {k: v for k, v in new["names"].items() if k == name}
        layout["attributes"] |= new["attributes"]
        self._group["attributes"] |= {**stored.attrs, portable.KEY: codec.line(layout, ascii=True)}

    def _require(self) -> None:
        if self._error is not None:
            raise self._error

    # ------------------------------------------------------------------------------- in the record's thread

    def _loop(self) -> None:
        closing, due = False, time.monotonic() + FLUSH_SECONDS
        while not closing:
            with self._changed:
                self._changed.wait_for(
                    lambda: (
                        self._closing or self._requested > self._committed or self._bytes > PENDING_BYTES // 2
                    ),
                    max(0.0, due - time.monotonic()),
                )
                due = time.monotonic() + FLUSH_SECONDS  # from here on: writing may take long
                waiting, self._waiting = self._waiting, []
                closing, requested, lengths = self._closing, self._requested, dict(self.lengths)
            try:
                if waiting or requested > self._committed:
                    with _writing(self.path):
                        self._write_all(waiting, lengths)
            except BaseException as error:
                with self._changed:
                    self._error = error
                    self._changed.notify_all()
                return
            with self._changed:
                self._bytes -= sum(a.nbytes for samples in waiting for a in samples.arrays.values())
                self._committed = requested
                self._changed.notify_all()

    def _write_all(self, waiting: Sequence[_Samples], lengths: Mapping[str, int]) -> None:
        """Write samples; if the system refuses, write as many of them as fit before the error is raised."""
        committed = self.sample_counts
        try:
            self._write(waiting, lengths)
        except (OSError, OutputError):
            self.sample_counts = committed
            with contextlib.suppress(OSError, OutputError):
                for samples in waiting:
                    self._write_what_fits(samples)
            raise

    def _write_what_fits(self, samples: _Samples) -> None:
        """Write the first of some samples, fewer with each attempt that the system refuses.

        Raises:
            OSError, OutputError: not all of them fit; the others are committed.
        """
        count = len(samples.times)
        while len(samples.times):
            self._drop_uncommitted()
            committed, part = self.sample_counts, self._some(samples, slice(count))
            end = {samples.dimension: samples.first + count}
            try:
                self._write([part], committed | end)
            except (OSError, OutputError):
                self.sample_counts = committed
                if count == 1:
                    raise
                count = count * 3 // 4
            else:
                samples = self._some(samples, slice(count, None))
                count = min(count, len(samples.times))

    def _some(self, samples: _Samples, part: slice) -> _Samples:
        """Return a part of some samples."""
        arrays = {
            name: values[*(slice(None),) * self._axis[self._names.get(name, name)], part]
            for name, values in samples.arrays.items()
        }
        first = samples.first + (part.start or 0)
        return samples._replace(first=first, times=samples.times[part], arrays=arrays)

    def _drop_uncommitted(self) -> None:
        """Remove the chunks without a sample of the last commit, which makes room."""
        self._require_present()
        self._tails = {}
        self._timed = {d: min(n, self.sample_counts[d]) for d, n in self._timed.items()}
        for name, array in self._arrays.items():
            axis, chunks = self._axis[name], array.folder / "c"
            used = -(-self.sample_counts[self._dimension[name]] // array.chunks[axis])
            for path in [path for path in chunks.rglob("*") if path.is_file()]:
                number = path.relative_to(chunks).parts[axis]
                if number.isdecimal() and int(number) >= used:
                    path.unlink()

    def _write(self, waiting: Sequence[_Samples], lengths: Mapping[str, int]) -> None:
        self._require_present()
        used: dict[TailKey, _Tail] = {}
        for samples in waiting:
            for name, values in samples.arrays.items():
                self._tail(self._names.get(name, name), samples.region, used).add(samples.first, values)
            new = max(0, self._timed[samples.dimension] - samples.first)
            if new < len(samples.times):
                times = self._tail(self._names.get(samples.dimension, samples.dimension), (), used)
                times.add(samples.first + new, samples.times[new:])
                self._timed[samples.dimension] = samples.first + len(samples.times)
        for tail in used.values():
            tail.write()
        if waiting:
            self._tails = used  # those of a complete piece are dropped
        self._commit(lengths)

    def _tail(self, name: str, region: Region, used: dict[TailKey, _Tail]) -> _Tail:
        """Return the last chunks of an array in a region, and add them to those used."""
        key = name, tuple((part.start, part.stop) for part in region)
        tail = used.get(key) or self._tails.get(key)
        if tail is None:
            dimension = self._dimension[name]
            tail = _Tail(self._arrays[name], self._axis[name], region, lambda: self.sample_counts[dimension])
        used[key] = tail
        return tail

    def _commit(self, lengths: Mapping[str, int]) -> None:
        """Replace the metadata of the group, which state the lengths of all arrays."""
        members = self._group["consolidated_metadata"]["metadata"]
        self.sample_counts = {d: max(n, lengths[d]) for d, n in self.sample_counts.items()}
        for name, dimension in self._dimension.items():
            members[name]["shape"][self._axis[name]] = self.sample_counts[dimension]
        place = self.path / "zarr.json"
        output.write(place, group_file.content(self._group), durable=False)
        self._inode = place.stat().st_ino
        if time.monotonic() - self._updated >= METADATA_SECONDS:
            self._update_arrays()

    def _require_present(self) -> None:
        """Refuse to write into a folder that was removed or replaced: Zarr would create it again."""
        try:
            same = (self.path / "zarr.json").stat().st_ino == self._inode
        except OSError:
            same = False
        if not same:
            raise OutputError(
                "was removed or replaced while it was being written",
                where=str(self.path),
                fix="Run it again with another name",
            )


def _create(path: Path, empty: xarray.Dataset, growing: Sequence[str], piece: Mapping[str, int]) -> None:
    """Write the record without samples."""
    stored = portable.pack(empty, narrow=False)
    layout = codec.parse(stored.attrs[portable.KEY])
    encoding: dict[Any, Any] = {}
    for name in stored.variables:
        dims = [layout["names"].get(str(d), str(d)) for d in stored[name].dims]
        for dimension in set(dims) & set(growing):
            entry = layout["variables"][name]
            entry.pop("sha256")
            entry["grows"] = dimension
            encoding[name] = {
                "chunks": frame_chunks(stored[name], dims, dimension, piece),
                "compressors": COMPRESSORS,
                "fill_value": np.nan if stored[name].dtype.kind == "f" else 0,
            }
    stored.attrs[portable.KEY] = codec.line(layout, ascii=True)
    stored.attrs[KEY] = codec.line({**codec.parse(stored.attrs[KEY]), "complete": False})
    with warnings.catch_warnings():
        # other programs open a record at once, and without a warning, if its metadata are in one file
        warnings.filterwarnings("ignore", message="Consolidated metadata")
        stored.to_zarr(path, mode="a", zarr_format=3, consolidated=True, encoding=encoding)
    group_file.prove(path)


def frame_chunks(
    variable: xarray.DataArray, dims: Sequence[str], dimension: str, piece: Mapping[str, int]
) -> tuple[int, ...]:
    """Return the shape of the chunks of an array: whole frames, of the copies of one piece."""
    chunks = [min(piece.get(d, n), n) for d, n in zip(dims, variable.shape, strict=True)]
    axis = dims.index(dimension)
    frame = math.prod(chunks[:axis]) * math.prod(chunks[axis + 1 :]) * variable.dtype.itemsize
    chunks[axis] = max(1, min(LONGEST_CHUNK, CHUNK_BYTES // max(1, frame)))
    return tuple(map(int, chunks))


def _held(array: np.ndarray) -> np.ndarray:
    """Return values that may wait: a copy if they are less than half of the memory that they would hold."""
    whole = array.base
    return array.copy() if isinstance(whole, np.ndarray) and whole.nbytes > 2 * array.nbytes else array


@contextlib.contextmanager
def _writing(path: Path) -> Generator[None]:
    """Convert errors of the system into errors that name the record."""
    try:
        yield
    except OutputError as error:
        raise OutputError([Problem(p.where, p.what) for p in error.problems]) from None
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror or error}", where=str(path)) from None
