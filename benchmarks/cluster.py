"""An experiment on a cluster of this machine: whether rows agree, what survives kills, and what it costs.

    python benchmarks/cluster.py rows         # ten experiments in this process, by workers, on two clusters
    python benchmarks/cluster.py kills        # workers, callers and schedulers are killed at random moments
    python benchmarks/cluster.py kills --long # 20 kills of workers, 5 of the caller, 2 of the scheduler
    python benchmarks/cluster.py cost         # processor time of the caller for each task
    python benchmarks/cluster.py many         # memory of the caller, and reading: --trials 1000000
    python benchmarks/cluster.py efficiency   # two workers against one, for pieces of several lengths

`kills` repeats a call until it is complete, as a user would. A row is lost if the complete folder has none of
its trial, double if it has two, different if it is not that of a run in one process. A call hangs if it takes
more than three times as long as an undisturbed one. Any of these fails. The load of the machine is printed:
times are judged on a quiet machine only, that is below a load of 1 at the start.
"""

from __future__ import annotations

import argparse
import dataclasses as dc
import json
import os
import random
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import psutil

WORKERS = 2
PIECE = 5
"""Number of trials of a piece."""

QUIET = 1.0
"""Load of the machine from which on times are not judged."""

TASK_MS, ROWS_SECONDS, MEMORY, READ_SECONDS, FIRST_SECONDS, EFFICIENCY = 15.0, 5.0, 200.0, 10.0, 3.0, 0.90
"""Targets, of our own: processor time of the caller for a task in ms, and for 10,000 rows in s; memory that
10,000 trials add to the caller in MiB; wall time to read a table in s; wall time of a worker's first piece,
with stored programs, in s; efficiency of two workers with pieces of one second and more."""

LENGTHS = (0.1, 0.3, 1.0, 3.0)
"""Durations of a piece in s whose efficiency is measured."""

LONG = {"worker": 20, "all workers": 2, "caller": 5, "scheduler": 2}
"""Numbers of kills of the long form."""


def experiment(trials: int, steps: int) -> Any:
    """Return an experiment of a node that noise drives over its threshold, with two levels."""
    import deodar as dd
    from deodar.experiments import setup

    setup.MOST_COPIES = PIECE
    model = dd.Model("decision")
    x = dd.Axis("x", 0, 100, samples=101)
    model.add(dd.Field("u", [x], tau=20, resting_level=-4, noise=2.0, kernel=[dd.Gaussian(1.0, 5)]))
    factors = [dd.Factor("level", [-4.0, -5.0], "u.resting_level")]
    measures = [dd.Measure("end", "u.activation", "max")]
    crosses = [dd.Crosses("decided", "u.activation", 6.0)]
    return dd.Experiment(
        "decisions",
        model,
        dd.TrialPlan(steps, events=crosses, measures=measures),
        trials // 2,
        factors=factors,
    )


def stored(folder: Path) -> list[str]:
    """Return the rows of a folder as text, in the order of trials."""
    file = folder / "trials.jsonl"
    lines = file.read_text().split("\n")[:-1] if file.exists() else []
    return sorted(line for line in lines if '"key"' in line)


def compared(folder: Path, right: list[str]) -> tuple[int, int, int]:
    """Return the numbers of rows that are lost, double and different."""
    rows = stored(folder)
    keys, wanted = [json.loads(row)["key"] for row in rows], [json.loads(row)["key"] for row in right]
    return len(set(wanted) - set(keys)), len(keys) - len(set(keys)), len(set(rows) - set(right))


def call(folder: Path, given: argparse.Namespace, cluster: str) -> subprocess.Popen[bytes]:
    """Start a process that runs the experiment on a cluster."""
    code = (
        f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); import cluster\n"
        f"from deodar.resources import Resources; on = Resources(cluster={cluster!r})\n"
        f"cluster.experiment({given.trials}, {given.steps}).run({str(folder)!r}, on=on)"
    )
    return subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL)


