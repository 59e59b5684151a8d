"""How much faster than real time robots look for colours: `python benchmarks/search.py [--device gpu]`.

One Khepera in a random arena in one process, and 16, eight in each of two processes; each process keeps to
one core (`NPROC=1`). A run has the step of 2 ms, the camera of 160 x 120 pixels and the noise of
`deodar reproduce serial-order`. The time of a step is (T(4n) - T(n)) / 3n, the median of five; the sum over
the processes counts. A busy machine prints smaller numbers. Status 1 if one of them is below its target.

With `--device` it prints the same for batches of 1, 16 and 128 robots in one process on that device, and
judges nothing.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

os.environ.setdefault("NPROC", "1")
ROUNDS, SHORT = 5, 1600.0
ONE, ALL = 20.0, 60.0
"""Targets: times real time of one robot on one core, and of 16 on two."""

BATCHES = (1, 16, 128)
"""Robots in one batch on another device."""


def ratio(copies: int, device: str | None = None) -> float:
    """Simulated time of all copies of one process per wall time."""
    import deodar as dd
    from deodar_papers.serial_order.arenas import random_arena
    from deodar_papers.serial_order.runs import Settings, prepared
    from deodar_papers.serial_order.teaching import lesson
    from deodar_papers.serial_order.world import world

    arenas = [random_arena("RBGBY", (1, k), 1) for k in range(copies)]
    lessons = [lesson("RBGBY", k, 5.0) for k in range(copies)]
    longest = max(duration for _, duration in lessons)
    model = prepared(5, Settings())
    around = world(arenas, [shown for shown, _ in lessons], longest)

    def seconds(duration: float) -> float:
        began = time.perf_counter()
        record = {"record": "pose.output", "every": duration}
        dd.simulate(
            model,
            duration,
            trials=copies,
            world=around,
            on=dd.Resources(device=device, progress=False),
            **record,
        )
        return time.perf_counter() - began

    seconds(SHORT), seconds(4 * SHORT)  # compiled
    each = [seconds(4 * SHORT) - seconds(SHORT) for _ in range(ROUNDS)]
    return copies * 3 * SHORT / 1000 / statistics.median(each)


def main() -> int:
    """Measure and print; return the status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--device", help="only batches on this device, for example gpu")
    given = parser.parse_args()
    if given.device:
        for copies in BATCHES:
            times = ratio(copies, given.device)
            sys.stdout.write(f"{copies:4} robots on {given.device}: {times:.1f} times real time in all\n")
            sys.stdout.flush()
        return 0
    if hasattr(os, "getloadavg"):
        sys.stdout.write(f"load {os.getloadavg()[0]:.2f}\n")
    one = ratio(1)
    sys.stdout.write(f"one robot, one core: {one:.0f} times real time (target {ONE:g})\n")
    sys.stdout.flush()
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        both = sum(pool.map(ratio, [8, 8]))
    sys.stdout.write(f"16 robots, two cores: {both:.0f} times real time in all (target {ALL:g})\n")
    return 0 if one >= ONE and both >= ALL else 1


if __name__ == "__main__":
    sys.exit(main())
