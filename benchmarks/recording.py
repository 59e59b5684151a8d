"""What recording costs: a step while the activation is kept every ten steps, against a step while nothing is:
`python benchmarks/recording.py`.

Both are asked in turn, in one process on one core. A step is the CPU time of a run of n steps, all that the
call does included, over n. The smallest of all rounds counts, because what disturbs a run only adds to it.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import deodar as dd
import workloads

NAMES = {"W1_100": 300_000, "W1_200": 250_000, "W2_50": 25_000, "W4a": 30_000}
"""Workloads, and how many steps take 0.2 to 0.3 s, so that a run has several chunks."""

EVERY = 10


def step(run: Callable[[int], Any], n: int) -> float:
    """CPU microseconds a step."""
    before = time.process_time()
    run(n)
    return (time.process_time() - before) / n * 1e6


def measure(name: str, n: int, rounds: int) -> tuple[float, float]:
    """Microseconds a step of a workload, without and with records."""
    model = workloads.WORKLOADS[name].model()
    port = "u.activation" if "u" in model else "u0.activation"

    def without(n: int) -> Any:
        return dd.simulate(model, n, progress=False)

    def recorded(n: int) -> Any:
        return dd.simulate(model, n, record=[port], every=EVERY, progress=False)

    without(n)
    recorded(n)
    pairs = [(step(without, n), step(recorded, n)) for _ in range(rounds)]
    return min(a for a, _ in pairs), min(b for _, b in pairs)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9, help="rounds of each workload (default 9)")
    given = parser.parse_args()
    dd.use_cores(1)
    print(f"{'workload':10} {'us a step':>10} {f'every {EVERY}':>10} {'ratio':>7}")
    for name, n in NAMES.items():
        without, recorded = measure(name, n, given.rounds)
        print(f"{name:10} {without:10.3f} {recorded:10.3f} {recorded / without:7.3f}", flush=True)


if __name__ == "__main__":
    main()
