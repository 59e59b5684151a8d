"""Prints the figures that the project promises, each beside its target: `python benchmarks/run.py [NAME
...]`.

Times are CPU time (user and system) of processes that keep to one core (`NPROC=1`), medians over repetitions.
Nothing is asserted: a busy machine prints larger numbers. workloads.py has the workloads, steps.py their
timing, README.md the meaning of the columns.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import dataclasses as dc
import io
import json
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

import recording
import steps
import workloads

HERE = Path(__file__).parent
SHOWN: list[tuple[str, float, str, float]] = []
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
    subprocess.run(
        [sys.executable, *(["-c", code] if code else []), *arguments],
        check=True,
        env=environment,
        stdout=subprocess.DEVNULL,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def show(name: str, value: float, unit: str, target: float) -> None:
    SHOWN.append((name, value, unit, target))
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
    """W1_200: one field of 200 samples with excitation, inhibition, global inhibition, a stimulus, noise in
    every step.
    """
    import deodar as dd

    n = 200
    x = dd.Axis("x", 0, n, samples=n, periodic=True)
    model = dd.Model("one field")
    kernel = [dd.Gaussian(15, 5, normalized=True), dd.Gaussian(-8, 10, normalized=True)]
    u = model.add(
        dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.1, noise=1.0)
    )
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
    """60 fields with 300 couplings, from the model to the first step: with nothing kept, and with the
    compiled programs kept on disk.
    """
    for name, cold, warm in (("A", 2, 0.8), ("B", 2, 0.8), ("C", 4, 0.8)):
        code = f"""
