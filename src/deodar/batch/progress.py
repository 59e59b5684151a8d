"""The progress of a run: a bar on a terminal, lines elsewhere."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Generator

SHOW_AFTER = 1.0
"""Seconds after which a run shows a progress bar, if it writes to a terminal."""

LINE_AFTER = 10.0
"""Seconds after which a run whose progress is requested prints it as a line, without a terminal."""

Shown = bool | Callable[[int], None] | None
"""Whether to show a progress bar (None: on a terminal, after a second), or a function that is called with the
number of completed steps.
"""


def lines(steps: int, now: Callable[[], float]) -> Callable[[int], None]:
    """Return a function that prints progress as lines, for files.

    The first line follows after LINE_AFTER, each next one after twice the time, so that a day makes about a
    dozen.
    """
    began = now()
    due = [began + LINE_AFTER]

    def shown(done: int) -> None:
        if (moment := now()) < due[0] or not done:
            return
        left = (moment - began) / done * (steps - done)
        sys.stderr.write(
            f"simulating: {done} of {steps} steps after {moment - began:.0f} s, about {left:.0f} s left\n"
        )
        sys.stderr.flush()
        due[0] = began + 2 * (moment - began)

    return shown


@contextlib.contextmanager
def bar(steps: int, progress: Shown) -> Generator[Callable[[int], None]]:
    """Show a progress bar once the run takes longer than SHOW_AFTER."""
    if callable(progress):
        yield progress
        return
    if progress is False or (progress is None and not sys.stderr.isatty()):
        yield lambda done: None
        return

    if not sys.stderr.isatty():
        yield lines(steps, time.monotonic)
        return

    # start-up time: only a terminal needs rich
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    began = time.monotonic()
    console = Console(stderr=True)
    columns = (
        TextColumn("simulating"),
        BarColumn(),
        TextColumn("{task.completed}/{task.total} steps"),
        TimeRemainingColumn(),
    )
    with contextlib.ExitStack() as stack:
        bar: list[Progress] = []

        def shown(done: int) -> None:
            if not bar and (progress or time.monotonic() - began > SHOW_AFTER):
                bar.append(stack.enter_context(Progress(*columns, console=console, transient=True)))
                bar[0].add_task("", total=steps)
            if bar:
                bar[0].update(bar[0].task_ids[0], completed=done)

        yield shown
