"""Time the workloads of this checkout and of another one in alternation.

python benchmarks/against.py FOLDER [NAME ...]    FOLDER: a checkout of another commit, such as a git worktree

Both run in the Python that runs this command, each with its own `src`. Prints for each workload the time of a
step in both and their ratio. A time is the lower decile of many short calls: what else the machine does makes
calls longer, never shorter.
"""

from __future__ import annotations

import argparse
import contextlib
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
    parser.add_argument("--rounds", type=int, default=40, help="rounds of each workload (default 40)")
    given = parser.parse_args()
    steps.require_known(parser, given.names, known)
    if not (given.folder / "benchmarks" / "steps.py").exists():
        parser.error(f"{given.folder} is no checkout with benchmarks/steps.py")
    with server(given.folder.resolve()) as theirs, server(HERE.parent) as ours:
        print(f"| {'workload':12} | {'theirs, us':>10} | {'ours, us':>10} | ratio |")
        print(f"|{'-' * 14}|{'-' * 12}|{'-' * 12}|-------|")
        for name in given.names or known:
            both = [lambda n, name=name, ask=ask: ask(f"{name} {n}") for ask in (theirs, ours)]
            both[0](20)
            n = steps.count(both[1], SECONDS)
            a, b = compare(both[0], both[1], n, given.rounds)
            print(f"| {name:12} | {1e6 * a:10.3f} | {1e6 * b:10.3f} | {b / a:5.3f} |", flush=True)


if __name__ == "__main__":
    main()