import sys, time
sys.path.insert(0, {str(HERE)!r})
import graphs, jax, deodar as dd
dd.Session; jax.devices()
model = dict(
    A=lambda: graphs.line_fields(0), B=lambda: graphs.line_fields(100), C=graphs.mixed_fields
)["{name}"]()
before = time.process_time()
dd.Session(model).step(1)
print(time.process_time() - before)
"""

        def seconds(cache: str, code: str = code) -> float:
            environment = os.environ | {"NPROC": "1", "DEODAR_CACHE": cache}
            return float(
                subprocess.run(
                    [sys.executable, "-c", code], check=True, env=environment, capture_output=True, text=True
                ).stdout
            )

        show(
            f"graph {name}, 60 fields, 300 couplings: first step, nothing kept",
            statistics.median(seconds("off") for _ in range(3)),
            "s",
            cold,
        )
        with tempfile.TemporaryDirectory() as cache:
            seconds(cache)
            show(
                f"graph {name}: the same, compiled programs kept",
                statistics.median(seconds(cache) for _ in range(3)),
                "s",
                warm,
            )


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


def recorded() -> None:
    """A run that keeps the activation every ten steps beside one that keeps nothing; see recording.py."""
    without, every_ten = recording.measure("W1_200", recording.NAMES["W1_200"], 5)
    show("W1_200, kept every 10 steps: a step over one that keeps nothing", every_ten / without, "x", 1.05)


PARTS: dict[str, Callable[[], None]] = {
    "start": start_up,
    "field": one_field,
    "compile": compile_times,
    "memory": memory,
    "recording": recorded,
}
MARKS = ("<!-- table -->", "<!-- end of the table -->")


def machine() -> dict[str, str]:
    """What the figures were taken on."""
    import jax
    import jaxlib.version
    import numpy as np

    import deodar
    from deodar.numerics import native

    processor = platform.processor() or platform.machine()
    with contextlib.suppress(OSError):
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        processor = next(
            (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), processor
        )
        widest = [
            name
            for name in ("avx512f", "avx2")
            if any(line.startswith("flags") and name in line.split() for line in lines)
        ]
        processor = ", ".join([processor, *widest[:1]])
    cc = steps.compiler()
    told = (
        subprocess.run([cc, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
        if cc
        else "none"
    )
    versions = {
        "deodar": deodar.__version__,
        "jax": jax.__version__,
        "jaxlib": jaxlib.version.__version__,
        "numpy": np.__version__,
    }
    return {
        "date": time.strftime("%Y-%m-%d"),
        "system": platform.platform(),
        "processor": f"{processor}, {os.cpu_count()} cores",
        "python": platform.python_version(),
        "versions": ", ".join(f"{name} {version}" for name, version in versions.items()),
        "kernels": _kernels(native.version(native.kernels("cpu", "float32"))),
        "compiler": told,
    }


def _kernels(version: str) -> str:
    """The compiled kernels that the steps call."""
    return f"deodar-native {version}" if version else "none (JAX alone)"


def load() -> str:
    """The load of the last 1, 5 and 15 minutes, where the system reports it."""
    return " ".join(f"{x:.1f}" for x in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"


def workload_table(rows: list[steps.Row]) -> list[str]:
    """Lines of text, readable as they are and as Markdown."""
    head = (
        f"| {'workload':12} | {'us a step':>9} | {'C, us':>8} | {'ratio':>7} | {'of':6} | {'earlier C':>9} |"
        f" {'target':>6} | {'spread':>6} |"
    )
    lines = [head + f" {'what it is':68} |"]
    lines.append("|" + "|".join("-" * len(cell) for cell in lines[0].split("|")[1:-1]) + "|")
    for r in rows:
        c, ratio, earlier = (
            f"{x:.{digits}f}" if x is not None else "-"
            for x, digits in ((r.c_us, 3), (r.ratio, 2), (r.earlier, 2))
        )
        target = "-" if r.target is None else f"{r.target:g}"
        lines.append(
            f"| {r.name:12} | {r.us:9.3f} | {c:>8} | {ratio:>7} | {r.to:6} | {earlier:>9} | {target:>6} |"
            f" {r.spread:6.0%} | {r.meaning:68} |"
        )
    return lines


def write_readme(about: dict[str, str], rows: list[steps.Row]) -> None:
    """The last table in README.md, and that of docs/speed.md."""
    facts = [f"- {name}: {value}" for name, value in about.items()]
    promised = ["| figure | value | target |", "|---|---|---|"]
    promised += [
        f"| {name} | {value:.3f} {unit} | {target:g} {unit} |" for name, value, unit, target in SHOWN
    ]
    body = [*facts, "", *workload_table(rows), *(["", *promised] if SHOWN else [])]
    between_marks(HERE / "README.md", body)
    between_marks(SPEED, speed_table(about, rows))


PEERS = HERE / "peers.csv"
SPEED = HERE.parent / "docs" / "speed.md"
PROGRAMS = "juniper", "cosivina_python"


def peers() -> dict[tuple[str, str], float]:
    """Return for each workload and program its time of a step over that of the yardstick (peers.csv).

    Those times were taken beside the earlier yardstick; `Workload.earlier` converts them.
    """
    with PEERS.open(encoding="utf-8", newline="") as text:
        return {
            (row["workload"], row["program"]): float(row["us"])
            / float(row["c_us"])
            * workloads.WORKLOADS[row["workload"]].earlier
            for row in csv.DictReader(text)
        }


def speed_table(about: dict[str, str], rows: list[steps.Row]) -> list[str]:
    """Lines of the table on docs/speed.md: workloads with a yardstick, as ratios to it."""
    known = peers()
    lines = [
        f"Measured on {about['date']}, {about['processor']}, one of them used; Python {about['python']},",
        f"{about['versions']}; {about['compiler']}; compiled kernels: {about['kernels']}.",
        "",
        f"| model | C, us a step | deodar, us | deodar / C | {' | '.join(f'{p} / C' for p in PROGRAMS)} |",
        "|---|---|---|---|" + "---|" * len(PROGRAMS),
    ]
    for r in rows:
        if r.c_us is None or r.ratio is None or workloads.WORKLOADS[r.name].world:
            continue
        beside = [digits(known[r.name, p]) if (r.name, p) in known else "-" for p in PROGRAMS]
        lines.append(
            f"| {r.meaning} | {digits(r.c_us)} | {digits(r.us)} | {r.ratio:.2f} | {' | '.join(beside)} |"
        )
    return lines


def digits(value: float) -> str:
    """Return a number with three digits, or all before the point."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def between_marks(path: Path, body: list[str]) -> None:
    """Replace the lines between the marks of a page."""
    before, rest = path.read_text(encoding="utf-8").split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    path.write_text("\n".join([before + MARKS[0], "", *body, "", MARKS[1] + after]), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    known = [*PARTS, *workloads.WORKLOADS, steps.CLOSED_LOOP]
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"all of them, or some of: {', '.join(known)}"
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="the workloads only (unless others are named), fewer rounds, less sure",
    )
    parser.add_argument(
        "--json", action="store_true", help="one JSON object on the standard output, nothing else"
    )
    parser.add_argument(
        "--readme", action="store_true", help="write the tables into benchmarks/README.md and docs/speed.md"
    )
    given = parser.parse_args()
    steps.require_known(parser, given.names, known)
    os.environ["NPROC"] = "1"
    with contextlib.redirect_stdout(io.StringIO() if given.json else sys.stdout):
        about = machine() | {"load before": load()}
        print(
            f"{about['system']}, {about['processor']}\nPython {about['python']}, {about['versions']}; C:"
            f" {about['compiler']}; compiled kernels: {about['kernels']}; load {load()}"
        )
        if steps.compiler() is None:
            print(
                "No C compiler was found (gcc, clang, cc, or the one that CC names): the ratios to C are left"
                " out."
            )
        timed = [name for name in known if name not in PARTS and (not given.names or name in given.names)]
        rows: list[steps.Row] = []
        if timed:
            with tempfile.TemporaryDirectory() as folder:
                rows = steps.measure(timed, *((3, 0.05) if given.quick else (9, 0.08)), Path(folder))
            print("\n".join(workload_table(rows)), flush=True)
        for name in PARTS:
            if name in given.names or not (given.names or given.quick):
                PARTS[name]()
        about["load after"] = load()
        print(f"load {load()}")
    if given.readme:
        write_readme(about, rows)
    if given.json:
        figures = [dict(zip(("name", "value", "unit", "target"), figure, strict=True)) for figure in SHOWN]
        print(
            json.dumps(
                {"machine": about, "workloads": [dc.asdict(r) for r in rows], "figures": figures}, indent=1
            )
        )


if __name__ == "__main__":
    main()
