"""The question before runs of 10^9 steps and more: state the expected time, and ask whether to begin."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable

from deodar.errors import TimeError

TRIAL_SECONDS = 0.5
"""Wall time of the trial run by which the speed is measured, in seconds."""

MOST_TRIED = 1_000_000
"""Steps that a trial run takes at most."""


def add_yes(parser: argparse.ArgumentParser) -> None:
    """`--yes`."""
    parser.add_argument("--yes", action="store_true", help="begin runs of 1e9 steps and more without asking")


def confirm(
    args: argparse.Namespace, command: str, steps: int, what: str, seconds: Callable[[], float]
) -> None:
    """State how long a run takes, and ask whether to begin; a run of fewer than 10^9 steps begins without a
    question.

    Args:
        args: of the command; `yes` answers the question.
        command: its name.
        steps: steps of the run in total.
        what: the run in words, the subject of a sentence.
        seconds: measures how long it takes.

    Raises:
        TimeError: the answer is no, or nobody can be asked.
    """
    # start-up time: these bring JAX
    from deodar.batch.simulate import LONG_STEPS

    if steps < LONG_STEPS:
        return
    says = f"{what} take about {duration(seconds())} on this machine"
    fix = "Take a larger dt, a shorter time or fewer trials; --yes begins without asking"
    print(f"deodar {command}: {says}", file=sys.stderr)
    if args.yes:
        return
    if not sys.stdin.isatty() or not sys.stderr.isatty():
        raise TimeError(f"{says}, and nobody can be asked whether that is meant", fix=fix)
    print("Begin? [y/N] ", end="", file=sys.stderr, flush=True)
    if sys.stdin.readline().strip().lower() not in ("y", "yes"):
        raise TimeError("not begun", fix=fix)


def seconds_a_step(run: Callable[[int], object]) -> float:
    """Wall time of a step, from runs of more and more steps; what a run takes without steps is taken off."""

    def taken(n: int) -> float:
        began = time.perf_counter()
        run(n)
        return time.perf_counter() - began

    taken(1)  # compiles
    none, n = taken(1), 100
    while (wall := taken(n) - none) < TRIAL_SECONDS and n < MOST_TRIED:
        n *= 10
    return max(wall, 1e-9) / n


def duration(seconds: float) -> str:
    """A wall time in words: 40 seconds, 3.2 hours, 12 days."""
    for unit, length in (("years", 365 * 86400), ("days", 86400), ("hours", 3600), ("minutes", 60)):
        if seconds >= length:
            return (
                f"{seconds / length:.2g} {unit}"
                if seconds < 100 * length
                else f"{seconds / length:,.0f} {unit}"
            )
    return f"{seconds:.0f} seconds"
