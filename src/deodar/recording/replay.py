"""A record that is read one moment at a time, also while it grows.

Times of all ports together are the moments of a record. At a moment each port has its last sample up to then,
since ports may have sampling intervals of their own.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Generator, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar.errors import DeodarError, RecordError, UnknownName, option, reading
from deodar.model import find
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.numerics.axes import Axes
from deodar.recording import diverged, files, provenance, writer_lock
from deodar.recording.record import about, time_dimension

MOST_CACHED = 256 * 2**20
"""Largest sum of the sizes of the chunks that are kept, in bytes."""

FEWEST = 64
"""Number of frames that are read together from a format without chunks."""

PortPlace = tuple[str, str]
"""An element by its id, and one of its ports."""

Copy = Mapping[str, int]
"""One copy of a record with trials or a sweep: the index along each of its dimensions."""


class _Recorded:
    """A recorded variable: copies, times, axes."""

    def __init__(self, variable: xarray.Variable, times: np.ndarray, axis: int) -> None:
        self.variable, self.times, self.axis = variable, times, axis
        self.shape = variable.shape[axis + 1 :]
        chunks = variable.encoding.get("chunks")
        self.chunk = int(chunks[axis]) if chunks and axis < len(chunks) else FEWEST

    def lead(self, copy: Copy) -> tuple[int, ...]:
        """Return the indices of a copy."""
        return tuple(copy.get(str(d), 0) for d in self.variable.dims[: self.axis])


class RecordReader:
    """A record that is read one moment at a time.

    Several threads may read it. `refresh` is called by one thread at a time.

    Attributes:
        path: the record, as it was opened.
        document: the document that made it.
        times: document time of each moment.
        copies: coordinates of the dimensions of trials and sweeps.
        complete: whether the run came to its end.

    Raises:
        RecordError: the record cannot be opened, or does not state the document that made it.
        DocumentError: its document cannot be read, for example because it is of a newer version.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = threading.Lock()
        self._blocks: OrderedDict[tuple[Any, ...], np.ndarray] = OrderedDict()
        self._cached = 0
        place = _place(path)
        self._watch = writer_lock.WriterWatch(place)
        self._stamp = writer_lock.stamp(place)
        self._written = writer_lock.is_written(place) is True
        record = files.opened(path)
        with reading(path, RecordError):
            self.document: Document = provenance.document(about(record))
        self._take(record)
        self._axes = {n.id: {**n.ins, **n.outs} for n in graph(self.document).nodes if n.declared}
        self._names: dict[PortPlace, str] = {}
        for name in map(str, self.data.data_vars):
            try:
                entry, port = find.port(self.document, name)
            except DeodarError:
                continue  # not a port: a variable of another program
            if name in self._recorded:
                self._names[entry.id, port] = name
        if not self._names:
            raise RecordError("contains no port of its document", where=str(path))

    def _take(self, record: xarray.Dataset) -> None:
        origin = about(record)
        recorded: dict[str, _Recorded] = {}
        for name, variable in record.data_vars.items():
            dimension = time_dimension(variable)
            if dimension is not None:
                times = np.asarray(record[dimension].values, float)
                recorded[str(name)] = _Recorded(variable.variable, times, variable.dims.index(dimension))
        times = {str(f.variable.dims[f.axis]): f.times for f in recorded.values()}
        first = next(iter(recorded.values()), None)
        lead = [] if first is None else [str(d) for d in first.variable.dims[: first.axis]]
        self.complete = bool(origin.get("complete", True))
        sentences = [str(record.attrs[key]) for key in ("damaged", diverged.REASON) if record.attrs.get(key)]
        self._faults = [f"{text[0].upper()}{text[1:].rstrip('.')}." for text in sentences]
        self.copies = {
            d: record[d].values if d in record.coords else np.arange(record.sizes[d]) for d in lead
        }
        self.times = np.unique(np.concatenate([*times.values(), np.zeros(0)]))
        self.data, self._recorded = record, recorded

    @property
    def growing(self) -> bool:
        """Whether a process writes the record, as far as the lock shows."""
        return self._written and not self.complete

    @property
    def notes(self) -> list[str]:
        """Sentences on what is missing in it."""
        if self.complete:
            return self._faults
        state = (
            "still being written, and shown up to its last commit"
            if self.growing
            else "incomplete: it ends before the end of its run"
        )
        return [f"The record is {state}.", *self._faults]

    @property
    def ports(self) -> Iterable[PortPlace]:
        """The recorded ports."""
        return self._names.keys()

    def _of(self, place: PortPlace) -> _Recorded:
        name = self._names.get(place)
        if name is None:
            path = find.entry(self.document, place[0]).path
            raise UnknownName(
                "was not recorded",
                where=f"{path}.{place[1]}",
                fix=option("Record it:", "record", f"{path}.{place[1]}", f"['{path}.{place[1]}']"),
            )
        return self._recorded[name]

    def document_axes(self, place: PortPlace) -> Axes:
        """Return the axes of a port in the document, whether it was recorded or not.

        Raises:
            RecordError: the document has no such port, or its axes are not known.
        """
        axes = self._axes.get(place[0], {}).get(place[1])
        if axes is None:
            raise RecordError(f"the axes of {place[1]!r} are not known")
        return axes

    def axes(self, place: PortPlace) -> Axes:
        """Return the axes of a recorded port.

        Raises:
            UnknownName: the port was not recorded.
            RecordError: the variable has other axes than the document.
        """
        shape = self._of(place).shape
        axes = self._axes.get(place[0], {}).get(place[1])
        if axes is None or shape != tuple(a.samples for a in axes):
            raise RecordError("has other axes in the record than in its document", where=self._names[place])
        return axes

    def index(self, time: float) -> int:
        """Return the number of the last moment up to a time, or 0."""
        return max(0, int(np.searchsorted(self.times, time, "right")) - 1)

    def frame(self, place: PortPlace, k: int, copy: Copy) -> np.ndarray | None:
        """Return the last sample of a port up to moment `k`; None before its first sample.

        Raises:
            RecordError: the sample cannot be read.
        """
        port = self._of(place)
        at = int(np.searchsorted(port.times, self.times[k], "right")) - 1
        if at < 0:
            return None
        first = at // port.chunk * port.chunk
        last = min(first + port.chunk, len(port.times))
        lead = port.lead(copy)
        key = (place, lead, first, last)
        with self._lock:
            block = self._blocks.get(key)
            if block is not None:
                self._blocks.move_to_end(key)
        if block is None:
            block = self._read(place, lead, first, last)
            with self._lock:
                if block.nbytes <= MOST_CACHED and key not in self._blocks:
                    self._blocks[key] = block
                    self._cached += block.nbytes
                while self._cached > MOST_CACHED:
                    self._cached -= self._blocks.popitem(last=False)[1].nbytes
        return block[at - first]

    def sample_times(self, place: PortPlace) -> np.ndarray:
        """Return the times of the samples of a port."""
        return self._of(place).times

    def chunks(self, place: PortPlace) -> list[tuple[int, int]]:
        """Return the first sample of each chunk of a port, and the one after its last."""
        size, count = self._of(place).chunk, len(self.sample_times(place))
        return [(first, min(first + size, count)) for first in range(0, count, size)]

    def block(self, place: PortPlace, copy: Copy, first: int, last: int) -> np.ndarray:
        """Read consecutive samples of a port.

        Raises:
            RecordError: they cannot be read.
        """
        return self._read(place, self._of(place).lead(copy), first, last)

    def samples(
        self, place: PortPlace, copy: Copy, most: int
    ) -> Generator[tuple[np.ndarray, np.ndarray], None, None]:
        """Yield times and frames of a port, chunk by chunk, at most about `most` evenly spaced ones."""
        times = self.sample_times(place)
        stride = max(1, -(-len(times) // most))
        for first, last in self.chunks(place):
            sampled = np.arange(-(-first // stride) * stride, last, stride)
            if len(sampled):
                yield times[sampled], self.block(place, copy, first, last)[sampled - first]

    def _read(self, place: PortPlace, lead: tuple[int, ...], first: int, last: int) -> np.ndarray:
        try:
            return np.asarray(self._of(place).variable[(*lead, slice(first, last))].values)
        except Exception as error:  # libraries that read untrusted bytes may raise any exception
            text = f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"
            raise RecordError(
                f"cannot be read at this moment, the record may be damaged ({text})", where=self._names[place]
            ) from None

    def refresh(self) -> bool:
        """Open the record again if it grew; return whether it did.

        A call also finds out whether a process still writes the record (`growing`).

        Raises:
            RecordError: it cannot be opened any more.
        """
        place = self._watch.path
        if self._written:
            self._written = not self._watch.ended()
        else:
            self._written = writer_lock.is_written(place) is True
        stamp = writer_lock.stamp(place)
        if stamp == self._stamp:
            return False
        self._take(files.opened(self.path))
        self._stamp = stamp
        return True


def _place(path: Path) -> Path:
    try:
        return files.locate(path)[0]
    except RecordError:
        return path  # opening it raises the same error, with its path
