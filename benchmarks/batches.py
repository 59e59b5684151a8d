"""What cores and batches bring: `python benchmarks/batches.py [cores] [rounding] [sizes] [sweeps] [workers]`.

`cores`: wall and CPU time of a step of one run on one core and on all, each in a process of its own.
`rounding`: the same on one core with separate rounding. `sizes`: CPU time of a step for each copy over the
number of copies in one batch, on one core. `sweeps`: the same for 400 points of a sweep, by the parameter
that differs between them. `workers`: wall time of 64 trials in this process, and shared among as many
workers as there are cores, their start included. Medians of three; nothing is asserted.
"""

from __future__ import annotations

import argparse
import functools
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import deodar as dd
import workloads
from deodar.compiler.device import available

SINGLE = {
    "W1_100": 40_000,
    "W1_200": 40_000,
    "W2_50": 4_000,
    "W2_100": 1_000,
    "W2_200": 250,
    "W3": 100,
    "W4a": 2_000,
    "W4b": 200,
}
BATCHED = {"W1_200": 1.0, "W2_50": 9.0, "W2_100": 40.0, "W2_200": 160.0, "W4a": 12.0, "W4b": 210.0}
"""Workloads, and about how many microseconds a step of one copy takes."""

SIZES = (1, 2, 4, 8, 16, 24, 32, 48, 64, 100, 200, 400)
MOST_CELLS = 12_000_000
POINTS = 400
TRIALS, LONG = 64, {"W1_200": 40_000, "W2_50": 4_000}


def step(run: Callable[[int], Any], n: int) -> tuple[float, float]:
    """Wall and CPU microseconds a step."""

    def times(n: int) -> tuple[float, float]:
        wall, cpu = time.perf_counter(), time.process_time()
        run(n)
        return time.perf_counter() - wall, time.process_time() - cpu

    run(n)
    rounds = [(times(n), times(2 * n)) for _ in range(3)]
    wall, cpu = (statistics.median(b[k] - a[k] for a, b in rounds) / n * 1e6 for k in (0, 1))
    return wall, cpu


def one_run(cores: int, separate: bool) -> None:
    """In a process of its own: a step of each workload."""
    dd.use_cores(cores)
    if separate:
        dd.use_separate_rounding()
    about = f"{cores:3} cores" + (", separate rounding" if separate else "")
    for name, n in SINGLE.items():
        model = workloads.WORKLOADS[name].model()
        wall, cpu = step(lambda n, model=model: dd.simulate(model, n, on=dd.Resources(progress=False)), n)
        print(f"{name:8} {about}: wall {wall:9.2f} us, CPU {cpu:9.2f} us", flush=True)


def cores() -> None:
    environment = {name: value for name, value in os.environ.items() if name != "NPROC"}
    for n in dict.fromkeys((1, available())):
        subprocess.run([sys.executable, __file__, "--one-run", str(n)], check=True, env=environment)


def rounding() -> None:
    environment = {name: value for name, value in os.environ.items() if name != "NPROC"}
    for more in ([], ["--separate"]):
        subprocess.run([sys.executable, __file__, "--one-run", "1", *more], check=True, env=environment)


def sizes() -> None:
    from deodar.model.document_graph import graph
    from deodar.session.memory import copy_bytes

    for name, us in BATCHED.items():
        model = workloads.WORKLOADS[name].model()
        size = copy_bytes(graph(model.document).nodes, "float32")
        shown: list[str] = []
        for copies in SIZES:
            if size * copies <= 4 * MOST_CELLS:
                n = max(4, int(150_000 / (us * copies)))
                run = functools.partial(
                    dd.simulate, model, trials=copies, on=dd.Resources(batch=copies, progress=False)
                )
                shown.append(f"{copies}: {step(run, n)[1] / copies:.2f}")
        print(f"{name:8} {size / 1024:7.1f} KiB a copy; us a step and copy  {'  '.join(shown)}", flush=True)


def sweeps() -> None:
    """A step by what differs between the points: nothing of the kernels, an amplitude, or a width."""
    values = {"resting_level": (-6.0, -4.0), "kernel.0.amplitude": (10.0, 20.0), "kernel.0.sigma": (4.0, 6.0)}
    for name in ("W1_100", "W1_200"):
        model = workloads.WORKLOADS[name].model()
        for path, (low, high) in values.items():
            points = [low + (high - low) * k / (POINTS - 1) for k in range(POINTS)]
            run = functools.partial(
                dd.simulate, model, sweep={f"u.{path}": points}, on=dd.Resources(progress=False)
            )
            _, cpu = step(run, 300)
            print(f"{name:8} {path:20} {cpu / POINTS:6.2f} us a step of one copy", flush=True)


def workers() -> None:
    for name, n in LONG.items():
        model = workloads.WORKLOADS[name].model()
        for count in (None, available()):
            for _ in range(2):  # the second time no program is compiled again
                began = time.perf_counter()
                dd.simulate(model, n, trials=TRIALS, on=dd.Resources(workers=count, progress=False))
                seconds = time.perf_counter() - began
            print(
                f"{name:8} {TRIALS} trials of {n} steps, {f'{count} workers' if count else 'one batch here'}:"
                f" {seconds:.2f} s",
                flush=True,
            )


PARTS: dict[str, Callable[[], None]] = {
    "cores": cores,
    "rounding": rounding,
    "sizes": sizes,
    "sweeps": sweeps,
    "workers": workers,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "names",
        nargs="*",
        choices=[*PARTS, []],
        metavar="NAME",
        help=f"all of them, or some of: {', '.join(PARTS)}",
    )
    parser.add_argument("--one-run", type=int, metavar="CORES", help=argparse.SUPPRESS)
    parser.add_argument("--separate", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one_run:
        return one_run(given.one_run, given.separate)
    dd.use_cores(1)
    for name, part in PARTS.items():
        if not given.names or name in given.names:
            part()
    return None


if __name__ == "__main__":
    main()
