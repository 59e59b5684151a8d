"""The standing of an experiment, from its rows alone: also of one that another process runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from deodar import regular_file
from deodar.errors import RecordError, first_line
from deodar.experiments import row_line
from deodar.experiments.experiment_table import lacks, read_row
from deodar.experiments.observations import DIVERGED, TIME
from deodar.experiments.rows import ABOUT, KEY, Row

QUIET_SECONDS = 60.0
"""Wall time without a new row after which rows count as stopped where the lock of their writer is not seen,
in seconds.
"""

FOLLOW_SECONDS = 1.0
"""Wall time between two reads of rows that another process writes, in seconds."""

MOST_FAILING = 3
"""Most combinations of levels with diverged trials that are named in words."""


@dataclass(frozen=True)
class CellStanding:
    """The trials of one combination of levels that have ended.

    Attributes:
        levels: the label of each factor, by its name.
        rows: number of trials that have ended.
        duration: median duration of these trials, in document time; NaN: all of them diverged.
        failed: number of trials that diverged.
        cut: number of trials that the limit ended.
    """

    levels: Mapping[str, Any]
    rows: int
    duration: float
    failed: int
    cut: int

    @property
    def name(self) -> str:
        """The levels in words; `all trials` without factors."""
        return called(self.levels) or "all trials"


@dataclass(frozen=True)
class Standing:
    """The standing of an experiment.

    Attributes:
        rows: number of trials with a row.
        of: number of all trials.
        left: estimated remaining wall time in s; None before it can be estimated.
        cells: the combinations of levels with rows, the one with the longest median duration first.
    """

    rows: int
    of: int
    left: float | None
    cells: tuple[CellStanding, ...]

    @property
    def share(self) -> float:
        """Share of trials with a row, 0 to 1."""
        return self.rows / self.of if self.of else 1.0

    @property
    def failing(self) -> tuple[CellStanding, ...]:
        """The combinations in which trials diverged, the one with most of them first."""
        return tuple(sorted((c for c in self.cells if c.failed), key=lambda cell: -cell.failed / cell.rows))

    @property
    def slowest(self) -> str:
        """The combination of levels with the longest trials, in words; empty without rows."""
        return f"{self.cells[0].name}, median {self.cells[0].duration:g}" if self.cells else ""

    @property
    def diverged(self) -> tuple[str, ...]:
        """The first of `failing`, in words."""
        return tuple(f"{c.name}, {c.failed} of {c.rows}" for c in self.failing[:MOST_FAILING])


def called(levels: Mapping[str, Any]) -> str:
    """Return a combination of levels in words."""
    labels = ((name, f"{value:g}" if isinstance(value, float) else value) for name, value in levels.items())
    return ", ".join(f"{name} {value}" for name, value in labels)


def standing(
    rows: Sequence[Row], of: int, begun: tuple[float, int] | None = None, now: float = 0.0
) -> Standing:
    """Return the standing of an experiment.

    Args:
        rows: the rows that exist.
        of: number of all trials.
        begun: an earlier moment in s, and the number of rows at that moment, for the remaining time.
        now: the present moment in s.
    """
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        levels: Mapping[str, Any] = row["levels"]
        groups.setdefault(tuple(levels.items()), []).append(row)
    cells = [_cell(dict(levels), group) for levels, group in groups.items()]
    cells.sort(key=lambda cell: -cell.duration if math.isfinite(cell.duration) else math.inf)
    seconds_left = None
    if begun is not None and len(rows) > begun[1] and now > begun[0]:
        seconds_left = (of - len(rows)) * (now - begun[0]) / (len(rows) - begun[1])
    return Standing(len(rows), of, seconds_left, tuple(cells))


def _cell(levels: Mapping[str, Any], rows: Sequence[Row]) -> CellStanding:
    durations = [float(row["duration"]) for row in rows if row["duration"] is not None]
    failed = sum(DIVERGED in row for row in rows)
    cut = sum(row["outcome"] == TIME for row in rows)
    return CellStanding(levels, len(rows), median(durations) if durations else math.nan, failed, cut)


class RowsTail:
    """The rows that another process adds to a file; each is read once.

    Args:
        path: the file of rows.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._read = self._lines = 0
        self._checked = False
        self._lacking: Callable[[Any], str] | None = None
        self._keys: set[str] = set()

    def new(self) -> list[Row]:
        """Return the rows since the last call; an incomplete last line is left for the next one.

        Raises:
            RecordError: the file cannot be read, or a complete line is not a row; the line is named.
        """
        try:
            with regular_file.open_binary(self.path) as file:
                file.seek(self._read)
                content = file.read()
            whole = content.rfind(b"\n") + 1
            lines = content[:whole].splitlines()
            lacking, first = self._lacking, 0
            if lacking is None and lines:
                identity, self._checked = row_line.read_first(lines[0], ABOUT, self.path)
                lacking, first = lacks(identity), 1
        except (OSError, ValueError, LookupError, TypeError) as error:
            raise RecordError(
                f"its rows cannot be read ({first_line(error)})", where=str(self.path)
            ) from None
        rows_by_key: dict[str, Row] = {}
        for number, line in enumerate(lines[first:], self._lines + first + 1):
            assert lacking is not None
            row = read_row(line, number, str(self.path), lacking, self._checked)
            rows_by_key.setdefault(row[KEY], row)
        self._read, self._lines, self._lacking = self._read + whole, self._lines + len(lines), lacking
        new = [row for key, row in rows_by_key.items() if key not in self._keys]
        self._keys |= rows_by_key.keys()
        return new


class RowsWriter:
    """Whether a process still adds rows, by its lock or by the rows.

    A process that was seen to hold the lock of the folder runs the experiment as long as it holds it. The
    lock of a process on another machine may not be seen: then it runs as long as rows arrive.

    Args:
        since: moment from which the quiet is counted, before rows have arrived; -inf: there is no quiet
            before.
    """

    def __init__(self, since: float = -math.inf) -> None:
        self._locked, self._grown = False, since

    def runs(self, written: bool | None, grew: bool, now: float) -> bool:
        """Return whether the process runs.

        Args:
            written: whether a process holds the lock; None where this is unknown.
            grew: whether rows have arrived since the last call.
            now: the present moment, in seconds of a clock that only advances.
        """
        self._locked = self._locked or written is True
        self._grown = now if grew else self._grown
        return written is True or (not self._locked and now - self._grown < QUIET_SECONDS)
