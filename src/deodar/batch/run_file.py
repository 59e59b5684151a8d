"""The file of a run: its samples are written during the run, and its state from time to time."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import hashlib
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from deodar import codec
from deodar.batch.pieces import Pieces
from deodar.batch.points import SweepPoints
from deodar.compiler import hosts
from deodar.compiler.executable import Executable
from deodar.compiler.program import Port
from deodar.errors import DeodarError, NotFinite, RecordError, instance_of
from deodar.model.document import Document
from deodar.numerics.axes import shape
from deodar.recording import probe
from deodar.session import checkpoint
from deodar.session.run import Run

if TYPE_CHECKING:
    import xarray

    from deodar.recording.growing import GrowingRecord, Region

CHECKPOINT = "state.npz"
"""File of the last state, in the folder of the record."""

PIECE_CHECKPOINT = "state-{}.npz"
"""File of the last state of a piece that a worker process runs; removed when the piece is complete."""

CHECKPOINT_SECONDS = 30.0
"""Wall time between two stored states, in seconds, unless a document time is given (a guess)."""


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


class Sampling(NamedTuple):
    """The samples of a run: after `start` steps and then after each `gap`, `most` of them.

    `probes` states for each variable how many gaps lie between its samples, and their condition.
    """

    start: int
    gap: int
    most: int
    dt: float
    probes: Sequence[tuple[int, str | None]] = ()

    def times(self, doc: Document, first: int, n: int) -> np.ndarray:
        """Return the times of `n` samples from number `first` on."""
        return doc.t0 + (self.start + (first + np.arange(n)) * self.gap) * self.dt


StoredState = tuple[dict[str, Any], list[np.ndarray]]
"""A stored state: its text and its arrays."""


class Writer(Protocol):
    """What a part of a record calls to add samples: `GrowingRecord`, or the pipe of a worker process."""

    def put(
        self,
        dimension: str,
        times: np.ndarray,
        arrays: Mapping[str, np.ndarray],
        first: int | None = None,
        region: Region = (),
    ) -> None: ...


class PartOwner(Protocol):
    """The record that a part belongs to: `RunOutput`, or its image in a worker process.

    Attributes:
        doc: the document.
        grid: the dimensions of the points of a sweep, with the values of their coordinates.
        beside: for each path of a list of points its values.
        labels: the numbers of the trials; None without this dimension.
        settings: what the record states of the whole run.
        state: the stored state that the part may continue from.
        state_file: the file of this state.
        snapshots: document time between two stored states; None: about every 30 s of wall time.
    """

    doc: Document
    grid: dict[str, Sequence[float]]
    beside: dict[str, list[float]]
    labels: list[int] | None
    settings: Mapping[str, Any]
    state: StoredState | None
    state_file: str
    snapshots: float | None

    def begin(self, empty: Callable[[], xarray.Dataset]) -> Writer:
        """Return the writer; the first call creates the record from what `empty` returns."""
        ...

    def store(self, run: Run, about: Mapping[str, Any]) -> None:
        """Store the state of a part's run, after all samples before it."""
        ...

    def ended(self, number: int, reasons: Mapping[tuple[int, ...], str]) -> None:
        """Note that a part is complete, and which copies of the whole run diverged in it."""
        ...


def sizes(owner: PartOwner) -> dict[str, int]:
    """Return the dimensions of the copies of the whole run, with their lengths."""
    trials = {} if owner.labels is None else {"trial": len(owner.labels)}
    return {path: len(values) for path, values in owner.grid.items()} | trials


