"""The progress of long work: a bar on a terminal and in a notebook, lines or nothing elsewhere."""

from __future__ import annotations

import contextlib
import shutil
import sys
import time
from collections.abc import Callable, Generator, Sequence
from typing import Any, Protocol, Self

SHOW_AFTER = 1.0
"""Seconds after which long work shows a progress bar, on a terminal or in a notebook."""

BAR_CELLS = 30
"""Cells of a full progress bar."""

REDRAW_AFTER = 0.1
"""Seconds between two progress bars."""

LINE_AFTER = 10.0
"""Seconds after which work whose progress is requested prints it as a line, without a terminal."""


class Progress(int):
    """What long work has done: a whole number with its total, which prints as a sentence.

    Attributes:
        of: the total; 0: it is not known.
        unit: what is counted, such as steps or trials; empty: only `stage` says how far the work is.
        task: what is done.
        stage: the part of it that is done now; empty: it has no parts.
        seconds_left: estimated remaining time in s; None: it is not known yet.
        share: share of the work that is done, 0 to 1.
        margin: of `tune` the lowest margin of the best candidate.
        new: of an experiment the rows that were stored since the last call; at the first call those that
            existed before.
    """

    of: int
    unit: str
    task: str
    stage: str
    seconds_left: float | None
    share: float
    margin: float | None
    new: Sequence[Any]

    def __new__(cls, done: int, of: int = 0, **attributes: Any) -> Self:
        number = super().__new__(cls, done)
        number.of, number.share = of, done / of if of else 0.0
        number.unit, number.task, number.stage = "", "", ""
        number.seconds_left, number.margin, number.new = None, None, ()
        vars(number).update(attributes)
        return number

    def __str__(self) -> str:
        count = f"{int(self)}{f' of {self.of}' if self.of else ''} {self.unit}" if self.unit else ""
        time_left = "" if self.seconds_left is None else f"about {lasting(self.seconds_left)} left"
        return ": ".join(filter(None, [self.task, ", ".join(filter(None, [self.stage, count, time_left]))]))


Shown = bool | Callable[[Progress], object] | None
"""None: a bar on a terminal and in a notebook, after a second. True: a bar at once, lines elsewhere. False:
nothing. Or a function that is called with a `Progress`, for example `print`.
"""


class Tell(Protocol):
    """The function that work calls."""

    def __call__(self, done: int = 0, of: int = 0, /, **attributes: Any) -> None:
        """Tell what is done, of which total, and other attributes of `Progress`."""
        ...


@contextlib.contextmanager
def telling(progress: Shown, task: str, unit: str = "") -> Generator[Tell]:
    """Show the progress of the work inside a block.

    Args:
        progress: how it is shown.
        task: what is done.
        unit: what is counted.
    """
    began, terminal = time.monotonic(), _terminal()
    show: Callable[[Progress], object] | None = progress if callable(progress) else None
    if show is None and terminal is not None and progress is not False:
        show = _drawn(terminal, 0.0 if progress else SHOW_AFTER)
    elif show is None and progress:
        show = lines(time.monotonic)

    def tell(done: int = 0, of: int = 0, /, **attributes: Any) -> None:
        if show is not None:
            seconds_left = (time.monotonic() - began) / done * (of - done) if 0 < done <= of else None
            show(
                Progress(done, of, **{"task": task, "unit": unit, "seconds_left": seconds_left, **attributes})
            )

    try:
        yield tell
    finally:
        if show is not None and not callable(progress):
            erase()


@contextlib.contextmanager
def bar(steps: int, progress: Shown) -> Generator[Callable[[int], None]]:
    """Show the progress of a simulation of a number of steps."""
    with telling(progress, "simulating", "steps") as tell:
        yield lambda done: tell(done, steps)


def _terminal() -> Any:
    """Return the stream of the terminal, or of the notebook; None: there is neither."""
    if type(sys.stdout).__module__.startswith("ipykernel"):
        return sys.stdout
    return sys.stderr if sys.stderr is not None and sys.stderr.isatty() else None


def lines(clock: Callable[[], float]) -> Callable[[Progress], None]:
    """Return a function that prints progress as lines, for files.

    The first line follows after LINE_AFTER, each next one after twice the time, so that a day makes about a
    dozen.
    """
    began = clock()
    due = [began + LINE_AFTER]

    def show(progress: Progress) -> None:
        if (moment := clock()) < due[0]:
            return
        sys.stderr.write(f"{progress} (after {moment - began:.0f} s)\n")
        due[0] = began + 2 * (moment - began)

    return show


def _drawn(terminal: Any, after: float) -> Callable[[Progress], None]:
    """Return a function that draws progress in the last line of a terminal, after a number of seconds."""
    due = [time.monotonic() + after]

    def show(progress: Progress) -> None:
        if (moment := time.monotonic()) < due[0]:
            return
        whole = round(BAR_CELLS * progress.share)
        cells = f"[{'#' * whole}{'.' * (BAR_CELLS - whole)}] " if progress.of else ""
        _replace_line(terminal, f"{cells}{progress}")
        due[0] = moment + REDRAW_AFTER

    return show


def erase() -> None:
    """Erase the drawn progress, so that a line can take its place; the next progress is drawn below."""
    if (terminal := _terminal()) is not None:
        _replace_line(terminal, "")


def lasting(seconds: float) -> str:
    """Return a duration in words: 40 s, 12 min, 3 h 5 min."""
    minutes = round(seconds / 60)
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def _replace_line(terminal: Any, text: str) -> None:
    """Write over the last line of a terminal, whose cursor stays at the line's beginning."""
    width = shutil.get_terminal_size().columns - 1  # a full line would begin the next one
    terminal.write(f"\r{text[:width]:{width}}\r")
    terminal.flush()
