"""What a picture of a vehicle's camera costs inside the step: `python benchmarks/camera.py`.

A Khepera turns among 16 blocks. A run with a picture in every second period is timed in alternation with one
that takes a picture at the start alone; the difference is the picture's. `camera` has 160 x 120 pixels,
`line` 160; noise: hues of 6 degrees and 5 % outliers. Then what a held picture adds to a step. CPU time of
one process that keeps to one core (`NPROC=1`), medians over rounds; a busy machine prints larger numbers.
Status 1 if a picture takes longer than its target.
"""

from __future__ import annotations

import os
import statistics
import sys
import time

os.environ.setdefault("NPROC", "1")
ROUNDS, STEPS, NEVER = 7, 200, 1_000_000
MOST = {"camera": 1.0, "line": 0.1}
"""Targets: longest time of a picture, ms."""

NOISE = {"hue_noise": 6.0, "outliers": 0.05}


def blocks(count: int = 16):  # type: ignore[no-untyped-def]
    """A square arena of 2 m with coloured blocks on a ring around its middle."""
    import numpy as np

    found = []
    for k in range(count):
        angle, color = 2 * np.pi * k / count, [0.9 * (k % 3 == c) for c in range(3)]
        center = [float(0.5 * np.cos(angle)), float(0.5 * np.sin(angle))]
        found.append(
            {"name": f"block {k}", "center": center, "size": [0.05, 0.05], "height": 0.07, "color": color}
        )
    return {"arena": {"x": [-1, 1], "y": [-1, 1]}, "blocks": found, "start": [0, 0]}


def model(sensor: str):  # type: ignore[no-untyped-def]
    """A robot that turns on the spot and sees; without a camera if `sensor` is empty."""
    import deodar as dd

    shape = {"column": 160, "row": 120, "channel": 3}
    if sensor == "line":
        del shape["row"]
    found = dd.Model("looking", dt=1.0)
    if sensor:
        found.add(dd.Sensor("eye", [dd.Axis(name, 0, n - 1, n) for name, n in shape.items()], sensor))
    found.add(dd.Sensor("heading", sensor="heading"))
    for side, speed in (("left", -200.0), ("right", 200.0)):
        found.add(dd.Boost(f"turn {side}", amplitude=speed)) >> found.add(dd.Motor(side, motor=side))
    return found


def seconds(sensor: str, copies: int, period: float, every: int, noise: dict[str, float]) -> float:
    """CPU time of a run of STEPS steps of 1 ms."""
    import deodar as dd

    physics = dd.ArenaPhysics(period, camera_every=every)
    world = dd.Arena(blocks(), vehicle="khepera", physics=physics, noise=dd.ArenaNoise(**noise))
    record = {"record": "heading.output", "every": float(STEPS)}
    began = time.process_time()
    dd.simulate(
        model(sensor), float(STEPS), trials=copies, world=world, on=dd.Resources(progress=False), **record
    )
    return time.process_time() - began


def picture(sensor: str, noise: dict[str, float], copies: int) -> float:
    """Milliseconds of a picture of one copy."""
    found = []
    for _ in range(ROUNDS + 1):  # the first round compiles
        difference = seconds(sensor, copies, 1.0, 2, noise) - seconds(sensor, copies, 1.0, NEVER, noise)
        found.append(difference / (STEPS / 2) / copies * 1e3)
    return statistics.median(found[1:])


def holding(copies: int) -> float:
    """Milliseconds of a step of one copy that a held picture adds, with an exchange in each 20 steps."""
    found = []
    for _ in range(ROUNDS + 1):
        difference = seconds("camera", copies, 20.0, NEVER, {}) - seconds("", copies, 20.0, 1, {})
        found.append(difference / STEPS / copies * 1e3)
    return statistics.median(found[1:])


def main() -> int:
    """Measure and print; return the status."""
    slow = False
    if hasattr(os, "getloadavg"):
        sys.stdout.write(f"load {os.getloadavg()[0]:.2f}\n")
    for sensor, size in (("camera", "160 x 120"), ("line", "160")):
        for words, noise in (("without noise", {}), ("hue noise and outliers", NOISE)):
            for copies in (1, 16):
                ms = picture(sensor, noise, copies)
                slow = slow or ms > MOST[sensor]
                target = f"(target {MOST[sensor]:g})"
                sys.stdout.write(f"{sensor} of {size}, {words}, {copies} at once: {ms:.3f} ms {target}\n")
                sys.stdout.flush()
    for copies in (1, 16):
        sys.stdout.write(f"holding a picture, {copies} at once: {holding(copies):.4f} ms a step\n")
    return int(slow)


if __name__ == "__main__":
    sys.exit(main())
