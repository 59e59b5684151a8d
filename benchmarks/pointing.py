"""Speed of the pointing arm: simulated time over wall time, on one core, with the camera computed by rays.

    python benchmarks/pointing.py
    python benchmarks/pointing.py --seconds 30

One session with five objects on the table, noise on, and the cues "green left" given once a cycle. It fails
below the target of 3 times real time.
"""

from __future__ import annotations

import argparse
import os
import sys
import time

TARGET = 3.0
CYCLE = 4.0


def main() -> int:
    """Measure, print one line, and return 1 below the target."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=20.0, help="simulated seconds")
    args = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    # after the choice of the core
    from deodar_papers.pointing.narrative import discs
    from deodar_papers.pointing.table import Table

    at = Table(discs(), 0)
    at.session.step(50)
    began, simulated = time.perf_counter(), 0.0
    while simulated < args.seconds:
        at.say(("green", "left"))
        at.session.step(40)
        at.say(())
        at.session.step(round(100 * CYCLE) - 40)
        simulated += CYCLE
    factor = simulated / (time.perf_counter() - began)
    print(f"{factor:.1f} times real time on one core (wanted at least {TARGET:g})")
    return 0 if factor >= TARGET else 1


if __name__ == "__main__":
    sys.exit(main())
