"""What a recorded piece of a run says, wherever it runs: samples, states, its end.

One process writes a record. A piece in this process reports to it directly (`RunOutput.receive`), one in a
worker process through a pipe, one on a cluster when it is complete. All write the same in the same order, so
a kill loses as little.
"""

from __future__ import annotations

import dataclasses as dc
import hashlib
import time
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar import codec
from deodar.batch.run_plan import RunPlan
from deodar.compiler import hosts
from deodar.compiler.executable import Executable
from deodar.compiler.program import Port
from deodar.errors import RecordError
from deodar.numerics.axes import shape
from deodar.recording import probe
from deodar.session import checkpoint
from deodar.session.run import Run

if TYPE_CHECKING:
    import xarray

    from deodar.recording.growing import Region

CHECKPOINT_SECONDS = 30.0
"""Wall time between two stored states, in seconds, unless a document time is given (a guess)."""


@dc.dataclass(frozen=True)
class PieceBegun:
    """The first message: a record without samples, from which the record is created if it does not exist."""

    empty: xarray.Dataset


@dc.dataclass(frozen=True)
class PieceState:
    """The state of the piece, after all samples before it."""

    state: checkpoint.StoredState


@dc.dataclass(frozen=True)
class PieceEnded:
    """The piece is complete; `reasons` states which copies of the whole run diverged in it."""

    reasons: Mapping[tuple[int, ...], str]


PieceMessage = PieceBegun | probe.Chosen | PieceState | PieceEnded
"""What a piece reports."""


@dc.dataclass(frozen=True)
class RecordPart:
    """The part of a record that a piece writes, as plain data.

    Attributes:
        number: number of the piece.
        region: the copies of the piece.
        sizes: the dimensions of the copies of the whole run, with their lengths.
        grid: the dimensions of the points of a sweep, with the values of their coordinates.
        beside: for each path of a list of points its values.
        labels: the numbers of the trials; None without this dimension.
        settings: what the record states of the whole run.
        snapshots: document time between two stored states; None: about every 30 s of wall time.
        begun: whether the record exists.
        state: the stored state that the piece continues from.
        state_file: the file of this state.
    """

    number: int
    region: Region
    sizes: Mapping[str, int]
    grid: dict[str, Sequence[float]]
    beside: dict[str, list[float]]
    labels: list[int] | None
    settings: Mapping[str, Any]
    snapshots: float | None
    begun: bool
    state: checkpoint.StoredState | None
    state_file: str


