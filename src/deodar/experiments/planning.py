"""What an experiment needs on several workers, from one measured piece."""

from __future__ import annotations

import heapq
import math
import time
from dataclasses import dataclass

import psutil

from deodar import codec
from deodar.experiments.setup import Setup

START_SECONDS = 5.0
"""Wall time in which a worker starts and opens the model, in seconds (measured on one machine)."""

TASK_SECONDS = 0.005
"""Processor time that the caller and its scheduler need for a piece, in seconds (measured by
`benchmarks/cluster.py cost`, rounded up)."""


@dataclass(frozen=True)
class WorkPlan:
    """The pieces of an experiment and the time of one of them.

    Attributes:
        pieces: number of trials of each piece.
        seconds: wall time of a trial of the largest piece, if every trial lasted until the limit, in s.
        memory: memory of this process after a piece, in bytes, as a worker needs it.
        row: size of a row in the file of rows, in bytes.
        record: size of the records of a trial that lasts until the limit, in bytes, without compression.
    """

    pieces: tuple[int, ...]
    seconds: float
    memory: int
    row: int = 0
    record: int = 0

    @property
    def most(self) -> int:
        """Number of workers from which on another one does not help: each has one piece, or the caller is
        busy with the pieces that end.
        """
        served = max(self.pieces) * self.seconds / TASK_SECONDS
        return max(1, min(len(self.pieces), int(served)))

    @property
    def stored(self) -> int:
        """Size of all rows and records, in bytes."""
        return sum(self.pieces) * (self.row + self.record)

    def duration(self, workers: int) -> float:
        """Return the wall time on some workers in s: each takes the next piece when it has none.

        It is an upper bound, because trials may end before the limit.
        """
        free = [START_SECONDS] * max(1, min(workers, self.most))
        for trials in self.pieces:
            heapq.heapreplace(free, free[0] + trials * self.seconds)
        return max(*free, START_SECONDS + TASK_SECONDS * len(self.pieces))

    def counts(self) -> list[int]:
        """Return numbers of workers to compare: powers of two, and the largest useful one."""
        powers = [2**k for k in range(math.ceil(math.log2(max(2, self.most))) + 1)]
        return [n for n in powers if n < self.most] + [self.most]


def plan(setup: Setup, steps: int = 200) -> WorkPlan:
    """Run the beginning of the largest piece of an experiment in this process, and plan its pieces.

    Args:
        setup: the opened experiment.
        steps: steps of the beginning; doubled until they take 0.2 s.
    """
    pieces = setup.pieces()
    largest = max(pieces, key=len)
    setup.shortened(1).rows(largest)  # compiles
    n = min(steps, setup.steps)
    while True:
        part = setup.shortened(n)
        began = time.perf_counter()
        rows = part.rows(largest)
        wall = time.perf_counter() - began
        if wall >= 0.2 or n >= setup.steps:
            break
        n = min(2 * n, setup.steps)
    seconds = wall * setup.steps / part.steps / len(largest)
    row = max(len(codec.line(row, ascii=True)) + 1 for row in rows)
    memory = psutil.Process().memory_info().rss
    return WorkPlan(tuple(map(len, pieces)), seconds, memory, row, int(setup.record_bytes))
