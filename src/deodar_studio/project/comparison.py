"""The comparison of the open record with another one."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np

from deodar.errors import DeodarError, Problem
from deodar.recording.first_difference import FirstDifference, common_ports, first_differences
from deodar.recording.replay import RecordReader
from deodar_studio.messages.message import made_of
from deodar_studio.messages.to_page import Comparison, DifferenceView
from deodar_studio.views import view

NO_COMPARISON = Comparison(path="", progress=0.0, compared=0, differences=[], notes=[], problems=[])


class RecordComparison:
    """Another record beside the open one, and their first differences, which a thread looks for.

    Args:
        record: the open record.
        path: the other record.
        changed: called in that thread when there is news.

    Attributes:
        other: the other record.
        progress: the share that was compared.
        differences: the first difference of each port that differs, the earliest first.
        ports: the ports that both have.
        notes: sentences on what is not compared.
        problems: why the comparison failed.

    Raises:
        DeodarError: the other record cannot be opened, or has nothing in common with the open one.
    """

    def __init__(self, record: RecordReader, path: Path, changed: Callable[[], None]) -> None:
        self.record, self.other = record, RecordReader(path)
        self.progress = 0.0
        self.differences: list[FirstDifference] = []
        self.problems: tuple[Problem, ...] = ()
        self._changed, self._ended = changed, False
        self.ports = common_ports(record, self.other)
        self.notes = _notes(record, self.other, len(self.ports))
        threading.Thread(target=self._compare, name="deodar-compare", daemon=True).start()

    def end(self) -> None:
        """End the comparison."""
        self._ended = True

    def _compare(self) -> None:
        try:
            self.differences = first_differences(self.record, self.other, self._share)
        except DeodarError as error:
            self.problems = tuple(error.problems)
        self.progress = 1.0
        self._changed()

    def _share(self, share: float) -> bool:
        # the whole share is reported with the result
        if int(100 * share) > int(100 * self.progress) and share < 1:
            self.progress = share
            self._changed()
        return not self._ended


def shown(found: RecordComparison, path: str) -> Comparison:
    """Return a comparison as a message; `path` is the other record as the page names it."""
    return made_of(
        Comparison,
        found,
        path=path,
        compared=len(found.ports),
        differences=[_difference(found.record, d) for d in found.differences],
        problems=view.problems(found.problems),
    )


def _difference(reader: RecordReader, found: FirstDifference) -> DifferenceView:
    axes = reader.axes(found.place)
    at = ", ".join(
        f"{a.name} {a.points[i]:g} {a.unit}".rstrip() for a, i in zip(axes, found.index, strict=True)
    )
    value, other = (v if math.isfinite(v) else None for v in found.values)
    return made_of(DifferenceView, found, element=found.place[0], at=at, value=value, other=other)


def _notes(one: RecordReader, other: RecordReader, shared: int) -> list[str]:
    notes: list[str] = []
    alone = [len(list(record.ports)) - shared for record in (one, other)]
    if any(alone):
        notes.append(f"Not compared: {alone[0]} ports of the open record, {alone[1]} of the other.")
    if not np.array_equal(one.times, other.times):
        spans = " and ".join(f"{r.times[0]:g} to {r.times[-1]:g}" for r in (one, other) if len(r.times))
        unit = one.document.time_unit
        notes.append(f"The moments differ ({spans} {unit}); those that both have are compared.")
    return notes
