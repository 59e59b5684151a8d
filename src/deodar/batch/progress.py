"""The progress of a run: a bar on a terminal, lines elsewhere."""

from __future__ import annotations

import contextlib
import shutil
import sys
import time
from collections.abc import Callable, Generator

SHOW_AFTER = 1.0
"""Seconds after which a run shows a progress bar, if it writes to a terminal."""

BAR_CELLS = 30
"""Cells of a full progress bar."""

REDRAW_AFTER = 0.1
"""Seconds between two progress bars."""

LINE_AFTER = 10.0
"""Seconds after which a run whose progress is requested prints it as a line, without a terminal."""

Shown = bool | Callable[[int], object] | None
"""Whether to show a progress bar (None: on a terminal, after a second), or a function that is called with the
number of completed steps.
"""


def lines(steps: int, clock: Callable[[], float]) -> Callable[[int], None]:
    """Return a function that prints progress as lines, for files.

    The first line follows after LINE_AFTER, each next one after twice the time, so that a day makes about a
    dozen.
    """
    began = clock()
    due = [began + LINE_AFTER]

    def shown(done: int) -> None:
        if (moment := clock()) < due[0] or not done:
            return
        seconds_left = (moment - began) / done * (steps - done)
        sys.stderr.write(
            f"simulating: {done} of {steps} steps after {moment - began:.0f} s,"
            f" about {seconds_left:.0f} s left\n"
        )
        sys.stderr.flush()
        due[0] = began + 2 * (moment - began)

    return shown


def drawn(steps: int, clock: Callable[[], float], after: float) -> Callable[[int], None]:
    """Return a function that draws progress in the last line of a terminal, after a number of seconds."""
    began = clock()
    due = [began + after]

    def shown(done: int) -> None:
        if (moment := clock()) < due[0]:
            return
        whole = round(BAR_CELLS * done / steps) if steps else 0
        bar = "#" * whole + "." * (BAR_CELLS - whole)
        time_left = f", about {(moment - began) / done * (steps - done):.0f} s left" if done else ""
        _replace_line(f"simulating [{bar}] {done}/{steps} steps{time_left}")
        due[0] = moment + REDRAW_AFTER

    return shown


def _replace_line(text: str) -> None:
    """Write over the last line of a terminal, whose cursor stays at the line's beginning."""
    width = shutil.get_terminal_size().columns - 1  # a full line would begin the next one
    sys.stderr.write(f"\r{text[:width]:{width}}\r")
    sys.stderr.flush()


@contextlib.contextmanager
def bar(steps: int, progress: Shown) -> Generator[Callable[[int], object]]:
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
    try:
        yield drawn(steps, time.monotonic, 0.0 if progress else SHOW_AFTER)
    finally:
        _replace_line("")
