"""Trials of an experiment that are run again on another kind of machine, to compare their outcomes."""

from __future__ import annotations

import csv
import dataclasses as dc
import io
import math
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path

from deodar.batch.driver import PoolTask, driven
from deodar.batch.on_cluster import ClusterPool
from deodar.errors import RunWarning
from deodar.experiments.jobs import MACHINE, Job, named
from deodar.experiments.rows import KEY, Rows
from deodar.model import output
from deodar.session.interrupt import stoppable

SHARE = 0.02
"""Share of the pieces that are run on two kinds of machines."""

TABLE = "machines.csv"


@dc.dataclass(frozen=True)
class ComparedTrial:
    """The outcome of one trial on two kinds of machines.

    Attributes:
        trial: number of the trial.
        machines: the machine of its row, and the other one.
        outcomes: the outcome on each.
    """

    trial: int
    machines: tuple[str, str]
    outcomes: tuple[str, str]

    @property
    def equal(self) -> bool:
        """Whether both outcomes are the same."""
        return self.outcomes[0] == self.outcomes[1]


def compare(jobs: Sequence[Job], rows: Rows, pool: ClusterPool, out: Path) -> None:
    """Run a share of the pieces again on another kind of machine, and write their outcomes as `machines.csv`.

    Nothing is done where the workers are of one kind, or the file exists. Rows stay as they are.

    Warns:
        RunWarning: outcomes differ.
    """
    path = out / TABLE
    if path.exists():
        return
    trials = list(_compared(jobs, rows, pool))
    if not trials:
        return
    output.write(path, _table(trials).encode())
    different = sum(not trial.equal for trial in trials)
    if different:
        warnings.warn(
            f"{different} of {len(trials)} compared trials have another outcome on another kind of machine:"
            f" see {path}",
            RunWarning,
            stacklevel=2,
        )


def _compared(jobs: Sequence[Job], rows: Rows, pool: ClusterPool) -> Iterator[ComparedTrial]:
    with stoppable() as check:

        def look() -> None:
            check()
            pool.look()

        for _, repeated in driven(pool, _elsewhere(jobs, rows, pool), lambda: None, look):
            for row in repeated:
                stored = rows.found[row[KEY]]
                machines = str(stored.get(MACHINE, "")), str(row[MACHINE])
                if machines[0] != machines[1]:  # a worker of the other kind may have left
                    outcomes = str(stored["outcome"]), str(row["outcome"])
                    yield ComparedTrial(int(row["trial"]), machines, outcomes)


def _elsewhere(jobs: Sequence[Job], rows: Rows, pool: ClusterPool) -> Iterator[PoolTask]:
    """Yield the tasks of the pieces that are compared, each on another kind of machine than before."""
    for job in chosen(jobs):
        first_kind = str(rows.found[job.keys[0]].get(MACHINE, ""))
        other_kind = next((kind for kind in pool.machines if kind != first_kind), None)
        if other_kind is not None:
            unrecorded = dc.replace(job, arguments={**job.arguments, "records": None})
            yield PoolTask(job.keys, named, (unrecorded,), {"machine": other_kind})


def chosen(jobs: Sequence[Job]) -> list[Job]:
    """Return the pieces that are compared: `SHARE` of them, at least one, at regular distances."""
    count = math.ceil(SHARE * len(jobs))
    return [jobs[k * len(jobs) // count] for k in range(count)]


def _table(trials: Sequence[ComparedTrial]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["trial", "machine", "outcome", "other machine", "other outcome", "equal"])
    for trial in sorted(trials, key=lambda trial: trial.trial):
        (first_machine, second_machine), (first_outcome, second_outcome) = trial.machines, trial.outcomes
        writer.writerow(
            [trial.trial, first_machine, first_outcome, second_machine, second_outcome, trial.equal]
        )
    return text.getvalue()
