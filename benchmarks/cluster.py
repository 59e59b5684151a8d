"""An experiment on a cluster of this machine: whether rows agree, what survives kills, and what it costs.

    python benchmarks/cluster.py rows     # rows of this process, of two workers and of local:2
    python benchmarks/cluster.py kills    # workers, callers and schedulers are killed at random moments
    python benchmarks/cluster.py cost     # processor time of the caller for each task, and efficiency

`kills` repeats a call until it is complete, as a user would. A row is lost if the complete folder has none of
its trial, double if it has two, different if it is not that of a run in one process. A call hangs if it takes
more than three times as long as an undisturbed one. Any of these fails. The load of the machine is printed:
times are judged on a quiet machine only.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import psutil

WORKERS = 2
PIECE = 5
"""Number of trials of a piece."""


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
    return dd.Experiment("decisions", model, steps, trials // 2, crosses, factors=factors, measures=measures)


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
        f"cluster.experiment({given.trials}, {given.steps}).run({str(folder)!r}, cluster={cluster!r})"
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
    """Compare the rows of this process, of worker processes and of a cluster."""
    right, _ = in_process(folder, given)
    good = True
    for name, how in (("workers=2", {"workers": WORKERS}), ("local:2", {"cluster": f"local:{WORKERS}"})):
        experiment(given.trials, given.steps).run(folder / name, **how)
        lost, double, different = compared(folder / name, right)
        print(f"{name:10} {len(right)} rows: {lost} lost, {double} double, {different} different")
        good &= not (lost or double or different)
    return good


def kills(given: argparse.Namespace, folder: Path) -> bool:
    """Kill workers, callers and schedulers at random moments."""
    right, _ = in_process(folder, given)
    began = time.perf_counter()
    call(folder / "calm", given, f"local:{WORKERS}").wait()
    calm, good = time.perf_counter() - began, True
    print(f"undisturbed {calm:.1f} s, {compared(folder / 'calm', right)} lost, double, different")
    draw = random.Random(given.seed)
    for number in range(given.rounds):
        for what in ("worker", "all workers", "caller", "scheduler"):
            place = folder / f"{what.replace(' ', '-')}-{number}"
            killed, calls, longest = disturbed(place, given, what, draw, calm)
            found = compared(place, right)
            good &= found == (0, 0, 0) and longest <= 3 * calm
            print(
                f"{what:12} {killed} killed, {calls} calls, the longest {longest / calm:.1f} times as long;"
                f" lost, double, different: {found}; load {os.getloadavg()[0]:.1f}",
                flush=True,
            )
    return good


def disturbed(
    place: Path, given: argparse.Namespace, what: str, draw: random.Random, calm: float
) -> tuple[int, int, float]:
    """Repeat a call until it is complete; kill at most `given.kills` times, at random moments after the first
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
            if due is None and killed < given.kills and len(stored(place)) > before:
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
    """Print the processor time of the caller for each task, and the efficiency of the workers."""
    from deodar.batch.cluster import Cluster
    from deodar.batch.on_cluster import ClusterPool
    from deodar.experiments.jobs import Job, run_jobs
    from deodar.experiments.rows import Rows

    right, here = in_process(folder, given)
    with ClusterPool(Cluster(f"local:{WORKERS}")) as pool:
        began, cpu = time.perf_counter(), time.process_time()
        keys = [f"{k:06}" for k in range(given.tasks)]
        jobs = [Job((key,), json.loads, {"s": json.dumps([{"key": key}])}) for key in keys]
        run_jobs(jobs, Rows(folder / "rows.jsonl", {}), cluster=pool)
        cpu, wall = time.process_time() - cpu, time.perf_counter() - began
    print(
        f"{given.tasks} tasks of one row: {1000 * cpu / given.tasks:.2f} ms of the caller's processor each"
        f" (with the scheduler, and the row on the disk), {wall:.1f} s in total;"
        f" load {os.getloadavg()[0]:.1f}"
    )
    began = time.perf_counter()
    experiment(given.trials, given.steps).run(folder / "there", cluster=f"local:{WORKERS}")
    wall = time.perf_counter() - began
    print(
        f"{len(right)} trials: {here:.1f} s in one process, {wall:.1f} s on local:{WORKERS} with its start;"
        f" efficiency {here / wall / WORKERS:.2f}"
    )
    return True


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", choices=("rows", "kills", "cost"))
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--kills", type=int, default=3, help="kills of a round")
    parser.add_argument("--tasks", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    os.environ["NPROC"] = "1"
    print(f"load {os.getloadavg()[0]:.1f}; times count on a quiet machine only")
    with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
        good = {"rows": rows, "kills": kills, "cost": cost}[given.what](given, Path(folder))
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
