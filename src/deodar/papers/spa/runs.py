"""The rows of the experiment, by condition, with those that count."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from deodar.experiments.rows import Row
from deodar.papers.spa import cases

SOURCE = "Billing, Lowe & Sandamirskaya (2015)"
LONG = 12.0
"""Reference paths that are not longer, in cm, are left out of Lp / Lo: the radius of the goal takes most of
them.
"""

METHODS = (("planner", "low"), ("planner", "high"), ("carrot", "none"), ("carrot", "low"), ("carrot", "high"))
"""The five conditions of cases 1 and 2, in the order of figures 7 and 8."""


class Runs:
    """What was run so far.

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
        """All rows of a condition, by the number of the trial."""
        return self._by[condition]

    def complete(self, condition: str) -> bool:
        """Whether all its runs are there."""
        return len(self.of(condition)) == len(cases.conditions(self.quick)[condition].trials)

    def kept(self, obstacle: str, noise: str) -> list[Row]:
        """Runs of case 3 but those whose obstacle came down on the robot."""
        return [r for r in self.of(f"{obstacle}/planner/{noise}") if not r["on_robot"]]

    def left_out(self, obstacle: str, noise: str) -> int:
        """How many runs those are."""
        rows = self.of(f"{obstacle}/planner/{noise}")
        return len(rows) - len(self.kept(obstacle, noise))

    def divergences(self, condition: str) -> np.ndarray:
        """Lp / Lo of the runs that reached the goal and whose reference path is long enough."""
        return np.asarray([r["divergence"] for r in self._long(condition)])

    def both(self, first: str, second: str) -> tuple[np.ndarray, np.ndarray]:
        """Lp / Lo of two conditions, of the pairs of start and goal that have one in both."""
        found = [{r["trial"]: r["divergence"] for r in self._long(name)} for name in (first, second)]
        trials = [k for k in found[0] if k in found[1]]
        return np.asarray([found[0][k] for k in trials]), np.asarray([found[1][k] for k in trials])

    def like(self, condition: str, other: str) -> list[Row]:
        """The rows of a condition whose trials the other one has too."""
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
    """Rows whose obstacle came between two times, ends included, and lasted so long; and whose other entries
    are as given.
    """
    inside = [
        r for r in rows if onset[0] <= r["onset"] <= onset[1] and duration[0] <= r["duration"] <= duration[1]
    ]
    return [r for r in inside if all(r[k] == v for k, v in equal.items())]


def count(rows: Sequence[Row], true: Callable[[Row], bool]) -> tuple[int, int]:
    """Of how many rows something is true, and how many there are."""
    return sum(true(r) for r in rows), len(rows)


def numbers(rows: Sequence[Row], name: str) -> np.ndarray:
    """An entry of those rows that have it."""
    return np.asarray([r[name] for r in rows if r.get(name) is not None], float)
