"""Jobs: the trials of an experiment in pieces that run one by one, or in parallel processes."""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from deodar.batch.driver import PoolTask, Staffing, WorkerWatch, driven
from deodar.batch.on_cluster import ClusterPool
from deodar.batch.pool import Pool
from deodar.experiments.rows import KEY, Row, Rows
from deodar.progress import telling
from deodar.resources import Resources, use_resources
from deodar.session.interrupt import stoppable

MACHINE = "machine"
"""Key of the machine of a row, where rows of several kinds of machines are stored together."""

USABLE = ("workers", "cluster", "progress")
"""The resources that an experiment uses."""


@dataclass(frozen=True)
class Job:
    """A piece of an experiment: one trial, or several that are run as one batch.

    Its rows depend on its arguments alone, so that it can be run at any time, in any process, and again.

    Attributes:
        keys: keys of the rows that it returns.
        function: a function of a module, called with `arguments`, which returns the rows.
        arguments: plain data.
        cost: approximate duration in s; only ratios matter, for the estimate of the remaining time.
    """

    keys: tuple[str, ...]
    function: Callable[..., Sequence[Row]]
    arguments: Mapping[str, Any]
    cost: float = 1.0

    def run(self) -> Sequence[Row]:
        """Return the rows."""
        return self.function(**self.arguments)


def run_jobs(
    jobs: Sequence[Job],
    rows: Rows,
    on: Resources = Resources(),
    pool: ClusterPool | None = None,
    watch: WorkerWatch | None = None,
) -> None:
    """Run the jobs whose rows are missing, and store their rows.

    After a kill at any moment the same call resumes, with the same results.

    Args:
        jobs: all of the experiment.
        rows: the store of rows; a job all of whose rows exist is not run again.
        on: workers, else this process runs one job after another; its `progress` counts trials, and is called
            after each job. Only a script that defines what the jobs use, such as a world, has to call this
            below `if __name__ == "__main__":`, because workers import it.
        pool: the workers of a cluster that run the jobs, in place of those of `on`: an entered
            `dd.ClusterPool`.
        watch: function that is called several times a second while workers run, with the numbers of present
            workers and of the jobs that they have (`workers` and `running`); once it returns true, the
            running jobs are ended, and their rows are not stored.

    Raises:
        KeyboardInterrupt: on Ctrl-C, after the running jobs have ended; their rows are stored. Or `watch`
            returned true.
        WorkerError: a worker process has died, or a cluster cannot run the jobs.
    """
    with telling(use_resources(on, "run_jobs", *USABLE).progress, "running", "trials") as show:
        missing = [job for job in jobs if not all(key in rows.found for key in job.keys)]
        total = sum(job.cost for job in jobs)
        before = total - sum(job.cost for job in missing)
        began, done = time.monotonic(), 0.0
        of = sum(len(job.keys) for job in jobs)
        complete = sum(key in rows.found for job in jobs for key in job.keys)

        def tell(new: Sequence[Row]) -> None:
            seconds = time.monotonic() - began
            seconds_left = seconds / done * (total - before - done) if done else None
            share = (before + done) / total if total else 1.0
            show(complete, of, share=share, seconds_left=seconds_left, new=new)

        stored = {row[KEY]: row for row in rows.found.values()}
        tell([stored[key] for job in jobs for key in job.keys if key in stored])
        del stored
        for job, rows_of_job in _anywhere(missing, on.workers, watch or (lambda staffing: False), pool):
            new = rows.append(rows_of_job)
            done += job.cost
            complete += len({row[KEY] for row in new} & {*job.keys})
            tell(new)


def _anywhere(
    jobs: Sequence[Job], workers: int | None, ends: WorkerWatch, cluster: ClusterPool | None
) -> Iterator[tuple[Job, Sequence[Row]]]:
    if not jobs or not (workers or cluster):
        with stoppable() as check:
            for job in jobs:
                check()
                yield job, job.run()
            check()
    elif cluster is not None:
        yield from _in_workers(jobs, cluster, ends)
    else:
        # what a script defines is pickled by the name of its module
        main = b"__main__" in pickle.dumps(jobs[0])
        with Pool(min(workers or 1, len(jobs)), main) as pool:
            yield from _in_workers(jobs, pool, ends)


def _in_workers(
    jobs: Sequence[Job], pool: Pool | ClusterPool, ends: WorkerWatch
) -> Iterator[tuple[Job, Sequence[Row]]]:
    by_key = {job.keys: job for job in jobs}
    run = named if isinstance(pool, ClusterPool) and pool.cluster.mixed else Job.run

    def look() -> None:
        if ends(Staffing(pool.workers, pool.busy)):
            raise KeyboardInterrupt

    with stoppable() as check:
        # a pool has one or two tasks per worker: after Ctrl-C only these are awaited
        for keys, rows in driven(pool, (PoolTask(job.keys, run, (job,)) for job in jobs), check, look):
            yield by_key[keys], rows


def named(job: Job) -> list[Row]:
    """Return the rows of a job with the machine that this worker runs on."""
    # start-up time: this brings JAX
    from deodar.recording.provenance import machine

    return [{**row, MACHINE: machine()} for row in job.run()]