def workers(of: int) -> list[psutil.Process]:
    """Return the worker processes below a process."""
    out = list[psutil.Process]()
    try:
        for one in psutil.Process(of).children(recursive=True):
            if any("spawn_main" in part for part in one.cmdline()) and one.status() != "zombie":
                out.append(one)
    except psutil.NoSuchProcess:
        pass
    return out


SCHEDULER = """
import time
from distributed import LocalCluster
if __name__ == "__main__":
    made = LocalCluster(n_workers={workers}, threads_per_worker=1, host="127.0.0.1",
                        scheduler_port={port}, dashboard_address="127.0.0.1:0", memory_limit=0)
    print(made.scheduler_address, flush=True)
    time.sleep(100000)
"""


def scheduler(folder: Path) -> tuple[subprocess.Popen[str], str]:
    """Start a scheduler with workers in a process of its own; return it and its address."""
    script = folder / "scheduler.py"
    script.write_text(SCHEDULER.format(workers=WORKERS, port=0))
    process = subprocess.Popen(
        [sys.executable, script], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    assert process.stdout is not None
    return process, process.stdout.readline().strip()


def in_process(folder: Path, given: argparse.Namespace) -> tuple[list[str], float]:
    """Run the experiment in this process; return its rows and the wall time of a second run."""
    experiment(given.trials, given.steps).run(folder / "compiled")
    began = time.perf_counter()
    experiment(given.trials, given.steps).run(folder / "here")
    return stored(folder / "here"), time.perf_counter() - began


def rows(given: argparse.Namespace, folder: Path) -> bool:
    """Compare the rows of ten experiments in this process, in worker processes and on clusters."""
    from cluster_experiments import TEN
    from deodar.experiments import setup

    setup.MOST_COPIES, good = PIECE, True
    ways: dict[str, dict[str, Any]] = {"workers=2": {"workers": 2}}
    ways |= {f"local:{n}": {"cluster": f"local:{n}"} for n in (2, 4)}
    for name, make in TEN.items():
        out = folder / name
        out.mkdir()
        run(make(given.trials), out / "here")
        right = stored(out / "here")
        outcomes = sorted({json.loads(row)["outcome"] for row in right})
        for way, how in ways.items():
            run(make(given.trials), out / way, **how)
        found = {way: compared(out / way, right) for way in ways}
        good &= len(right) == given.trials and not any(any(each) for each in found.values())
        print(
            f"{name:10} {len(right)} rows ({', '.join(outcomes)}); lost, double, different: {found}",
            flush=True,
        )
    return good


def run(made: Any, folder: Path, **how: Any) -> None:
    """Run an experiment; trials that diverge are part of it."""
    from deodar.resources import Resources

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made.run(folder, on=Resources(**how))


def kills(given: argparse.Namespace, folder: Path) -> bool:
    """Kill workers, callers and schedulers at random moments."""
    right, _ = in_process(folder, given)
    began = time.perf_counter()
    call(folder / "calm", given, f"local:{WORKERS}").wait()
    calm, good = time.perf_counter() - began, True
    print(f"undisturbed {calm:.1f} s, {compared(folder / 'calm', right)} lost, double, different")
    draw = random.Random(given.seed)
    wanted = LONG if given.long else dict.fromkeys(LONG, given.kills * given.rounds)
    for what, of in wanted.items():
        killed_so_far, number = 0, 0
        while killed_so_far < of and number < of + 3:
            number += 1
            place = folder / f"{what.replace(' ', '-')}-{number}"
            most = min(given.kills, of - killed_so_far)
            killed, calls, longest = disturbed(place, given, what, most, draw, calm)
            killed_so_far += killed
            found = compared(place, right)
            good &= found == (0, 0, 0) and longest <= 3 * calm
            print(
                f"{what:12} {killed} killed, {calls} calls, the longest {longest / calm:.1f} times as long;"
                f" lost, double, different: {found}; load {os.getloadavg()[0]:.1f}",
                flush=True,
            )
        good &= killed_so_far >= of
    return good


def disturbed(
    place: Path, given: argparse.Namespace, what: str, most: int, draw: random.Random, calm: float
) -> tuple[int, int, float]:
    """Repeat a call until it is complete; kill at most `most` times, at random moments after the first
    row of a call. Return the kills, the calls and the wall time of the longest call.
    """
    killed, calls, longest = 0, 0, 0.0
    while calls < 20:
        calls += 1
        server, address = None, f"local:{WORKERS}"
        if what == "scheduler":
            server, address = scheduler(place.parent)
        began = time.perf_counter()
        before, process = len(stored(place)), call(place, given, address)
        due: float | None = None
        while process.poll() is None and time.perf_counter() - began < 5 * calm:
            now = time.perf_counter()
            if due is None and killed < most and len(stored(place)) > before:
                due = now + draw.random() * calm / 8
            if due is not None and now >= due:
                due, before, killed = None, len(stored(place)), killed + 1
                if what == "caller":
                    process.kill()
                elif server is not None:
                    server.kill()
                else:
                    targets = workers(process.pid)
                    if what == "worker":
                        targets = draw.sample(targets, min(1, len(targets)))
                    for one in targets:
                        one.kill()
            time.sleep(0.01)
        hung = process.poll() is None
        process.kill()
        longest = max(longest, time.perf_counter() - began)
        if server is not None:
            for one in workers(server.pid):
                one.kill()
            server.kill()
            server.wait()
        if hung or process.wait() == 0:
            break
    return killed, calls, longest


def cost(given: argparse.Namespace, folder: Path) -> bool:
    """Print the processor time of the caller for each task of one row."""
    from deodar.batch.on_cluster import ClusterPool
    from deodar.cluster import Cluster
    from deodar.experiments.jobs import Job, run_jobs
    from deodar.experiments.rows import Rows

    with ClusterPool(Cluster(f"local:{WORKERS}")) as pool:
        began, cpu = time.perf_counter(), time.process_time()
        keys = [f"{k:06}" for k in range(given.tasks)]
        jobs = [Job((key,), json.loads, {"s": json.dumps([{"key": key}])}) for key in keys]
        run_jobs(jobs, Rows(folder / "rows.jsonl", {}), pool=pool)
        cpu, wall = time.process_time() - cpu, time.perf_counter() - began
    each = 1000 * cpu / given.tasks
    print(
        f"{given.tasks} tasks of one row: {each:.2f} ms of the caller's processor each (at most {TASK_MS:g};"
        f" with the scheduler, and the row on the disk), {wall:.1f} s in total; load {os.getloadavg()[0]:.1f}"
    )
    return each <= TASK_MS


def many(given: argparse.Namespace, folder: Path) -> bool:
    """Run many short trials of 100 nodes; print memory and time of the caller, and the time of reading."""
    import deodar as dd

    model = dd.Model("nodes")
    for k in range(100):
        model.add(dd.Field(f"n{k}", [], tau=20, resting_level=-1, noise=3.0))
    measures = [dd.Measure("end", "n0.activation", "max")]
    seen = [dd.Crosses("decided", "n0.activation")]
    made = dd.Experiment("nodes", model, dd.TrialPlan(10, events=seen, measures=measures), given.trials)
    dd.Experiment("warm", model, dd.TrialPlan(10, events=seen, measures=measures), 250).run()
    before, cpu, began = resident(), time.process_time(), time.perf_counter()
    most, first = before, list[float]()

    def told(progress: Any) -> None:
        nonlocal most
        now = resident()
        first[:] = first or ([now] if progress.rows else [])
        most = max(most, now)

    run(made, folder / "many", cluster=f"local:{WORKERS}", progress=told)
    most = max(most, resident())
    cpu, wall = time.process_time() - cpu, time.perf_counter() - began
    began = time.perf_counter()
    data = dd.load_results(folder / "many")
    reading = time.perf_counter() - began
    size = (folder / "many" / "trials.jsonl").stat().st_size / 2**20
    per = 1e4 * cpu / given.trials
    print(
        f"{data.sizes['trial']} trials in {wall:.0f} s: the caller grew by {most - before:.0f} MiB, of which"
        f" {first[0] - before:.0f} before the first rows; {per:.1f} s of its processor for 10,000 rows (with"
        f" the scheduler); {size:.0f} MiB of rows read in {reading:.1f} s; load {os.getloadavg()[0]:.1f}"
    )
    good = data.sizes["trial"] == given.trials and per <= ROWS_SECONDS
    return good and (most - before <= MEMORY or given.trials > 10_000) and reading <= READ_SECONDS


def resident() -> float:
    """Return the memory of this process in MiB."""
    return psutil.Process().memory_info().rss / 2**20


def efficiency(given: argparse.Namespace, folder: Path) -> bool:
    """Print the efficiency of two workers for pieces of several lengths, and how long a first piece takes.

    The time of a run begins with its first piece: start-up is printed by itself.
    """
    from deodar.experiments import setup

    setup.MOST_COPIES, quiet, good = PIECE, os.getloadavg()[0] < QUIET, True
    run(steady(PIECE, 20_000), folder / "compiled")
    began = time.perf_counter()
    run(steady(PIECE, 20_000), folder / "measured")
    rate = 20_000 / (time.perf_counter() - began)
    for length in LENGTHS:
        pieces = 2 * max(5, round(given.seconds / length / 2))
        made = steady(PIECE * pieces, 10 * round(rate * length / 10))
        (alone, first, start), (both, _, _) = (
            timed(made, folder / f"{length}-{n}.jsonl", n) for n in (1, WORKERS)
        )
        found = alone / both / WORKERS
        good &= not quiet or ((length < 1 or found >= EFFICIENCY) and first <= FIRST_SECONDS + length)
        print(
            f"pieces of {alone / pieces:.2f} s: {pieces} in {alone:.1f} s on one worker, {both:.1f} s on"
            f" {WORKERS}, efficiency {found:.2f}; first piece after {first:.2f} s; start of one worker"
            f" {start:.1f} s; load {os.getloadavg()[0]:.1f}",
            flush=True,
        )
    return good


def steady(trials: int, steps: int) -> Any:
    """Return an experiment whose trials all last to the limit."""
    return dc.replace(experiment(trials, steps), conditions=(), every=10)


def timed(made: Any, file: Path, count: int) -> tuple[float, float, float]:
    """Run an experiment on some workers; return the wall times of all pieces, of the first one, and of the
    start.
    """
    from deodar.batch.on_cluster import ClusterPool
    from deodar.cluster import Cluster
    from deodar.experiments import packed_experiment
    from deodar.experiments.jobs import Job, run_jobs
    from deodar.experiments.rows import Rows
    from deodar.resources import Resources

    setup, began, first = made.setup(), time.perf_counter(), list[float]()
    handed = packed_experiment.PackedExperiment.of(setup)
    jobs = [
        Job(
            tuple(f"{k:06}" for k in piece),
            packed_experiment.work,
            {"handed": handed, "trials": piece, "records": None},
        )
        for piece in setup.pieces()
    ]
    with ClusterPool(Cluster(f"local:{count}")) as pool:
        pool.everywhere(packed_experiment.prepare, handed)
        start, began = time.perf_counter() - began, time.perf_counter()

        def told(progress: Any) -> None:
            if progress.rows and not first:
                first.append(time.perf_counter() - began)

        run_jobs(jobs, Rows(file, {}), Resources(progress=told), pool)
        return time.perf_counter() - began, first[0], start


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", choices=("rows", "kills", "cost", "many", "efficiency"))
    parser.add_argument(
        "--trials", type=int, help="20 of each of ten experiments, 200 of others, 10,000 of many"
    )
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--kills", type=int, default=3, help="kills of a round")
    parser.add_argument("--tasks", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--long", action="store_true", help=f"kills: {LONG}")
    parser.add_argument("--seconds", type=float, default=30.0, help="duration of a run on one worker")
    given = parser.parse_args()
    given.trials = given.trials or {"rows": 20, "many": 10_000}.get(given.what, 200)
    os.environ["NPROC"] = "1"
    print(f"load {os.getloadavg()[0]:.1f}; times count on a quiet machine only")
    with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
        parts = {"rows": rows, "kills": kills, "cost": cost, "many": many, "efficiency": efficiency}
        good = parts[given.what](given, Path(folder))
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
