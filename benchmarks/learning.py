"""What an association map between two planes costs in a step: `python benchmarks/learning.py`.

Two fields of 32 x 32 samples are joined by a map of all their places (a million weights, eq. 12). A step is
timed with the map and without it, in alternation, and the difference is the map's: while both fields have a
peak (read and changed), while only the source has one (read), and while neither has. CPU time of one process
that keeps to one core (`NPROC=1`), medians over rounds; a busy machine prints larger numbers.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Sequence

os.environ.setdefault("NPROC", "1")
SIDE, ROUNDS, STEPS = 32, 7, 500
CASES = {
    "both ends active": (True, True, 1.5),
    "source active": (True, False, 1.5),
    "target active": (False, True, 0.05),
    "idle": (False, False, 0.05),
}


def model(on: Sequence[bool], joined: bool):  # type: ignore[no-untyped-def]
    """Two planes with a peak each, where wanted, and the map between them."""
    import deodar as dd
    from deodar.couplings.hebbian import Hebbian

    m = dd.Model("association")
    kernel = [dd.Gaussian(15, 2, normalized=True), dd.Gaussian(-8, 5, normalized=True)]
    fields = []
    for name, axes, there in (("source", "xy", on[0]), ("target", "pq", on[1])):
        plane = [dd.Axis(a, 0, SIDE, SIDE, periodic=True) for a in axes]
        fields.append(m.add(dd.Field(name, plane, kernel=kernel)))
        (
            m.add(
                dd.GaussianStimulus(
                    f"to {name}", plane, center=SIDE // 2, sigma=2, amplitude=8.0 if there else 0.0
                )
            )
            >> fields[-1]
        )
    if joined:
        plane = list(fields[1].element.axes)
        w = m.add(
            Hebbian(plane, "association", rate=0.001, random=True, share=0.1, initial=0.001, name="map")
        )
        m.connect(fields[0], w["input"])
        m.connect(fields[1], w["post"])
        m.connect(w, fields[1])
    return m


def measure(on: Sequence[bool], rounds: int = ROUNDS, steps: int = STEPS) -> tuple[float, float]:
    """Milliseconds a step of the map alone, and of the whole model with it."""
    import deodar as dd

    sessions = [dd.Session(model(on, joined)) for joined in (True, False)]
    times: list[list[float]] = [[], []]
    for session in sessions:
        session.step(200)  # peaks stand
        active = [bool((session.read(f"{name}.output") > 0.5).any()) for name in ("source", "target")]
        if active != list(on):
            raise RuntimeError(f"peaks at source and target: {active}, wanted {list(on)}")
    for _ in range(rounds):
        for session, taken in zip(sessions, times, strict=True):
            before = time.process_time()
            session.step(steps)
            taken.append(1e3 * (time.process_time() - before) / steps)
    whole, without = (statistics.median(t) for t in times)
    return whole - without, whole


def main() -> None:
    for name, (source, target, most) in CASES.items():
        alone, whole = measure((source, target))
        print(
            f"map {SIDE}x{SIDE} to {SIDE}x{SIDE}, {name:17} {alone:8.4f} ms a step (target <= {most:g}); the"
            f" whole model {whole:.4f} ms",
            flush=True,
        )


if __name__ == "__main__":
    sys.exit(main())
