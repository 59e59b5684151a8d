"""The workers of a long computation and what they do, for who watches it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Staffing:
    """The workers at one moment.

    Attributes:
        workers: number of workers now.
        running: number of pieces that were given to them and have not returned.
    """

    workers: int
    running: int


WorkerWatch = Callable[[Staffing], bool]
"""A function that is called several times a second while workers run or are awaited; once it returns true,
the computation ends at once.
"""
