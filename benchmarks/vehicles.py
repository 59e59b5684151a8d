"""What planning while driving costs: `python benchmarks/vehicles.py [steps] [hundred] [live]`, all three by
default.

`steps`: wall time of a step for each copy, in the Z-maze by the size of a batch, and in the large maze, on
one core; beside each its ratio to a step of one field of 100 x 100 in C (yardstick.c), where there is a C
compiler. `hundred`: 100 runs of the Z-maze (the published pairs of start and goal, 3,000 steps at most) in as
many worker processes as there are cores, their start included, and beside it the same in batches that
finished runs leave. `live`: how many times faster than the robot one run in a session is that a page of the
studio would watch. Nothing is asserted.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from pathlib import Path

import deodar as dd
import steps as timing
import workloads
from deodar.architectures.spa import STEP_MS, maze, spa
from deodar.compiler.device import available
from deodar.experiments.batch import run_batch
from deodar.experiments.events import Within
from deodar.experiments.jobs import Job, run_jobs
from deodar.experiments.rows import Rows
from deodar_papers.spa.cases import LIMIT, RADIUS, STAY
from deodar_papers.spa.pairs import pairs

SIZES = (1, 2, 4, 8)
STEPS = {"z": 200, "large": 60}
RUNS = 100
DONE = [Within("done", RADIUS, "pose.output", "goal.output", STAY)]
_kept: list[tuple[object, object]] = []


def a_step(name: str, copies: int) -> float:
    """Wall ms of a step of one copy in a batch; the fastest of three."""
    arena = maze(name)
    model, n = spa(arena), max(20, STEPS[name] // copies)

    def seconds(n: int) -> float:
        began = time.perf_counter()
        dd.simulate(model, n, trials=copies, world=arena, record="pose.output", every=n, progress=False)
        return time.perf_counter() - began

    seconds(n)
    return min((seconds(2 * n) - seconds(n)) / n / copies for _ in range(3)) * 1e3


def yardstick() -> float | None:
    """Ms of a step of one field of 100 x 100 in C, the fastest of nine; None without a C compiler."""
    if (cc := timing.compiler()) is None:
        return None
    w = workloads.WORKLOADS["W2_100"]
    with tempfile.TemporaryDirectory() as folder:
        program = timing.build(cc, Path(folder), "field", w.shape, w.sigmas, w.trials)
        with timing.process(str(program)) as ask:
            n = timing.count(lambda n: ask(f"{n} 1"), 0.05)
            return min((ask(f"{2 * n} 1") - ask(f"{n} 1")) / n for _ in range(9)) * 1e3


def beside_c(ms: float, c: float | None) -> str:
    """A time and its ratio to the yardstick."""
    return f"{ms:.2f} ms" + (f" ({ms / c:.0f} times C)" if c else "")


def steps() -> None:
    """A step by the size of a batch, and of both mazes."""
    c = yardstick()
    if c:
        print(f"one field of 100 x 100 in C: {c:.4f} ms a step", flush=True)
    found = {copies: a_step("z", copies) for copies in SIZES}
    for copies, ms in found.items():
        print(f"Z-maze, {copies} at once: {beside_c(ms, c)} a step of each", flush=True)
    large = a_step("large", 1)
    print(f"large maze, 1 at once: {beside_c(large, c)}, {large / found[1]:.1f} times the Z-maze", flush=True)


def batch(first: int, count: int) -> list[dict[str, object]]:
    """Rows of some runs, as one batch that those that have ended leave."""
    if not _kept:
        starts, goals = pairs("z")
        arena = maze("z", "low", starts, goals)
        _kept.append((arena, spa(arena)))
    (arena, model), trials = _kept[0], range(first, first + count)
    courses = run_batch(model, LIMIT, trials, ["touching.output"], DONE, world=arena)  # type: ignore[arg-type]
    return [
        {"key": str(k), "steps": len(c.times) - 1, "outcome": c.outcome}
        for k, c in zip(trials, courses, strict=True)
    ]


def hundred() -> None:
    """100 runs, one by one and in batches, on all cores."""
    cores = available()
    for size in (1, 4):
        jobs = [
            Job(tuple(str(j) for j in range(k, k + size)), batch, {"first": k, "count": size})
            for k in range(0, RUNS, size)
        ]
        with tempfile.TemporaryDirectory() as folder:
            rows = Rows(Path(folder) / "rows.jsonl", {})
            began = time.perf_counter()
            run_jobs(jobs, rows, workers=cores)
            wall = time.perf_counter() - began
        taken = [row["steps"] for row in rows.found.values()]
        each = (
            f"{cores * wall / RUNS:.2f} s of a core for a run, {sum(taken) / RUNS:.0f} steps on average,"
            f" {max(taken)} at most"
        )
        print(
            f"{RUNS} runs of the Z-maze, {size} at once on {cores} cores: {wall / 60:.1f} min; {each}",
            flush=True,
        )


def live() -> None:
    """A session as the studio runs it."""
    arena = maze("z")
    session = dd.Session(spa(arena), world=arena)
    session.step(20)
    meter = session.run_live(400, speed=None)
    print(
        f"Z-maze, live: {meter.steps / meter.wall:.0f} steps a second,"
        f" {meter.steps * STEP_MS / 1000 / meter.wall:.0f} times real time",
        flush=True,
    )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "what", nargs="*", choices=["steps", "hundred", "live", []], help="what to measure (default: all)"
    )
    args = parser.parse_args()
    print(
        f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.2f}"
        if hasattr(os, "getloadavg")
        else f"{os.cpu_count()} cores"
    )
    for name, measure in (("steps", steps), ("hundred", hundred), ("live", live)):
        if not args.what or name in args.what:
            measure()


if __name__ == "__main__":
    main()