class RunOutput:
    """The record of a run, written during the run.

    Args:
        output: its place.
        resume: whether to continue an incomplete record.
        cut: whether a resumed run drops the samples after its stored state at once: other versions or another
            machine computed them.

    Raises:
        OutputExists: the path exists; with `force`: it is neither a record nor the folder of a run.
        OutputError: it cannot be written.
    """

    def __init__(self, output: Output, resume: bool = False, cut: bool = False) -> None:
        # start-up time: these import xarray
        from deodar.recording import files, folder

        self.force, self.snapshots = output.force, output.snapshots
        self.path = Path(output.path)
        self.record = files.locate(self.path)[0] if resume else folder.growing(self.path)
        self.state: StoredState | None = None
        self.state_file = str(self.record / CHECKPOINT)
        self.resumes, self.cuts, self.longer = resume, cut, dict[str, Any]()
        if resume:
            if (self.record / CHECKPOINT).exists():  # else the run begins again
                self.state = checkpoint.read(self.record / CHECKPOINT)
        else:
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

    def kept(self, data: xarray.Dataset, error: DeodarError) -> str:
        """Return what to say of the record of a run that ended with an error."""
        ends = [v.values[-1] for d, v in data.coords.items() if probe.is_time(str(d)) and v.size]
        end = f"up to time {max(ends):g} is" if ends else "has no samples, but is"
        again = "" if isinstance(error, NotFinite) else f". deodar run {self.path} --resume continues it"
        return f"The record {end} kept: {self.path}{again}"

    def plan(self, points: SweepPoints, cut: Pieces, settings: Mapping[str, Any]) -> None:
        """Set the copies of the whole run, how they are cut into pieces, and what the record states of it."""
        self.doc, self.cut = points.doc, cut
        self.grid, self.beside = points.grid, points.beside
        self.settings: Mapping[str, Any] = {**settings, "batch": cut.batch}
        self.labels: list[int] | None = settings["trials"]

    def part(self, number: int) -> OutputPart:
        """Return the part of the record that a piece of the run writes."""
        return OutputPart(self, number, self.region(number))

    def region(self, number: int) -> Region:
        """Return the copies of a piece."""
        first = number * self.cut.length
        mine = slice(first, min(first + self.cut.length, self.cut.total))
        return tuple(mine if d == self.cut.dimension else slice(0, n) for d, n in sizes(self).items())

    def piece_state(self, number: int) -> StoredState | None:
        """Return the stored state of a piece that a worker is to run; None: there is none.

        A worker process ran the piece before, or the process that wrote the record.
        """
        if self.state is not None and self.state[0]["piece"] == number:
            return self.state
        place = self.record / PIECE_CHECKPOINT.format(number)
        return checkpoint.read(place) if self.resumes and place.exists() else None

    def begin(self, empty: Callable[[], xarray.Dataset]) -> GrowingRecord:
        """Return the writer of the record. The first call creates it from what `empty` returns, a record
        without samples, or opens the record that is resumed.
        """
        # start-up time: these import xarray
        from deodar.recording import folder
        from deodar.recording.growing import GrowingRecord

        if self.writer is None and not self.resumes:
            folder.begin(self.doc, self.path, self.force)
            piece = {self.cut.dimension: self.cut.length} if self.cut.dimension else {}
            made = empty()
            times = [d for d in map(str, made.dims) if probe.is_time(d) and not made.sizes[d]]
            self.writer = GrowingRecord(self.record, made, times, piece)
        return self.continued()

    def continued(self) -> GrowingRecord:
        """Return the writer of a record that has begun; the first call of a resumed run opens it."""
        if self.writer is None:
            self.writer = self._opened()
        return self.writer

    def _opened(self) -> GrowingRecord:
        """Open the record of a resumed run."""
        # start-up time: this imports xarray
        from deodar.recording.growing import GrowingRecord

        about: dict[str, Any] = {"lengths": {}, "piece": -1} if self.state is None else self.state[0]
        states = [state[0] for k in range(self.cut.count) if (state := self.piece_state(k)) is not None]
        lengths = dict(about["lengths"])
        for one in states:
            lengths = {d: max(n, lengths.get(d, 0)) for d, n in one["lengths"].items()}
        writer = GrowingRecord.resumed(self.record, lengths, self.longer, self.cuts)
        if self.cuts:  # other pieces may be longer than these
            taken = {int(one["piece"]): int(one["taken"]) for one in (about, *states) if one["piece"] >= 0}
            for k in (k for k in range(self.cut.count) if k not in self.done):
                writer.erase(self.region(k), taken.get(k, 0))
        return writer

    def store(self, run: Run, about: Mapping[str, Any]) -> None:
        """Store the state of the run of a part, after all samples before it."""
        if self.writer is not None:
            self.write_state(checkpoint.taken(run, about), CHECKPOINT)

    def write_state(self, state: StoredState, name: str) -> None:
        """Write a state into the folder of the record, after all samples until now."""
        assert self.writer is not None
        self.writer.commit()
        reasons = [[list(copy), reason] for copy, reason in self.reasons.items()]
        about = {"lengths": self.writer.lengths, "done": self.done, "reasons": reasons}
        checkpoint.write(({**state[0], **about, "pieces": self.cut.count}, state[1]), self.record / name)

    def ended(self, number: int, reasons: Mapping[tuple[int, ...], str]) -> None:
        """Note that a piece is complete, and which of its copies diverged, with their reasons."""
        self.reasons.update(reasons)
        self.done.append(number)

    def close(self) -> xarray.Dataset:
        """Complete the record and return it, opened."""
        # start-up time: these import xarray
        from deodar.recording import diverged, files

        writer = self.continued()  # a resumed run may add no sample
        lost = None
        if self.reasons:
            writer.commit()
            for copy in self.reasons:
                writer.blank(copy)
            lost = diverged.coordinate(sizes(self), self.reasons)
        writer.close(True, lost)
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


