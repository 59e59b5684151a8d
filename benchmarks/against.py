"""Time the workloads of this checkout and of another one in alternation.

python benchmarks/against.py FOLDER [NAME ...]    FOLDER: a checkout of another commit, such as a git worktree

Both run in the Python that runs this command, each with its own `src`. Prints for each workload the time of a
step in both and their ratio. A time is the lower decile of many short calls: what else the machine does makes
calls longer, never shorter.

With `--first` it prints the CPU time from the model to its first step, with no compiled program kept, each
time in a process of its own; the models are those of this checkout's workloads.py. A time is the median.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import statistics
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import steps
import workloads

HERE = Path(__file__).parent
SECONDS = 0.05
"""CPU time of a call of n steps."""


def decile(times: Sequence[float]) -> float:
    """Return the lower decile."""
    return sorted(times)[len(times) // 10]


def compare(theirs: Callable[[int], float], ours: Callable[[int], float], n: int, rounds: int) -> list[float]:
    """Return the seconds of a step of each; both are asked for n and 2n steps in every round."""
    askers = (theirs, ours)
    times: list[tuple[list[float], list[float]]] = [([], []), ([], [])]
    for k in range(rounds):
        for which in (0, 1) if k % 2 else (1, 0):
            for part, m in enumerate((n, 2 * n)):
                times[which][part].append(askers[which](m))
    return [(decile(twice) - decile(once)) / n for once, twice in times]


FIRST_STEP = """
import sys, time
sys.path.insert(0, sys.argv[1])
import jax
import deodar as dd
import workloads
w = workloads.WORKLOADS[sys.argv[2]]
model, world = w.model(), w.world() if w.world else None
jax.devices()
before = time.process_time()
if w.session:
    dd.Session(model, world=world).step(1)
else:
    step = model.document.step
    dd.simulate(model, step, trials=w.trials or None, world=world, on=dd.Resources(progress=False))
print(time.process_time() - before)
"""


def first_step(folder: Path, name: str) -> float:
    """CPU seconds from the model to its first step, with the `src` of a checkout and nothing kept."""
    environment = os.environ | {"NPROC": "1", "DEODAR_CACHE": "off", "PYTHONPATH": str(folder / "src")}
    command = [sys.executable, "-c", FIRST_STEP, str(HERE), name]
    done = subprocess.run(command, check=True, env=environment, capture_output=True, text=True)
    return float(done.stdout)


def compare_first(folder: Path, names: Sequence[str], rounds: int) -> None:
    """Print the time to the first step of each workload in both checkouts, in alternation."""
    print(f"| {'workload':12} | {'theirs, s':>9} | {'ours, s':>9} | ratio |")
    print(f"|{'-' * 14}|{'-' * 11}|{'-' * 11}|-------|")
    for name in names:
        times: tuple[list[float], list[float]] = ([], [])
        for k in range(rounds):
            for which in (0, 1) if k % 2 else (1, 0):
                times[which].append(first_step((folder, HERE.parent)[which], name))
        a, b = map(statistics.median, times)
        print(f"| {name:12} | {a:9.3f} | {b:9.3f} | {b / a:5.3f} |", flush=True)


def server(folder: Path) -> contextlib.AbstractContextManager[Callable[[str], float]]:
    """The process that times the workloads of a checkout."""
    script = folder / "benchmarks" / "steps.py"
    return steps.process(sys.executable, str(script), PYTHONPATH=str(folder / "src"))


def main() -> None:
    known = [*workloads.WORKLOADS, steps.CLOSED_LOOP]
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="the other checkout")
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"all of them, or some of: {', '.join(known)}"
    )
    parser.add_argument("--first", action="store_true", help="time to the first step, which compiles")
    parser.add_argument("--rounds", type=int, help="rounds of each workload (default 40; with --first 5)")
    given = parser.parse_args()
    steps.require_known(parser, given.names, known)
    if not (given.folder / "benchmarks" / "steps.py").exists():
        parser.error(f"{given.folder} is no checkout with benchmarks/steps.py")
    if given.first:
        names = given.names or list(workloads.WORKLOADS)
        return compare_first(given.folder.resolve(), names, given.rounds or 5)
    with server(given.folder.resolve()) as theirs, server(HERE.parent) as ours:
        print(f"| {'workload':12} | {'theirs, us':>10} | {'ours, us':>10} | ratio |")
        print(f"|{'-' * 14}|{'-' * 12}|{'-' * 12}|-------|")
        for name in given.names or known:
            both = [lambda n, name=name, ask=ask: ask(f"{name} {n}") for ask in (theirs, ours)]
            both[0](20)
            n = steps.count(both[1], SECONDS)
            a, b = compare(both[0], both[1], n, given.rounds or 40)
            print(f"| {name:12} | {1e6 * a:10.3f} | {1e6 * b:10.3f} | {b / a:5.3f} |", flush=True)


if __name__ == "__main__":
    main()
