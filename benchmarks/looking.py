"""Print how fast one eye runs: simulated time over wall time, on one core, for both mechanisms.

    python benchmarks/looking.py [--seconds 60]

The loop is that of `deodar reproduce looking`: fields, map, camera and screen in one compiled program. The
first call compiles and is not counted.
"""

from __future__ import annotations

import argparse
import time

import deodar as dd
from deodar.architectures.looking import MECHANISMS
from deodar_papers.looking.gazes import observed

REPEATS = 3


def speed(mechanism: str, seconds: float) -> float:
    """Return simulated time over wall time, the best of some runs."""
    model, world = observed(mechanism), dd.Eye()

    def run(duration: float) -> float:
        began = time.perf_counter()
        dd.simulate(
            model,
            duration,
            record="satisfied.activation",
            every=10,
            world=world,
            on=dd.Resources(progress=False),
        )
        return time.perf_counter() - began

    run(100.0)
    return max(seconds / run(seconds * 1000) for _ in range(REPEATS))


def main() -> None:
    """Print a line for each mechanism."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated seconds of a run")
    args = parser.parse_args()
    dd.use_cores(1)
    for mechanism in MECHANISMS:
        print(f"{mechanism}: {speed(mechanism, args.seconds):.1f} times real time")


if __name__ == "__main__":
    main()
