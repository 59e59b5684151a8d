"""What a picture of a vehicle's camera costs inside the step: `python benchmarks/camera.py`.

A Khepera turns among 16 blocks. A run with a picture in every second period is timed in alternation with one
that takes a picture at the start alone; the difference is the picture's. `camera` has 160 x 120 pixels,
`line` 160; noise: hues of 6 degrees and 5 % outliers. CPU time of one process that keeps to one core
(`NPROC=1`), medians over rounds; a busy machine prints larger numbers.
"""

from __future__ import annotations

import os
import statistics
import sys
import time

os.environ.setdefault("NPROC", "1")
ROUNDS, STEPS, NEVER = 7, 200, 1_000_000
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


def measure(sensor: str, noise: dict[str, float], copies: int = 1) -> float:
    """Milliseconds of a picture of one copy."""
    import deodar as dd

    shape = {"column": 160, "row": 120, "channel": 3}
    if sensor == "line":
        del shape["row"]
    model = dd.Model("looking", dt=1.0)
    model.add(dd.Sensor("eye", [dd.Axis(name, 0, n - 1, n) for name, n in shape.items()], sensor))
    model.add(dd.Sensor("heading", sensor="heading"))
    for side, speed in (("left", -200.0), ("right", 200.0)):
        model.add(dd.Boost(f"turn {side}", amplitude=speed)) >> model.add(dd.Motor(side, motor=side))

    def seconds(every: int) -> float:
        world = dd.Arena(blocks(), vehicle="khepera", period=1.0, camera_every=every, **noise)
        began = time.process_time()
        dd.simulate(
            model,
            float(STEPS),
            trials=copies,
            record="heading.output",
            every=float(STEPS),
            world=world,
            progress=False,
        )
        return time.process_time() - began

    found = []
    for n in range(ROUNDS + 1):  # the first round compiles
        difference = seconds(2) - seconds(NEVER)
        if n:
            found.append(difference / (STEPS / 2) / copies * 1e3)
    return statistics.median(found)


def main() -> None:
    """Measure and print."""
    if hasattr(os, "getloadavg"):
        sys.stdout.write(f"load {os.getloadavg()[0]:.2f}\n")
    for sensor, size in (("camera", "160 x 120"), ("line", "160")):
        for words, noise in (("without noise", {}), ("hue noise and outliers", NOISE)):
            for copies in (1, 16):
                ms = measure(sensor, noise, copies)
                sys.stdout.write(f"{sensor} of {size}, {words}, {copies} at once: {ms:.3f} ms\n")
                sys.stdout.flush()


if __name__ == "__main__":
    main()
