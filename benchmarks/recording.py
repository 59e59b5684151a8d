"""What recording costs: `python benchmarks/recording.py [memory] [file] [probes] [long]`.

`memory`: a step while the activation is kept every ten steps, against a step while nothing is; CPU time, the
smallest of all rounds, because disturbances only add to it. `file`: wall time that a frame of 50 x 50 samples
adds to a run that writes each step into a file (limit 100 us). `probes`: wall time of a step of 20 fields,
ten of them recorded into a file at every tenth step, against the same run without records (limit 1.10), over
runs of about 10 s; to create and close a record takes 0.1 s of them.
`long`: memory of a process that records a field at every step, after a tenth of 10^7 steps and at their end,
and its size without records. In each round both runs are made in turn, in one process. The runs of `memory`
have one core; the others have a second one, on which a thread writes.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil

import deodar as dd
import workloads

NAMES = {"W1_100": 300_000, "W1_200": 250_000, "W2_50": 25_000, "W4a": 30_000}
"""Workloads, and how many steps take 0.2 to 0.3 s, so that a run has several chunks."""

EVERY = 10
FRAMES, STEPS, LONG = 20_000, 180_000, 10**7


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
        return dd.simulate(model, n, on=dd.Resources(progress=False))

    def recorded(n: int) -> Any:
        return dd.simulate(model, n, record=[port], every=EVERY, on=dd.Resources(progress=False))

    without(n)
    recorded(n)
    pairs = [(step(without, n), step(recorded, n)) for _ in range(rounds)]
    return min(a for a, _ in pairs), min(b for _, b in pairs)


def memory(rounds: int) -> None:
    """Print what records in memory cost."""
    print(f"{'workload':10} {'us a step':>10} {f'every {EVERY}':>10} {'ratio':>7}")
    for name, n in NAMES.items():
        without, recorded = measure(name, n, rounds)
        print(f"{name:10} {without:10.3f} {recorded:10.3f} {recorded / without:7.3f}", flush=True)


def paired(model: dd.Model, n: int, rounds: int, **record: Any) -> tuple[float, float]:
    """Return the medians of the wall time of a run of `n` steps, without records and into a file."""
    folder = Path(tempfile.mkdtemp())
    times: tuple[list[float], list[float]] = ([], [])
    try:
        for k in range(rounds + 1):
            for kind, more in enumerate(({}, {**record, "out": folder / f"{k}"})):
                began = time.perf_counter()
                dd.simulate(model, n, seed=k, on=dd.Resources(progress=False), **more)
                if k:
                    times[kind].append(time.perf_counter() - began)
            shutil.rmtree(folder / f"{k}")
    finally:
        shutil.rmtree(folder)
    return statistics.median(times[0]), statistics.median(times[1])


def file(rounds: int) -> None:
    """Print what a frame of 50 x 50 samples costs."""
    model = workloads.WORKLOADS["W2_50"].model()
    without, recorded = paired(model, FRAMES, rounds, record="u", every=1)
    cost = (recorded - without) / FRAMES * 1e6
    print(f"file: a frame of 50 x 50 costs {cost:.1f} us (limit 100); a step {without / FRAMES * 1e6:.1f} us")


def twenty() -> dd.Model:
    """Return 20 fields in a chain: lines of 100 samples, and every fourth a plane of 50 x 50."""
    model = dd.Model("twenty")
    x, y = dd.Axis("x", 0, 50, samples=50), dd.Axis("y", 0, 50, samples=50)
    line = dd.Axis("z", 0, 100, samples=100)
    for k in range(20):
        axes = [x, y] if k % 4 == 0 else [line]
        model.add(dd.Field(f"u{k}", axes, kernel=[dd.Gaussian(5, 3)], noise=0.1))
        if k >= 4 and k % 4 == 0:
            model.connect(f"u{k - 4}", f"u{k}")
    return model


def probes(rounds: int) -> None:
    """Print how much ten probes at every tenth step slow down a model of 20 fields."""
    names = [f"u{k}" for k in range(0, 20, 2)]
    without, recorded = paired(twenty(), STEPS, rounds, record=names, every=10)
    print(
        f"probes: ten of 20 fields at every tenth step take {recorded / without:.3f} of the time without"
        f" records (limit 1.10); a step {without / STEPS * 1e6:.1f} us"
    )


def recorded_long(steps: int, out: str) -> None:
    """Record a small field for many steps and print the memory of the process on the way."""
    model = dd.Model("long")
    model.add(dd.Field("u", [dd.Axis("x", 0, 20, samples=20)], kernel=[dd.Gaussian(5, 3)], noise=0.1))
    dd.simulate(model, 1000, on=dd.Resources(progress=False))
    process, seen = psutil.Process(), [psutil.Process().memory_info().rss]

    def note(done: int) -> None:
        if done >= steps * len(seen) / 10:
            seen.append(process.memory_info().rss)

    dd.simulate(model, steps, record="u", every=1, out=out, on=dd.Resources(progress=note))
    print(f"{seen[0] / 2**20:.0f} {seen[1] / 2**20:.0f} {max(seen[2:]) / 2**20:.0f}")


def long(rounds: int) -> None:
    """Print how memory grows over a long record."""
    folder = tempfile.mkdtemp()
    try:
        code = f"import recording; recording.recorded_long({LONG}, {folder + '/run'!r})"
        command = [sys.executable, "-c", code]
        done = subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True, check=True)
        before, tenth, most = done.stdout.split()
        size = sum(f.stat().st_size for f in Path(folder).rglob("*") if f.is_file()) / 2**20
        print(
            f"long: {LONG:.0e} steps, a record of {size:.0f} MiB; the process had {before} MiB without"
            f" records, {tenth} MiB after a tenth of the steps, at most {most} MiB after that"
        )
    finally:
        shutil.rmtree(folder)


PARTS: dict[str, Callable[[int], None]] = {"memory": memory, "file": file, "probes": probes, "long": long}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("parts", nargs="*", choices=[*PARTS, []], metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--rounds", type=int, default=9, help="rounds of each measurement (default 9)")
    given = parser.parse_args()
    wanted = given.parts or list(PARTS)
    if wanted == ["memory"]:
        dd.use_cores(1)
    elif "memory" in wanted:
        subprocess.run([sys.executable, __file__, "memory", "--rounds", str(given.rounds)], check=True)
        wanted = [part for part in wanted if part != "memory"]
    for part in wanted:
        PARTS[part](given.rounds)


if __name__ == "__main__":
    main()
