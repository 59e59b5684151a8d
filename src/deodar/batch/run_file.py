"""The file of a run: its samples are written during the run, and its state from time to time."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar.batch.piece_record import (
    PieceBegun,
    PieceMessage,
    PieceState,
    RecordedPiece,
    RecordPart,
)
from deodar.batch.pieces import Pieces
from deodar.batch.points import SweepPoints
from deodar.errors import DeodarError, NotFinite, RecordError, instance_of
from deodar.model import output
from deodar.recording import probe
from deodar.session import checkpoint

if TYPE_CHECKING:
    import xarray

    from deodar.recording.growing import GrowingRecord, Region

CHECKPOINT = "state.npz"
"""File of the last state, in the folder of the record."""

PIECE_CHECKPOINT = "state-{}.npz"
"""File of the last state of a piece that a worker process runs; removed when the piece is complete."""


@dc.dataclass(frozen=True)
class Output:
    """Where `simulate` writes a record during the run, and how.

    Attributes:
        path: a name ending in .zarr, or a folder, which gets the record and the model.
        force: whether an existing record, or the folder of a run, is replaced.
        snapshots: document time between two stored states, from which `dd.resume` continues; none: about
            every 30 s of wall time.
    """

    path: str | Path
    force: bool = False
    snapshots: float | None = None

    @classmethod
    def of(cls, given: Output | str | Path) -> Output:
        """Return an output by its path, or the output itself."""
        return cls(given) if isinstance(given, (str, Path)) else instance_of(Output, given, "out")


class RunOutput:
    """The record of a run, written during the run.

    Args:
        output: its place.
        resume: whether to continue an incomplete record.
        cut: whether a resumed run drops the samples after its stored state at once: other versions or another
            machine computed them.
        here: whether this process writes it; of several hosts the first one does.

    Raises:
        OutputExists: the path exists; with `force`: it is neither a record nor the folder of a run.
        OutputError: it cannot be written.
    """

    def __init__(self, output: Output, resume: bool = False, cut: bool = False, here: bool = True) -> None:
        # start-up time: these import xarray
        from deodar.recording import files, folder

        self.force, self.snapshots, self.here = output.force, output.snapshots, here
        self.path = Path(output.path)
        self.record = files.locate(self.path)[0] if resume else folder.growing(self.path)
        self.state: checkpoint.StoredState | None = None
        self.resumes, self.cuts, self.longer = resume, cut, dict[str, Any]()
        if resume:
            if (self.record / CHECKPOINT).exists():  # else the run begins again
                self.state = checkpoint.read(self.record / CHECKPOINT)
        elif here:
            folder.claim_growing(self.path, self.force)
        self.writer: GrowingRecord | None = None
        self.reasons: dict[tuple[int, ...], str] = {}
        self.done: list[int] = []
        if self.state is not None:
            self.done = list(self.state[0]["done"])
            self.reasons = {tuple(copy): reason for copy, reason in self.state[0].get("reasons", [])}

    def lengthen(self, duration: float) -> None:
        """Let a resumed run last longer than it did.

        Raises:
            RecordError: it was cut into pieces, of which only the last state of one is stored.
        """
        if self.state is not None and self.state[0]["pieces"] > 1:
            raise RecordError(
                "is a run in several pieces, which cannot be made longer",
                where=str(self.path),
                fix="Run its model again, for the whole duration",
            )
        self.longer = {"duration": duration}
        self.done.clear()

    def kept(self, record: xarray.Dataset, error: DeodarError) -> str:
        """Return what to say of the record of a run that ended with an error."""
        ends = [v.values[-1] for d, v in record.coords.items() if probe.is_time(str(d)) and v.size]
        end = f"up to time {max(ends):g} is" if ends else "has no samples, but is"
        advice = "" if isinstance(error, NotFinite) else f". deodar run {self.path} --resume continues it"
        return f"The record {end} kept: {self.path}{advice}"

    def plan(self, points: SweepPoints, cut: Pieces, settings: Mapping[str, Any]) -> None:
        """Set the copies of the whole run, how they are cut into pieces, and what the record states of it."""
        self.points, self.cut = points, cut
        self.settings: Mapping[str, Any] = {**settings, "batch": cut.batch}
        trials = {} if settings["trials"] is None else {"trial": len(settings["trials"])}
        self.sizes = {path: len(values) for path, values in points.grid.items()} | trials
        whole = {dimension: slice(0, n) for dimension, n in self.sizes.items()}
        mine = [slice(k, min(k + cut.length, cut.total)) for k in range(0, cut.total, cut.length)]
        parts = [{cut.dimension: part} if cut.dimension else {} for part in mine]
        self.regions: list[Region] = [tuple((whole | place).values()) for place in parts]

    def part(self, number: int) -> RecordPart:
        """Return the part of the record that a piece of the run writes, wherever it runs."""
        place, state = self._piece_state(number)
        return RecordPart(
            number,
            self.regions[number],
            self.sizes,
            self.points.grid,
            self.points.beside,
            self.settings["trials"],
            self.settings,
            self.snapshots,
            self.resumes or self.writer is not None,
            state,
            str(place),
        )

    def piece(self, number: int) -> RecordedPiece:
        """Return what records a piece that this process computes."""
        receive = functools.partial(self.receive, number) if self.here else _nowhere
        return RecordedPiece(self.part(number), receive)

    def _piece_state(self, number: int) -> tuple[Path, checkpoint.StoredState | None]:
        """Return the file and the content of the stored state of a piece; None: there is none.

        A worker process ran the piece before, or the process that wrote the record.
        """
        if self.state is not None and self.state[0]["piece"] == number:
            return self.record / CHECKPOINT, self.state
        place = self.record / PIECE_CHECKPOINT.format(number)
        return place, checkpoint.read(place) if self.resumes and place.exists() else None

    def receive(self, number: int, message: PieceMessage, beside: bool = False) -> None:
        """Write what a piece reports.

        Args:
            number: number of the piece.
            message: what it reports.
            beside: whether other pieces run at the same time, so that its state has a file of its own until
                it is complete.
        """
        state_name = PIECE_CHECKPOINT.format(number)
        if isinstance(message, probe.Chosen):
            m = message
            self._continued().put(m.dimension, m.times, m.values, m.first, self.regions[number])
        elif isinstance(message, PieceBegun):
            self._create(message.empty)
        elif isinstance(message, PieceState):
            if self.writer is not None:
                self._store(message.state, state_name if beside else CHECKPOINT)
        else:
            self.reasons.update(message.reasons)
            self.done.append(number)
            if beside:
                self._store(({"piece": -1}, []), CHECKPOINT)
                (self.record / state_name).unlink(missing_ok=True)

    def _create(self, empty: xarray.Dataset) -> None:
        """Create the record from one without samples; the first piece that begins does."""
        # start-up time: these import xarray
        from deodar.recording import folder
        from deodar.recording.growing import GrowingRecord

        if self.writer is not None or self.resumes:
            return
        folder.begin(self.points.doc, self.path, self.force)
        piece = {self.cut.dimension: self.cut.length} if self.cut.dimension else {}
        times = [d for d in map(str, empty.dims) if probe.is_time(d) and not empty.sizes[d]]
        self.writer = GrowingRecord(self.record, empty, times, piece)

    def _continued(self) -> GrowingRecord:
        """Return the writer of a record that has begun; the first call of a resumed run opens it."""
        if self.writer is None:
            self.writer = self._opened()
        return self.writer

    def _opened(self) -> GrowingRecord:
        """Open the record of a resumed run."""
        # start-up time: this imports xarray
        from deodar.recording.growing import GrowingRecord

        header: dict[str, Any] = {"lengths": {}, "piece": -1} if self.state is None else self.state[0]
        states = [state[0] for k in range(self.cut.count) if (state := self._piece_state(k)[1]) is not None]
        lengths = dict(header["lengths"])
        for header_of_piece in states:
            lengths = {d: max(n, lengths.get(d, 0)) for d, n in header_of_piece["lengths"].items()}
        writer = GrowingRecord.resumed(self.record, lengths, self.longer, self.cuts)
        if self.cuts:  # other pieces may be longer than these
            taken = {
                int(header_of_piece["piece"]): int(header_of_piece["taken"])
                for header_of_piece in (header, *states)
                if header_of_piece["piece"] >= 0
            }
            for k in (k for k in range(self.cut.count) if k not in self.done):
                writer.erase(self.regions[k], taken.get(k, 0))
        return writer

    def _store(self, state: checkpoint.StoredState, name: str) -> None:
        """Write a state into the folder of the record, after all samples until now."""
        writer = self._continued()
        writer.commit()
        reasons = [[list(copy), reason] for copy, reason in self.reasons.items()]
        header = {"lengths": writer.lengths, "done": self.done, "reasons": reasons}
        checkpoint.write(({**state[0], **header, "pieces": self.cut.count}, state[1]), self.record / name)

    def close(self) -> xarray.Dataset:
        """Complete the record and return it, opened; where another host writes it, a Dataset without samples.

        That names the record.
        """
        # start-up time: these import xarray
        import xarray

        from deodar.recording import diverged, files

        if not self.here:
            return xarray.Dataset(attrs={"written_by": "host 0", "out": str(self.path)})
        writer = self._continued()  # a resumed run may add no sample
        lost = None
        if self.reasons:
            writer.commit()
            for copy in self.reasons:
                writer.blank(copy)
            lost = diverged.coordinate(self.sizes, self.reasons)
        writer.close(True, lost)
        output.note(self.path)
        return files.open_record(self.record)

    def abandon(self) -> xarray.Dataset | None:
        """Close the record of a run that did not come to its end, and return it, opened.

        It is None if nothing was recorded. An error of the disk is not raised again.
        """
        # start-up time: this imports xarray
        from deodar.recording import files

        if self.writer is None and not self.resumes:
            return None
        if self.writer is not None:
            self.writer.abandon()
        with contextlib.suppress(DeodarError):
            return files.open_record(self.record)
        return None


def _nowhere(message: PieceMessage) -> None:
    """Drop what a piece reports: another host writes it."""
