"""Rows of the experiment by condition, and the rows that claims use."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from deodar.experiments.rows import Row
from deodar_papers.spa import cases

SOURCE = "Billing, Lowe & Sandamirskaya (2015)"
LONG = 12.0
"""Reference paths up to this length, in cm, are excluded from Lp / Lo: the radius of the goal is most of
them.
"""

METHODS = (("planner", "low"), ("planner", "high"), ("carrot", "none"), ("carrot", "low"), ("carrot", "high"))
"""Conditions of cases 1 and 2, in the order of figures 7 and 8."""


class Runs:
    """The completed runs.

    Args:
        rows: all rows by their keys.
        quick: whether the design is the short one.
    """

    def __init__(self, rows: Mapping[str, Row], quick: bool) -> None:
        self.quick = quick
        self._by: dict[str, list[Row]] = {name: [] for name in cases.conditions(quick)}
        for row in rows.values():
            self._by[row["condition"]].append(row)
        for found in self._by.values():
            found.sort(key=lambda row: row["trial"])

    def of(self, condition: str) -> list[Row]:
        """Return all rows of a condition, by the number of the trial."""
        return self._by[condition]

    def complete(self, condition: str) -> bool:
        """Return whether all its runs are complete."""
        return len(self.of(condition)) == len(cases.conditions(self.quick)[condition].trials)

    def kept(self, obstacle: str, noise: str) -> list[Row]:
        """Return the runs of case 3 except those whose obstacle appeared on the robot."""
        return [r for r in self.of(f"{obstacle}/planner/{noise}") if not r["on_robot"]]

    def left_out(self, obstacle: str, noise: str) -> int:
        """Return the number of these excluded runs."""
        rows = self.of(f"{obstacle}/planner/{noise}")
        return len(rows) - len(self.kept(obstacle, noise))

    def divergences(self, condition: str) -> np.ndarray:
        """Return Lp / Lo of the runs that reached the goal and whose reference path is long enough."""
        return np.asarray([r["divergence"] for r in self._long(condition)])

    def both(self, first: str, second: str) -> tuple[np.ndarray, np.ndarray]:
        """Return Lp / Lo of two conditions, for the pairs of start and goal that have it in both."""
        found = [{r["trial"]: r["divergence"] for r in self._long(name)} for name in (first, second)]
        trials = [k for k in found[0] if k in found[1]]
        return np.asarray([found[0][k] for k in trials]), np.asarray([found[1][k] for k in trials])

    def like(self, condition: str, other: str) -> list[Row]:
        """Return the rows of a condition whose trials the other condition has too."""
        trials = {r["trial"] for r in self.of(other)}
        return [r for r in self.of(condition) if r["trial"] in trials]

    def _long(self, condition: str) -> list[Row]:
        return [
            r
            for r in self.of(condition)
            if r["success"] and r["divergence"] is not None and r["shortest"] > LONG
        ]


def between(
    rows: Sequence[Row],
    onset: tuple[float, float] = (-1, 1e9),
    duration: tuple[float, float] = (-1, 1e9),
    **equal: Any,
) -> list[Row]:
    """Return the rows whose obstacle has an onset and a duration in the given intervals, ends included, and
    whose other entries have the given values.
    """
    inside = [
        r for r in rows if onset[0] <= r["onset"] <= onset[1] and duration[0] <= r["duration"] <= duration[1]
    ]
    return [r for r in inside if all(r[k] == v for k, v in equal.items())]


def count(rows: Sequence[Row], true: Callable[[Row], bool]) -> tuple[int, int]:
    """Return the number of rows with a property, and the number of all rows."""
    return sum(true(r) for r in rows), len(rows)


def numbers(rows: Sequence[Row], name: str) -> np.ndarray:
    """Return an entry of the rows that have it."""
    return np.asarray([r[name] for r in rows if r.get(name) is not None], float)
