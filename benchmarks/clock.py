"""Lag of a run behind the wall clock, and its drift, with enough time and without.

    python benchmarks/clock.py    60 s with time enough, then 10 s at a speed the machine does not reach
    python benchmarks/clock.py --seconds 5 --json

The model is one field of 101 samples with a stimulus. Overload is asked for by speed: three times what the
machine has just shown it can do. A step that may grow then has to follow the wall; one that may not falls
behind.
"""

from __future__ import annotations

import argparse
import json
import os
import time

import deodar as dd
from deodar.session.meter import Meter

OVERLOAD = 3
LONGEST = 5


def session() -> dd.Session:
    """One field of 101 samples, dt 1 ms."""
    x = dd.Axis("x", 0, 100, samples=101)
    model = dd.Model("clock")
    u = model.add(dd.Field("u", [x], tau=20, kernel=[dd.Gaussian(1, 5)], global_inhibition=0.1, noise=0.1))
    model.add(dd.GaussianStimulus("s", [x], center=50, sigma=5, amplitude=8)) >> u
    return dd.Session(model, dt=1)


def measure(seconds: float) -> dict[str, Meter]:
    """The meters of four runs: the first takes `seconds`, each of the others a sixth of it."""
    one = session()
    one.step(1000)
    part = seconds / 6
    out = {"real time": one.run_live(round(1000 * seconds))}
    out["slow motion, a tenth"] = one.run_live(round(100 * part), speed=0.1)
    # the fastest: others were disturbed
    fast = max(one.run_live(20_000, speed=None).factor for _ in range(5))
    speed = OVERLOAD * fast
    duration = round(1000 * part * fast)
    out["overload, the step stays"] = one.run_live(duration, speed=speed)
    out[f"overload, the step may grow to {LONGEST}"] = one.run_live(
        duration * OVERLOAD, speed=speed, longest_step=LONGEST
    )
    return out


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--seconds", type=float, default=60.0, help="of the run with time enough (default 60)"
    )
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    args = parser.parse_args()
    began = time.perf_counter()
    found = measure(args.seconds)
    if args.json:
        print(json.dumps({name: meter.data() for name, meter in found.items()}, indent=2))
        return
    load = f", load {os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else ""
    print(f"{os.cpu_count()} cores{load}; {time.perf_counter() - began:.0f} s in all\n")
    print(
        f"| {'run':34} | {'factor':>8} | {'wall s':>7} | {'drift ms':>9} | {'worst lag ms':>12} |"
        f" {'overruns':>8} | {'lengthened':>10} |"
    )
    print("|---|---|---|---|---|---|---|")
    for name, m in found.items():
        print(
            f"| {name:34} | {m.factor:8.4g} | {m.wall:7.2f} | {m.drift:9.3f} | {m.worst:12.2f} |"
            f" {m.overruns:8} | {m.lengthened:10} |"
        )


if __name__ == "__main__":
    main()
