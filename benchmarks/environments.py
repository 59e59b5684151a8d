"""Periods per second of closed loops as environments: `python benchmarks/environments.py`.

An agent sets the speeds of the wheels of an e-puck among blocks, and observes its infrared sensors and pose;
a period is 64 ms, four steps of the model. COPIES single environments take a period one after another, in
alternation with a vector environment of as many copies, with the same actions; an episode ends when the robot
is 40 cm away. CPU time of one process that keeps to one core (`NPROC=1`), so that other processes matter
little; medians over rounds. Status 1 if the vector environment has less than LEAST times the periods per
second.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from typing import Any

os.environ.setdefault("NPROC", "1")
COPIES, PERIODS, ROUNDS = 64, 20, 15
LEAST = 20.0
"""Target: periods per second of the vector environment, relative to single environments."""


def environment(copies: int | None = None) -> Any:
    """An e-puck whose wheels an agent drives; an episode ends when it has moved by 40 cm."""
    import deodar as dd

    model = dd.Model("drive", dt=16.0)
    for side in ("left", "right"):
        model.add(dd.Boost(side, amplitude=0.0)) >> model.add(dd.Motor(f"{side} wheel", motor=side))
    model.add(dd.Sensor("eyes", [dd.Axis("sensor", 0, 7, 8)], sensor="infrared"))
    model.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    arena = dd.Arena("blocks", unit="cm", start=(20, 30, 0.4))
    bounds = {"left.amplitude": (-400.0, 400.0), "right.amplitude": (-400.0, 400.0)}
    far = dd.Leaves("far", 40.0, of="pose", ends=True)
    return dd.as_env(model, bounds, ["eyes", "pose"], until=far, world=arena, copies=copies)


def main() -> int:
    import numpy as np

    random = np.random.default_rng(0)
    vector, singles = environment(COPIES), [environment() for _ in range(COPIES)]
    vector.reset(seed=0)
    for k, single in enumerate(singles):
        single.reset(seed=0, options={"trial": k})
    times: dict[str, list[float]] = {"single": [], "vector": []}
    ended = {"single": 0, "vector": 0}
    for _ in range(ROUNDS + 1):
        actions = random.uniform(100, 400, (PERIODS, COPIES, 2))
        began = time.process_time()
        for action in actions:
            for k, single in enumerate(singles):
                _, _, over, _, _ = single.step(action[k])
                if over:
                    ended["single"] += 1
                    single.reset()
        times["single"].append((time.process_time() - began) / PERIODS / COPIES)
        began = time.process_time()
        for action in actions:
            ended["vector"] += int(vector.step(action)[2].sum())
        times["vector"].append((time.process_time() - began) / PERIODS / COPIES)
    times = {name: found[1:] for name, found in times.items()}  # the first round compiles
    rates = {name: 1 / statistics.median(found) for name, found in times.items()}
    ratios = [one / many for one, many in zip(times["single"], times["vector"], strict=True)]
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores; episodes that ended: {ended}")
    print(f"{COPIES} single environments   {rates['single']:9.0f} periods per second of CPU time")
    print(f"{COPIES} copies in one step    {rates['vector']:9.0f} periods per second of CPU time")
    ratio = statistics.median(ratios)
    print(f"ratio {ratio:.1f} (rounds: {min(ratios):.1f} to {max(ratios):.1f}), target {LEAST:g}")
    return int(ratio < LEAST)


if __name__ == "__main__":
    sys.exit(main())
