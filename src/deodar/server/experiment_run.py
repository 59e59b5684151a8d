"""The run of an experiment: a thread that gives trials to worker processes, and one that repeats a trial."""

from __future__ import annotations

import contextlib
import math
import os
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal

from deodar import codec
from deodar.batch.pool import Pool
from deodar.errors import DeodarError, Problem, RecordError
from deodar.experiments import packed
from deodar.experiments.jobs import Progress
from deodar.experiments.record_target import RECORD
from deodar.experiments.results import run_trials
from deodar.experiments.rows import Row
from deodar.experiments.setup import Setup
from deodar.model import find, output
from deodar.model.resolve import resolve
from deodar.numerics.axes import shape

MOST_WORKERS = 8
"""Most worker processes (a guess: each takes about 300 MB)."""

MOST_RECORDED = 128 * 2**20
"""Largest size in bytes of the record of a repeated trial (a guess)."""

REPEATS = "repeats"
"""Folder of the records of repeated trials, in the folder of the results."""

State = Literal["running", "complete", "stopped", "failed"]


class ExperimentRun:
    """The trials of an experiment: their rows, which worker processes add.

    Attributes:
        setup: the opened experiment.
        folder: the folder of the results.
        rows: the rows, in the order in which they were stored; rows are only added.
        progress: how far the run is; None before the first worker has started.
        state: whether it runs, is complete, was stopped, or ended with `problems`.
        problems: the reason of a failure.
    """

    def __init__(self, setup: Setup, folder: Path, changed: Callable[[], None]) -> None:
        self.setup, self.folder, self._changed = setup, folder, changed
        self.rows: list[Row] = []
        self.progress: Progress | None = None
        self.state: State = "stopped"
        self.problems: Sequence[Problem] = ()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self._repeating = threading.Lock()
        self._closing = threading.Event()
        self._pool: Pool | None = None

    @property
    def workers(self) -> int:
        """Number of worker processes: one core is left to the studio."""
        return max(1, min(MOST_WORKERS, (os.cpu_count() or 2) - 1, len(self.setup.pieces())))

    def start(self) -> None:
        """Run the trials without a row, in a thread."""
        self.state, self.problems, self.progress = "running", (), None
        self._stop.clear()
        self._thread = threading.Thread(target=self._run, name="deodar-experiment", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            run_trials(self.setup, self.folder, self.workers, self._take, lambda now: self._stop.is_set())
        except KeyboardInterrupt:
            self.state = "stopped"
        except DeodarError as error:
            self.state, self.problems = "failed", error.problems
        except Exception as error:  # functions that the document names run in the workers
            self.state, self.problems = "failed", [Problem("", f"{type(error).__name__}: {error}")]
        else:
            self.state = "complete"
        self._changed()
        self._prepare()

    def _take(self, progress: Progress) -> None:
        known = {row["trial"] for row in self.rows}
        self.rows.extend(row for row in progress.new if row["trial"] not in known)
        self.progress = progress
        self._changed()

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
            self._end_pool()
            self._closing.clear()

    # ---------------------------------------------------------------------------------------------- repeating

    def repeat(self, trial: int) -> Path:
        """Run a trial again as it ran, and return its record, which is kept in the folder of the results.

        Beside the record is the row that the repeated trial gave, so that a row that is changed later is
        refused too.

        Raises:
            RecordError: there is no row of this trial, the repeated trial gives another row, or `close` was
                called.
        """
        stored = next((row for row in self.rows if row["trial"] == trial), None)
        if stored is None:
            raise RecordError(f"there is no row of trial {trial}")
        path = self.folder / REPEATS / f"{trial:06}.nc"
        beside = path.with_suffix(".json")
        with self._repeating:
            if path.is_file() and beside.is_file():
                row = codec.parse(beside.read_text(encoding="utf-8"))
            else:
                line = codec.line(self._again(trial, path))
                output.write(beside, line.encode(), durable=False)
                row = codec.parse(line)
            if row != {key: value for key, value in stored.items() if key != RECORD}:
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
            if self.rows and self._pool is None and not self._closing.is_set():
                self._ask(packed.prepare, packed.PackedExperiment.of(self.setup))

    def _again(self, trial: int, path: Path) -> Row:
        handed = packed.PackedExperiment.of(self.setup)
        found: list[Row] = self._ask(packed.repeat, handed, trial, self.recorded(), path)
        if not found:
            raise RecordError(f"trial {trial} was not repeated: its experiment was closed")
        return found[0]

    def _ask(self, function: Callable[..., Any], *arguments: Any) -> list[Any]:
        """Return the result of a function in a worker, which stays for the next one: its programs are
        compiled. The list is empty if `close` was called meanwhile.
        """
        if self._pool is None:
            self._pool = Pool(1, main=True).__enter__()
        try:
            self._pool.give(0, function, *arguments)
            while not self._closing.is_set():
                for _, result in self._pool.wait(0.2):
                    return [result]
        except BaseException:
            self._end_pool()
            raise
        self._end_pool()
        return []

    def _end_pool(self) -> None:
        pool, self._pool = self._pool, None
        if pool is not None:
            with contextlib.suppress(OSError):
                pool.__exit__(KeyboardInterrupt, None, None)

    def recorded(self) -> list[str]:
        """Return the ports that the record of a repeated trial contains, the small ones first: the activation
        of each field, the first output of other elements.
        """
        e, doc = self.setup.experiment, self.setup.model.document
        nodes = {node.id: node for node in resolve(doc)[0]}
        frames = self.setup.steps if e.every is None else e.limit / e.every
        size: dict[str, float] = {}
        for entry in doc.entries:
            outputs = find.outputs(entry)
            port = "activation" if "activation" in outputs else next(iter(outputs), "")
            if port and entry.id in nodes:
                cells = math.prod(shape(nodes[entry.id].axes(port)))
                size[f"{entry.path}.{port}"] = cells * (frames + 1) * (8 if e.precision == "float64" else 4)
        out, total = list(e.record), 0.0
        for path in sorted(size, key=lambda path: size[path]):
            total += size[path]
            if total <= MOST_RECORDED and path not in out:
                out.append(path)
        return out