class RecordedPiece:
    """A piece of a run that reports what it records."""

    def __init__(self, part: RecordPart, tell: Callable[[PieceMessage], None]) -> None:
        self.part, self._tell = part, tell
        self._begun = part.begun
        self._saved = time.monotonic()
        self._saved_at = self._taken = 0

    def begin(
        self, plan: RunPlan, program: Executable, ports: Sequence[Port], description: Mapping[str, Any]
    ) -> None:
        """Set what is recorded: the ports of the program, and what the record states of the run."""
        self.plan, self.program, self.ports, self.about = plan, program, ports, description
        # the identity of the run of this piece, apart from its duration and its machine
        same = {k: v for k, v in description.items() if k not in ("duration", "made_by")}
        self.digest = hashlib.sha256(codec.line(same, sort=True).encode()).hexdigest()
        by = plan.doc.by_id()
        recorded = [(by[ident], port) for ident, port in plan.ports]
        self.selector = probe.selector(recorded, *zip(*plan.sampling.probes, strict=True))
        self.names = list(self.selector.thresholds)

    def _collect(self, k: int, seen: tuple[np.ndarray, ...]) -> None:
        """Tell samples from number `k` on."""
        lengths = [part.stop - part.start for part in self.part.region]
        lead = len(self.program.batch.shape)
        n = seen[0].shape[lead]
        copies = self._copies(lengths)
        values = {
            name: a[tuple(map(slice, copies))].reshape(*lengths, *a.shape[lead:])
            for name, a in zip(self.names, seen, strict=True)
        }
        self._require_begun()
        times = self.plan.sampling.times(self.plan.doc, k, n)
        for chosen in self.selector.choose(k, times, values, len(lengths)):
            self._tell(chosen)
        self._taken = k + n

    def record(self, run: Run, check: Callable[[], None], show: Callable[[int], object]) -> None:
        """Advance a run that has just begun to its end, from the stored state if one is resumed.

        Args:
            run: the run.
            check: raises KeyboardInterrupt to stop; called between chunks.
            show: called with the number of completed steps; may raise it, too.

        Raises:
            OutputError: samples cannot be written; those before are in the file.
            KeyboardInterrupt: the run was stopped; the state is stored.
        """
        begun, steps = self._resumed(run), self.plan.steps
        start, gap, most = self.plan.sampling[:3]
        taken = self._taken
        run.probe = 1  # no second may pass before the first samples are written

        def collect(k: int, seen: tuple[np.ndarray, ...]) -> None:
            self._collect(taken + k, seen)

        def between(done: int) -> None:
            self._save_if_due(run, begun + done)
            try:
                show(begun + done)
                check()
            except KeyboardInterrupt:
                self._save(run, begun + done)
                raise

        if start and start >= begun:  # a run that is made longer records its end again
            taken = self._taken = 0
        due = start + taken * gap - begun if taken < most else steps - begun + 1
        run.record(steps - begun, self.ports, due, gap, collect, between)
        self._save(run, steps)

    def _save_if_due(self, run: Run, done: int) -> None:
        due = self.part.snapshots
        passed = (done - self._saved_at) * self.plan.sampling.dt
        due_now = passed >= due if due is not None else time.monotonic() - self._saved >= CHECKPOINT_SECONDS
        # all hosts read a state together, so the clock of the first one decides
        if hosts.of_first("a stored state", due_now, run.program.across):
            self._save(run, done)

    def _save(self, run: Run, done: int) -> None:
        """Tell the state of the run after `done` steps."""
        self._saved, self._saved_at = time.monotonic(), done
        header = {
            "piece": self.part.number,
            "steps": done,
            "above": self.selector.above,
            "taken": self._taken,
            "of": self.digest,
        }
        self._tell(PieceState(checkpoint.taken(run, header)))

    def _resumed(self, run: Run) -> int:
        """Set the run to the stored state of this piece; return the number of its steps, 0 without one."""
        if self.part.state is None:
            return 0
        header, arrays = self.part.state
        if header.get("of") != self.digest:
            raise RecordError(
                "the stored state is of another run",
                where=self.part.state_file,
                fix="Remove it; the run then begins again",
            )
        checkpoint.put(run, header, arrays)
        self._taken, self._saved_at = int(header["taken"]), int(header["steps"])
        self.selector.above = dict(header["above"])
        return int(header["steps"])

    def end(self, reasons: Mapping[tuple[int, ...], str], complete: bool, lost: bool) -> None:
        """Tell which copies of a complete piece diverged, with their reasons."""
        if not complete:
            return
        self._require_begun()
        starts = [part.start for part in self.part.region]
        whole = {tuple(k + s for k, s in zip(place, starts, strict=True)): r for place, r in reasons.items()}
        self._tell(PieceEnded(whole))

    def _copies(self, lengths: Sequence[int]) -> list[int]:
        """Return the lengths of the batch axes without the copies that only fill the piece up."""
        part = self.part
        points = int(np.prod(lengths[: len(part.grid)], dtype=int))
        return ([points] if part.grid else []) + ([lengths[-1]] if part.labels is not None else [])

    def _require_begun(self) -> None:
        """Tell a record without samples, unless the record exists."""
        if self._begun:
            return
        from deodar.recording import record  # start-up time: this imports xarray

        self._begun, part, by = True, self.part, self.plan.doc.by_id()
        copies = self._copies(list(part.sizes.values()))
        variables: list[Any] = []
        for (ident, port), place in zip(self.plan.ports, self.ports, strict=True):
            axes = self.program.axes(place)
            array = np.empty((*copies, 0, *shape(axes)), self.program.program.dtype)
            variables.append((by[ident], port, axes, array))
        description = {**self.about, **part.settings}
        empty = record.dataset(
            self.plan.doc, variables, np.empty(0), part.labels, part.grid, description, part.beside
        )
        self._tell(PieceBegun(record.with_times(empty, self.selector.found)))
