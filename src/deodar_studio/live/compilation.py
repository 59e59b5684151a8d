"""How far a compilation is, and how long it will take."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Literal

from deodar.model.document import Document

ALIKE = 2.0
"""Largest ratio of the sizes of two documents whose programs are assumed to take equally long."""

MOST_SIZES = 64

CompilePhase = Literal["planning", "compiling"]


class Compilation:
    """A compilation in progress.

    Attributes:
        phase: `planning` covers resolving, planning and tracing; `compiling` is the work of XLA, or reading
            the program from the cache.
        expected: seconds that the last program of this size took; None: not known.
    """

    def __init__(self, expected: float | None) -> None:
        self.phase: CompilePhase = "planning"
        self.expected = expected
        self._began = time.monotonic()

    @property
    def elapsed(self) -> float:
        """Return the wall time since the beginning, in seconds."""
        return time.monotonic() - self._began


class CompileTimes:
    """Seconds that programs took to compile, by the size of their documents.

    Attributes:
        known: the last time for each size: the number of elements and connections.
    """

    def __init__(self, known: Mapping[int, float] | None = None) -> None:
        self.known = dict(known or {})

    def start(self, document: Document) -> Compilation:
        """Begin a compilation."""
        size = _size(document)
        closest = min(self.known, key=lambda past_size: _distance(size, past_size), default=None)
        alike = closest is not None and _distance(size, closest) <= math.log(ALIKE)
        return Compilation(self.known[closest] if closest is not None and alike else None)

    def took(self, document: Document, seconds: float) -> None:
        """Store the time of a program that was not in the cache."""
        self.known.pop(_size(document), None)
        self.known[_size(document)] = round(seconds, 2)
        while len(self.known) > MOST_SIZES:
            self.known.pop(next(iter(self.known)))


def _size(document: Document) -> int:
    return 1 + len(document.entries) + len(document.connections)


def _distance(size: int, past_size: int) -> float:
    return abs(math.log(size / past_size))
