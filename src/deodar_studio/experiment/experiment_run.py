"""The run of an experiment: a thread that gives trials to worker processes, and one that repeats a trial."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
import math
import queue
import threading
import time
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Any, Literal

from deodar import codec, regular_file
from deodar.batch.driver import Staffing
from deodar.batch.kept_worker import KeptWorker
from deodar.errors import DeodarError, Problem, RecordError, problems_of
from deodar.experiments import packed_experiment
from deodar.experiments.following import RowsTail, RowsWriter, Standing, standing
from deodar.experiments.merging import computed
from deodar.experiments.results import ROWS, run_trials
from deodar.experiments.rows import Row
from deodar.experiments.setup import Setup
from deodar.model import find, output
from deodar.model.document_graph import graph
from deodar.numerics.axes import shape
from deodar.progress import Progress
from deodar.recording import writer_lock
from deodar.resources import Resources
from deodar_studio.experiment.run_place import RunPlace

MOST_RECORDED = 128 * 2**20
"""Largest size in bytes of the record of a repeated trial (a guess)."""

REPEATS = "repeats"
"""Folder of the records of repeated trials, in the folder of the results."""

STANDING_SECONDS = 1.0
"""Least wall time between two standings of a run, in seconds: all of its rows are read for one."""

NOBODY = Staffing(0, 0)

State = Literal["running", "followed", "complete", "stopped", "failed"]


@dc.dataclass(frozen=True)
class RowsSeen:
    """What was seen of a folder that another process may write.

    Attributes:
        written: whether a process holds its lock; None where this is unknown.
        new: the rows since the last look.
    """

    written: bool | None
    new: Sequence[Row]


class ExperimentRun:
    """The trials of an experiment: their rows, which worker processes add, or another process.

    Attributes:
        setup: the opened experiment.
        folder: the folder of the results.
        rows: the rows, in the order in which they were stored; rows are only added.
        left: estimated remaining time in s; None before it can be estimated.
        state: whether it runs, is followed while another process runs it, is complete, was stopped, or ended
            with `problems`.
        problems: the reason of a failure.
        place: where its trials are computed.
        staffing: its present workers and their pieces.
        standing: how far it is, renewed from time to time while rows arrive; None before.
    """

    def __init__(self, setup: Setup, folder: Path, changed: Callable[[], None]) -> None:
        self.setup, self.folder, self._changed = setup, folder, changed
        self.rows: list[Row] = []
        self.left: float | None = None
        self.state: State = "stopped"
        self.problems: Sequence[Problem] = ()
        self.place = RunPlace()
        self.staffing = NOBODY
        self.standing: Standing | None = None
        self._stood = -math.inf
        self._tail: RowsTail | None = None
        self._looking, self._seen = threading.Lock(), queue.SimpleQueue[RowsSeen]()
        self._writer, self._opened = RowsWriter(), False
        self._begun = 0.0, 0
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self._repeating = threading.Lock()
        self._closing = threading.Event()
        self._worker = KeptWorker(main=True)

    @property
    def workers(self) -> int:
        """Number of worker processes on this machine: at most one for each piece."""
        return max(1, min(self.place.workers, len(self.setup.pieces())))

    @property
    def stopping(self) -> bool:
        """Whether the run was stopped and has not ended yet."""
        return self.state == "running" and self._stop.is_set()

    def start(self, place: RunPlace) -> None:
        """Run the trials without a row, in a thread."""
        self.place, self.staffing, self._tail = place, NOBODY, None
        self.state, self.problems, self.left = "running", (), None
        self._stop.clear()
        self._thread = threading.Thread(target=self._run, name="deodar-experiment", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            cluster = self.place.cluster
            workers = None if cluster is not None else self.workers
            take = functools.partial(self._take, {row["trial"] for row in self.rows})
            on = Resources(workers=workers, cluster=cluster, progress=take)
            run_trials(self.setup, self.folder, on, watch=self._watched)
        except KeyboardInterrupt:
            self.state = "stopped"
        except Exception as error:  # functions that the document names run in the workers
            self.state, self.problems = "failed", problems_of(error)
        else:
            self.state = "complete"
        self.staffing = NOBODY
        self._changed()
        self._prepare()

    def _take(self, known: Collection[int], progress: Progress) -> None:
        """Add rows; `known`: the trials whose rows it had before, which a run begins with."""
        self.rows.extend(row for row in progress.new if row["trial"] not in known)
        self.left = progress.seconds_left
        self._stand(None)
        self._changed()

    def _watched(self, now: Staffing) -> bool:
        """Note the present workers; return whether the run was stopped."""
        if now != self.staffing:
            self.staffing = now
            self._changed()
        return self._stop.is_set()

    def _stand(self, begun: tuple[float, int] | None) -> None:
        """Renew the standing, unless that was done a moment ago."""
        now = time.monotonic()
        if now - self._stood >= STANDING_SECONDS:
            self.standing = standing(self.rows, self.setup.trials, begun, now)
            self._stood = now

    def stop(self) -> None:
        """End the workers; the rows that they have returned are stored."""
        self._stop.set()

    def close(self) -> None:
        """End all processes, also that of a repetition, and wait until they have ended."""
        self.stop()
        self._closing.set()
        if self._thread is not None:
            self._thread.join()
        with self._repeating:
            self._worker.end()
            self._closing.clear()

    # ---------------------------------------------------------------------------------------------- following

    def open(self) -> None:
        """Read the rows of a folder of results, which `take` adds; those of another process follow.

        Raises:
            RecordError: the rows cannot be read.
        """
        self._tail = RowsTail(self.folder / ROWS)
        written = writer_lock.is_written(self.folder)  # before the rows: it may end after them
        rows = self._tail.new()
        self._begun = time.monotonic(), len(rows)
        self._seen.put(RowsSeen(written, rows))

    def look(self) -> None:
        """Read what another process has added, for `take`. It is called in a thread, since a folder may be
        far away, and a late answer is not lost.
        """
        tail = self._tail
        if tail is None or not self._looking.acquire(blocking=False):
            return
        with contextlib.ExitStack() as stack:
            stack.callback(self._looking.release)
            written, rows = writer_lock.is_written(self.folder), list[Row]()
            with contextlib.suppress(RecordError):  # the folder may be gone
                rows = tail.new()
            self._seen.put(RowsSeen(written, rows))

    @property
    def follows(self) -> bool:
        """Whether another process may add rows to its folder."""
        return self._tail is not None and self.state in ("stopped", "followed")

    def take(self) -> bool:
        """Add the rows that were read since the last call; return whether anything changed."""
        if not self.follows or self._seen.empty():
            return False
        now, before, found, count = time.monotonic(), self.state, RowsSeen(None, ()), len(self.rows)
        while not self._seen.empty():
            found = self._seen.get_nowait()
            self.rows.extend(found.new)
        runs = self._writer.runs(found.written, self._opened and len(self.rows) > count, now)
        self._opened = True
        if len(self.rows) >= self.setup.trials:
            self.state = "complete"
        elif runs:
            self.state = "followed"
            self._stand(self._begun)
            self.left = None if self.standing is None else self.standing.left
        else:
            self.state = "stopped"
        return len(self.rows) > count or self.state != before

    # ---------------------------------------------------------------------------------------------- repeating

    def repeat(self, trial: int) -> Path:
        """Run a trial again as it ran, and return its record, which is kept in the folder of the results.

        Beside the record is the row that the repeated trial gave, so that a row that is changed later is
        refused too.

        Raises:
            RecordError: there is no row of this trial, the repeated trial gives another row, another process
                writes the folder, or `close` was called.
        """
        if self.state == "followed":
            raise RecordError("another process runs it", where=str(self.folder), fix="Wait until it ends")
        stored = next((row for row in self.rows if row["trial"] == trial), None)
        if stored is None:
            raise RecordError(f"there is no row of trial {trial}")
        path = self.folder / REPEATS / f"{trial:06}.nc"
        beside = path.with_suffix(".json")
        with self._repeating:
            if path.is_file() and beside.is_file():
                row = codec.parse(regular_file.read_text(beside))
            else:
                line = codec.line(self._again(trial, path))
                output.write(beside, line.encode(), durable=False)
                row = codec.parse(line)
            if row != computed(stored):
                path.unlink(missing_ok=True)
                beside.unlink(missing_ok=True)
                raise RecordError(
                    f"trial {trial} gives another row than the stored one",
                    where=str(self.folder),
                    fix="Another version or machine computed the rows: run the experiment again",
                )
        return path

    def prepare(self) -> None:
        """Start the worker that repeats trials, in a thread, for results that were opened: to import what it
        needs is half of the time of the first repetition.
        """
        self._thread = threading.Thread(target=self._prepare, name="deodar-repeating", daemon=True)
        self._thread.start()

    def _prepare(self) -> None:
        # an error appears when a trial is repeated
        with self._repeating, contextlib.suppress(DeodarError, OSError):
            if self.rows and not self._worker.started and not self._closing.is_set():
                self._ask(packed_experiment.prepare, packed_experiment.PackedExperiment.of(self.setup))

    def _again(self, trial: int, path: Path) -> Row:
        handed = packed_experiment.PackedExperiment.of(self.setup)
        row: Row | None = self._ask(packed_experiment.repeat, handed, trial, self.recorded(), path)
        if row is None:
            raise RecordError(f"trial {trial} was not repeated: its experiment was closed")
        return row

    def _ask(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return the result of a function in a worker; None if `close` was called meanwhile."""
        return self._worker.ask(function, arguments, lambda: not self._closing.is_set())

    def recorded(self) -> list[str]:
        """Return the ports that the record of a repeated trial contains, the small ones first: the activation
        of each field, the first output of other elements.
        """
        e, doc = self.setup.experiment, self.setup.model.document
        nodes = {node.id: node for node in graph(doc).nodes}
        frames = self.setup.steps if e.plan.every is None else e.plan.limit / e.plan.every
        size: dict[str, float] = {}
        for entry in doc.entries:
            outputs = find.outputs(entry)
            port = "activation" if "activation" in outputs else next(iter(outputs), "")
            if port and entry.id in nodes:
                cells = math.prod(shape(nodes[entry.id].axes(port)))
                size[f"{entry.path}.{port}"] = cells * (frames + 1) * (8 if e.precision == "float64" else 4)
        out, total = list(e.plan.watch), 0.0
        for path in sorted(size, key=lambda path: size[path]):
            total += size[path]
            if total <= MOST_RECORDED and path not in out:
                out.append(path)
        return out