class _NoSamples:
    """A writer that drops all samples: another host writes them."""

    def put(
        self,
        dimension: str,
        times: np.ndarray,
        arrays: Mapping[str, np.ndarray],
        first: int | None = None,
        region: Region = (),
    ) -> None:
        """Drop samples."""


class OutputElsewhere(RunOutput):
    """The record of a run that the first of several hosts writes, on the other hosts.

    Args:
        output: its place, for the Dataset that `close` returns.
    """

    def __init__(self, output: Output) -> None:
        self.path, self.snapshots, self.force = Path(output.path), output.snapshots, False
        self.state, self.state_file, self.resumes = None, "", False
        self.writer, self.reasons, self.done = None, {}, []

    def begin(self, empty: Callable[[], xarray.Dataset]) -> Any:
        """Return a writer that drops all samples."""
        return _NoSamples()

    def store(self, run: Run, about: Mapping[str, Any]) -> None:
        """Read the state of a run together with the first host, which stores it."""
        checkpoint.taken(run, about)

    def close(self) -> xarray.Dataset:
        """Return a Dataset without samples, which names the record."""
        # start-up time: this imports xarray
        import xarray

        return xarray.Dataset(attrs={"written_by": "host 0", "out": str(self.path)})


class OutputPart:
    """The part of a record that one piece of a run writes."""

    def __init__(self, out: PartOwner, number: int, region: Region) -> None:
        self.out, self.number, self.region = out, number, region
        self._saved = time.monotonic()
        self._saved_at = self._taken = 0

    def begin(
        self,
        program: Executable,
        variables: Sequence[tuple[str, str, Port]],
        sampling: Sampling,
        about: Mapping[str, Any],
    ) -> None:
        """Set what is written: id, port and program's port of every variable."""
        self.program, self.variables, self.sampling, self.about = program, variables, sampling, about
        # the identity of the run of this piece, apart from its duration and its machine
        same = {k: v for k, v in about.items() if k not in ("duration", "made_by")}
        self.digest = hashlib.sha256(codec.line(same, sort=True).encode()).hexdigest()
        doc = self.out.doc
        self.names = [f"{doc.by_id()[ident].path}.{port}" for ident, port, _ in variables]
        strides, conditions = zip(*sampling.probes, strict=True)
        thresholds = [probe.threshold(doc.by_id()[ident].element, port) for ident, port, _ in variables]
        self.selector = probe.Selector(
            probe.series(self.names, strides, conditions), dict(zip(self.names, thresholds, strict=True))
        )

    def _collect(self, k: int, seen: tuple[np.ndarray, ...]) -> None:
        """Write samples from number `k` on."""
        own = [part.stop - part.start for part in self.region]
        lead = len(self.program.batch.shape)
        n = seen[0].shape[lead]
        copies = self._copies(own)
        values = {
            name: a[tuple(map(slice, copies))].reshape(*own, *a.shape[lead:])
            for name, a in zip(self.names, seen, strict=True)
        }
        writer = self.out.begin(self._empty)
        times = self.sampling.times(self.out.doc, k, n)
        for one in self.selector.choose(k, times, values, len(own)):
            writer.put(one.dimension, one.times, one.values, one.first, self.region)
        self._taken = k + n

    def record(
        self,
        run: Run,
        steps: int,
        ports: Sequence[Port],
        check: Callable[[], None],
        shown: Callable[[int], object],
    ) -> None:
        """Advance a run that has just begun to its end, from the stored state if one is resumed.

        Args:
            run: the run.
            steps: its number of steps.
            ports: what is recorded.
            check: raises KeyboardInterrupt to stop; called between chunks.
            shown: called with the number of completed steps; may raise it, too.

        Raises:
            OutputError: samples cannot be written; those before are in the file.
            KeyboardInterrupt: the run was stopped; the state is stored.
        """
        begun = self._resumed(run)
        start, gap, most = self.sampling[:3]
        taken = self._taken
        run.probe = 1  # no second may pass before the first samples are written

        def collect(k: int, seen: tuple[np.ndarray, ...]) -> None:
            self._collect(taken + k, seen)

        def between(done: int) -> None:
            self._save_if_due(run, begun + done)
            try:
                shown(begun + done)
                check()
            except KeyboardInterrupt:
                self._save(run, begun + done)
                raise

        if start and start >= begun:  # a run that is made longer records its end again
            taken = self._taken = 0
        due = start + taken * gap - begun if taken < most else steps - begun + 1
        run.record(steps - begun, ports, due, gap, collect, between)
        self._save(run, steps)

    def _save_if_due(self, run: Run, done: int) -> None:
        due = self.out.snapshots
        passed = (done - self._saved_at) * self.sampling.dt
        now = passed >= due if due is not None else time.monotonic() - self._saved >= CHECKPOINT_SECONDS
        # all hosts read a state together, so the clock of the first one decides
        if hosts.of_first("a stored state", now, run.program.across):
            self._save(run, done)

    def _save(self, run: Run, done: int) -> None:
        """Store the state of the run after `done` steps, and all samples before it."""
        self._saved, self._saved_at = time.monotonic(), done
        about = {
            "piece": self.number,
            "steps": done,
            "above": self.selector.above,
            "taken": self._taken,
            "of": self.digest,
        }
        self.out.store(run, about)

    def _resumed(self, run: Run) -> int:
        """Set the run to the stored state of this piece; return the number of its steps, 0 without one."""
        if self.out.state is None or self.out.state[0]["piece"] != self.number:
            return 0
        about, arrays = self.out.state
        if about.get("of") != self.digest:
            raise RecordError(
                "the stored state is of another run",
                where=self.out.state_file,
                fix="Remove it; the run then begins again",
            )
        checkpoint.put(run, about, arrays)
        self._taken, self._saved_at = int(about["taken"]), int(about["steps"])
        self.selector.above = dict(about["above"])
        return int(about["steps"])

    def end(self, reasons: Mapping[tuple[int, ...], str], complete: bool, lost: bool) -> None:
        """Note which copies of a complete piece diverged, with their reasons; `close` makes them NaN."""
        if not complete:
            return
        starts = [part.start for part in self.region]
        whole = {tuple(k + s for k, s in zip(place, starts, strict=True)): r for place, r in reasons.items()}
        self.out.ended(self.number, whole)

    def _copies(self, own: Sequence[int]) -> list[int]:
        """Return the lengths of the batch axes without the copies that only fill the piece up."""
        points = int(np.prod(own[: len(self.out.grid)], dtype=int))
        return ([points] if self.out.grid else []) + ([own[-1]] if self.out.labels is not None else [])

    def _empty(self) -> xarray.Dataset:
        # start-up time: this imports xarray
        from deodar.recording import record

        copies, doc = self._copies(list(sizes(self.out).values())), self.out.doc
        variables: list[Any] = []
        for ident, port, place in self.variables:
            axes = self.program.axes(place)
            array = np.empty((*copies, 0, *shape(axes)), self.program.program.dtype)
            variables.append((doc.by_id()[ident], port, axes, array))
        about = {**self.about, **self.out.settings}
        out, no_times = self.out, np.empty(0)
        data = record.dataset(doc, variables, no_times, out.labels, out.grid, about, out.beside)
        return record.with_times(
            data, {name: one.dimension for one in self.selector.found for name in one.names}
        )
