"""The progress bar of long computations, with the remaining time."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deodar.progress import Progress


class Bar:
    """A progress bar on stderr; `what` names the counted rows."""

    def __init__(self, hidden: bool, noun: str) -> None:
        # start-up time: only a terminal needs rich
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        columns = (
            TextColumn("{task.fields[done]}"),
            BarColumn(),
            TextColumn("{task.percentage:>3.0f} %"),
            TextColumn("{task.fields[left]}"),
        )
        self._bar = Progress(*columns, console=Console(file=sys.stderr), transient=True, disable=hidden)
        self._task = self._bar.add_task("", total=1.0, done="", left="")
        self._noun = noun

    def __enter__(self) -> Bar:
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.stop()

    def show(self, progress: Progress) -> None:
        """Draw the progress."""
        time_left = "" if progress.seconds_left is None else f"{lasting(progress.seconds_left)} left"
        self._bar.update(
            self._task,
            completed=progress.share,
            done=f"{int(progress)} of {progress.of} {self._noun}",
            left=time_left,
        )


def lasting(seconds: float) -> str:
    """Return a duration in words: 40 s, 12 min, 3 h 5 min."""
    minutes = round(seconds / 60)
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
