"""Prints the figures that the project promises, each beside its target: `python benchmarks/run.py [NAME ...]`.

Times are CPU time (user and system) of processes that keep to one core (`NPROC=1`), medians over repetitions. Nothing is
asserted: a busy machine prints larger numbers.
"""

from __future__ import annotations

import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).parent
FIRST_RESULT = """
import deodar as dd
x = dd.Axis("x", 0, 100, samples=101)
model = dd.Model("first")
u = model.add(dd.Field("u", [x], kernel=[dd.Gaussian(1.2, 5)], global_inhibition=0.4, noise=0.1))
model.add(dd.GaussianStimulus("s", [x], center=30, sigma=5, amplitude=6)) >> u
data = dd.simulate(model, 200)
assert data["u.activation"].shape == (1, 101)
"""


def child(code: str, *arguments: str, cache: str | None = None) -> float:
    """CPU seconds of a process of its own."""
    environment = os.environ | {"NPROC": "1"} | ({} if cache is None else {"DEODAR_CACHE": cache})
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *(["-c", code] if code else []), *arguments], check=True, env=environment, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def show(name: str, value: float, unit: str, target: float) -> None:
    print(f"{name:62} {value:9.3f} {unit:4} (target <= {target:g})", flush=True)


def start_up() -> None:
    """From `import deodar` to the first result of a one-field model, as whole processes."""
    with tempfile.TemporaryDirectory() as cache:
        cold = [child(FIRST_RESULT, cache=str(Path(cache) / str(k))) for k in range(5)]
        child(FIRST_RESULT, cache=cache)
        warm = [child(FIRST_RESULT, cache=cache) for _ in range(5)]
    show("first result, no compiled program kept: CPU of a process", statistics.median(cold), "s", 4)
    show("first result, compiled programs kept: CPU of a process", statistics.median(warm), "s", 2)
    help_ = [child("", "-m", "deodar", "--help") for _ in range(5)]
    show("deodar --help: CPU of a process", statistics.median(help_), "s", 0.5)


def one_field() -> None:
    """W1_200: one field of 200 samples with excitation, inhibition, global inhibition, a stimulus, noise in every step."""
    import deodar as dd

    n = 200
    x = dd.Axis("x", 0, n, samples=n, periodic=True)
    model = dd.Model("one field")
    kernel = [dd.Gaussian(15, 5, normalized=True), dd.Gaussian(-8, 10, normalized=True)]
    u = model.add(dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.1, noise=1.0))
    model.add(dd.GaussianStimulus("s", [x], center=n // 2, sigma=3, amplitude=6)) >> u
    single = slope(lambda steps: dd.simulate(model, steps), 10_000)
    show("W1_200: one step of one field of 200 samples", single * 1e6, "us", 8)
    batch = slope(lambda steps: dd.simulate(model, steps, trials=100), 500)
    show("W1_200, 100 trials at once: one step of the batch", batch * 1e3, "ms", 0.5)


def slope(run: Callable[[int], object], steps: int) -> float:
    """CPU seconds a step: (T(2n) - T(n)) / n, median of five."""

    def cpu(n: int) -> float:
        before = time.process_time()
        run(n)
        return time.process_time() - before

    cpu(steps)
    return statistics.median((cpu(2 * steps) - cpu(steps)) / steps for _ in range(5))


def compile_times() -> None:
    """60 fields with 300 couplings, from the model to the first step, nothing kept."""
    for name, target in (("A", 3), ("B", 3), ("C", 6)):
        seconds = []
        for _ in range(3):
            code = f"""
import sys, time
sys.path.insert(0, {str(HERE)!r})
import graphs, jax, deodar as dd
dd.Session; jax.devices()
model = {{"A": lambda: graphs.line_fields(0), "B": lambda: graphs.line_fields(100), "C": graphs.mixed_fields}}["{name}"]()
before = time.process_time()
dd.Session(model).step(1)
print(time.process_time() - before)
"""
            environment = os.environ | {"NPROC": "1", "DEODAR_CACHE": "off"}
            done = subprocess.run([sys.executable, "-c", code], check=True, env=environment, capture_output=True, text=True)
            seconds.append(float(done.stdout))
        show(f"graph {name}, 60 fields and 300 couplings: compile and first step", statistics.median(seconds), "s", target)


def memory() -> None:
    """Growth of a process over a long run that records nothing on the way."""
    import psutil

    import deodar as dd

    x = dd.Axis("x", 0, 100, samples=101)
    model = dd.Model("memory")
    model.add(dd.Field("u", [x], kernel=[dd.Gaussian(1.2, 5)], noise=0.1))
    dd.simulate(model, 1000)
    before = psutil.Process().memory_info().rss
    dd.simulate(model, 500_000)
    after = psutil.Process().memory_info().rss
    show("growth over 500,000 steps of 101 samples without records", (after - before) / 2**20, "MiB", 5)


PARTS: dict[str, Callable[[], None]] = {"start": start_up, "field": one_field, "compile": compile_times, "memory": memory}


def main() -> None:
    os.environ["NPROC"] = "1"
    print(f"{platform.platform()}, Python {platform.python_version()}, {os.cpu_count()} cores")
    for name in sys.argv[1:] or PARTS:
        PARTS[name]()


if __name__ == "__main__":
    main()
