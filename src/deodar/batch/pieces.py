"""Cut a large batch into pieces that run in sequence or in parallel processes, and join their records."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from deodar import codec
from deodar.batch.points import dimensions
from deodar.batch.simulation_request import SimulationRequest
from deodar.errors import NotFinite
from deodar.recording.provenance import KEY
from deodar.sweep import POINT, Points, Sweep

if TYPE_CHECKING:
    import xarray


class PieceResult(NamedTuple):
    """The record of a piece, whether it is complete, and the error of its first copy if all its copies
    diverged.
    """

    data: xarray.Dataset | None
    complete: bool
    lost: NotFinite | None = None


EMPTY = PieceResult(None, True)
"""The result of a complete piece whose record is in a file."""


BATCH_BYTES = 8 * 2**20
"""Largest number of bytes of the ports of all copies in one batch, and of the matrices that each has for
itself, so that a step stays in the cache.

`python benchmarks/batches.py` prints the time of a step per copy over the size of the batch. On a processor
with 1 MiB of cache per core and 32 MiB for all, planes of 200 x 200 take the same time in batches up to 8 (6
MiB), 1.3 times as long in batches of 24 (19 MiB), 1.6 times in batches of 48; 20 lines with 20 nodes are
fastest at 100 to 200 (8 to 16 MiB) and take 2.5 times as long at 400 (31 MiB); single lines of 200 gain up to
400, which are 2 MiB. Smaller pieces cost little: from 16 copies of a plane, and from 64 of a line, a step is
within 10 % of the fastest.
"""


@dc.dataclass(frozen=True)
class Pieces:
    """A run cut along one of its leading dimensions: the longest of `trial` and the entries of the sweep.

    Attributes:
        dimension: name of the dimension; empty if the run has none.
        total: its length.
        length: length of one piece along it; the last piece may be shorter, and is filled up to this length
            when it is computed.
        rest: copies in each slice along it.
    """

    dimension: str
    total: int
    length: int
    rest: int

    @property
    def batch(self) -> int:
        """Number of copies of the model in one piece; the last piece may have fewer."""
        return self.length * self.rest

    @property
    def count(self) -> int:
        """Number of pieces."""
        return math.ceil(self.total / self.length)

    def requests(
        self,
        whole: SimulationRequest,
        trials: Sequence[int] | None,
        sweep: Mapping[str, Sequence[float]] | Points,
    ) -> list[SimulationRequest]:
        """Return for each piece the request of the whole run, with the trials and the sweep of the piece."""
        out: list[SimulationRequest] = []
        on = dc.replace(whole.on, workers=None, cluster=None, progress=None, batch=self.batch)
        for first in range(0, self.total, self.length):
            part = slice(first, first + self.length)
            numbers = list(trials) if trials is not None else None
            grid: Sweep = sweep
            if self.dimension == POINT and isinstance(sweep, Points):
                grid = dc.replace(sweep, values=sweep.values[part])
            elif isinstance(sweep, Mapping) and self.dimension in sweep:
                grid = {**sweep, self.dimension: list(sweep[self.dimension][part])}
            else:
                numbers = numbers[part] if numbers is not None else None
            piece = dc.replace(whole, trials=numbers, sweep=grid or None, on=on)
            at = first if self.dimension == POINT else 0
            out.append(dc.replace(piece, width=(self.dimension, self.length), first=at))
        return out


def cut(
    lengths: Mapping[str, int],
    bytes_a_copy: int,
    workers: int = 1,
    batch: int | None = None,
    devices: int = 1,
) -> Pieces:
    """Cut a run so that a piece fits into the cache, and all workers have equal work.

    Args:
        lengths: the leading dimensions of the run and their lengths.
        bytes_a_copy: bytes of one copy of the model, as `memory.copy_bytes` returns them; 0: no bound.
        workers: number of processes that share the pieces.
        batch: copies in one piece; none: as many as fit into `BATCH_BYTES`, fewer where that gives every
            worker as many pieces.
        devices: number of devices that share a piece, each with a cache of its own.
    """
    dimension = max(lengths, key=lambda name: lengths[name], default="")
    total = lengths.get(dimension, 1)
    others = math.prod(lengths.values()) // total
    fitting = devices * (BATCH_BYTES // bytes_a_copy) if bytes_a_copy else total * others
    most = int(batch) if batch is not None else fitting
    length = max(1, min(total, most // others))
    if batch is None:
        count = math.ceil(math.ceil(total / length) / workers) * workers
        length = math.ceil(total / count)
    return Pieces(dimension, total, length, others)


def joined(
    pieces: Pieces, parts: Sequence[PieceResult | None], settings: Mapping[str, Any]
) -> xarray.Dataset:
    """Join the records of the pieces into one.

    All complete pieces are joined; without any, those begun, up to a time that keeps most of their values.

    Args:
        pieces: the pieces of the run.
        parts: the record of each piece; None for a piece that was not begun. If all are None the record is
            empty.
        settings: settings of the whole run, for the record.
    """
    # start-up time: these bring xarray
    import xarray

    from deodar.recording import diverged
    from deodar.recording.shown_dataset import ShownDataset

    begun = [part for part in parts if part is not None]
    whole = [part for part in begun if part.complete]
    complete, all_begun = ([p.data for p in some if p.data is not None] for some in (whole, begun))
    trials = ["trial"] if settings.get("trials") is not None else []
    copies = [*dimensions(settings.get("sweep")), *trials]
    records = diverged.alike(complete or _abreast(all_begun), copies)
    record = records[0] if records else xarray.Dataset()
    if len(records) > 1:
        joined = xarray.concat(
            records,
            pieces.dimension,
            data_vars="all",
            coords="minimal",
            compat="override",
            join="override",
            combine_attrs="override",
        )
        record = ShownDataset.of(joined)
    if KEY in record.attrs:
        description = (
            codec.parse(record.attrs[KEY])
            | settings
            | {
                "batch": pieces.batch,
                "complete": len(whole) == len(parts),
            }
        )
        record.attrs[KEY] = codec.line(description)
    return diverged.counted(record)


def _abreast(records: Sequence[xarray.Dataset]) -> list[xarray.Dataset]:
    """Return records cut to one length, without the shorter ones, so that most values are kept."""
    lengths = [record.sizes["time"] for record in records]
    most = max(lengths, key=lambda n: n * sum(length >= n for length in lengths), default=0)
    return [record.isel(time=slice(most)) for record, n in zip(records, lengths, strict=True) if n >= most]
