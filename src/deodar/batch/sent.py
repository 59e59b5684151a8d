"""The samples of a piece that a worker process computes, sent to the process that writes the record.

One process writes a record. So a worker sends samples and states when it has them, in their order, and the
parent writes them as those of a run of its own: a kill loses as little.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar.batch.run_file import CHECKPOINT, PIECE_CHECKPOINT, RunOutput, StoredState, Writer
from deodar.model.document import Document
from deodar.session import checkpoint
from deodar.session.run import Run

if TYPE_CHECKING:
    import xarray

    from deodar.recording.growing import Region


@dc.dataclass(frozen=True)
class SentPart:
    """What a worker needs to send the samples of a piece: parts of `RunOutput` as plain data.

    Attributes:
        region: the copies of the piece.
        grid: the dimensions of the points of a sweep, with the values of their coordinates.
        beside: for each path of a list of points its values.
        labels: the numbers of the trials; None without this dimension.
        settings: what the record states of the whole run.
        snapshots: document time between two stored states; None: about every 30 s of wall time.
        state: the stored state that the piece continues from.
        state_file: the file of this state.
    """

    region: Region
    grid: dict[str, Sequence[float]]
    beside: dict[str, list[float]]
    labels: list[int] | None
    settings: Mapping[str, Any]
    snapshots: float | None
    state: StoredState | None
    state_file: str

    @classmethod
    def of(cls, out: RunOutput, number: int) -> SentPart:
        """Return what the worker of a piece needs."""
        place = out.record / PIECE_CHECKPOINT.format(number)
        return cls(
            out.region(number),
            out.grid,
            out.beside,
            out.labels,
            out.settings,
            out.snapshots,
            out.piece_state(number),
            str(place),
        )


@dc.dataclass(frozen=True)
class PieceBegun:
    """The first message: a record without samples, from which the parent creates the file."""

    empty: xarray.Dataset


@dc.dataclass(frozen=True)
class SentSamples:
    """Samples, as `GrowingRecord.put` takes them."""

    dimension: str
    times: np.ndarray
    arrays: Mapping[str, np.ndarray]
    first: int | None
    region: Region


@dc.dataclass(frozen=True)
class SentState:
    """The state of the piece, after all samples that were sent."""

    state: StoredState


@dc.dataclass(frozen=True)
class PieceEnded:
    """The piece is complete; `reasons` states which copies diverged."""

    reasons: Mapping[tuple[int, ...], str]


PieceMessage = PieceBegun | SentSamples | SentState | PieceEnded
"""What a worker sends."""


def receive(out: RunOutput, number: int, message: PieceMessage) -> None:
    """Write what the worker of a piece sent, in the process that writes the record."""
    if isinstance(message, PieceBegun):
        out.begin(lambda: message.empty)
        return
    writer = out.continued()
    if isinstance(message, SentSamples):
        m = message
        writer.put(m.dimension, m.times, m.arrays, m.first, m.region)
    elif isinstance(message, SentState):
        out.write_state(message.state, PIECE_CHECKPOINT.format(number))
    else:
        out.ended(number, message.reasons)
        out.write_state(({"piece": -1}, []), CHECKPOINT)
        with contextlib.suppress(FileNotFoundError):
            (out.record / PIECE_CHECKPOINT.format(number)).unlink()


class SentOutput:
    """The owner of a part in a worker process: it sends what `RunOutput` would write."""

    def __init__(self, about: SentPart, doc: Document, send: Callable[[PieceMessage], None]) -> None:
        self.doc, self._send = doc, send
        self.grid, self.beside = about.grid, about.beside
        self.labels, self.settings = about.labels, about.settings
        self.state, self.state_file, self.snapshots = about.state, about.state_file, about.snapshots
        self._begun = False

    def begin(self, empty: Callable[[], xarray.Dataset]) -> Writer:
        """Return what sends samples; the first call sends a record without samples."""
        if not self._begun:
            self._begun = True
            self._send(PieceBegun(empty()))
        return self

    def put(
        self,
        dimension: str,
        times: np.ndarray,
        arrays: Mapping[str, np.ndarray],
        first: int | None = None,
        region: Region = (),
    ) -> None:
        """Send samples."""
        self._send(SentSamples(dimension, times, arrays, first, region))

    def store(self, run: Run, about: Mapping[str, Any]) -> None:
        """Send the state of the run."""
        if self._begun:
            self._send(SentState(checkpoint.taken(run, about)))

    def ended(self, number: int, reasons: Mapping[tuple[int, ...], str]) -> None:
        """Send that the piece is complete; a resumed one may have sent nothing before."""
        self._send(PieceEnded(reasons))
