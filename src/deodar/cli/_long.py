"""The confirmation of runs of 10^9 steps and more, with the expected time."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable

from deodar.cli import _options, _question
from deodar.errors import TimeError

TRIAL_SECONDS = 0.5
"""Wall time of the trial run by which the speed is measured, in seconds."""

MOST_TRIED = 1_000_000
"""Most steps of a trial run."""


def add_yes(parser: _options.CommandParser) -> None:
    """Add `--yes`."""
    parser.flag("--yes", "begin runs of 1e9 steps and more without asking")


def confirm(
    args: argparse.Namespace, command: str, steps: int, what: str, seconds: Callable[[], float]
) -> None:
    """Print the expected time of a run and ask for confirmation; runs of fewer than 10^9 steps need none.

    Args:
        args: arguments of the command; `yes` answers the question.
        command: name of the command.
        steps: total number of steps of the run.
        what: the run in words, the subject of a sentence.
        seconds: measures the expected time.

    Raises:
        TimeError: if the answer is no, or without a terminal to ask on.
    """
    # start-up time: these bring JAX
    from deodar.batch.simulate import LONG_STEPS

    if steps < LONG_STEPS:
        return
    says = f"{what} take about {duration(seconds())} on this machine"
    fix = "Use a larger dt, a shorter time or fewer trials; --yes begins without asking"
    print(f"deodar {command}: {says}", file=sys.stderr)
    if args.yes:
        return
    if not _question.on_terminal():
        raise TimeError(f"{says}, and without a terminal deodar cannot ask for confirmation", fix=fix)
    if not _question.confirmed("Begin?"):
        raise TimeError("the run was not confirmed", fix=fix)


def confirm_run(args: argparse.Namespace, duration: float, dt: float, run: Callable[[float], object]) -> None:
    """Ask for confirmation of a long `deodar run`; `run` simulates a part of it to measure its speed."""
    # start-up time: these bring JAX
    from deodar.batch.simulate import expected_steps

    steps = expected_steps(duration, dt)
    size = f"{steps:.3g} steps of dt = {dt:g}"
    confirm(args, "run", steps, size, lambda: steps * seconds_a_step(lambda n: run(n * dt)))


def seconds_a_step(run: Callable[[int], object]) -> float:
    """Return the wall time of a step, from runs of increasing length, without the time of a run of no
    steps.
    """

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
    """Return a wall time in words: 40 seconds, 3.2 hours, 12 days."""
    for unit, length in (("years", 365 * 86400), ("days", 86400), ("hours", 3600), ("minutes", 60)):
        if seconds >= length:
            return (
                f"{seconds / length:.2g} {unit}"
                if seconds < 100 * length
                else f"{seconds / length:,.0f} {unit}"
            )
    return f"{seconds:.0f} seconds"
