"""The conditions: the mechanism of learning, what it lacks, and after how many gazes the map is tested.

A row is one test of one seed. The name of its condition is that of the run and the number of gazes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

SEEDS = range(11, 21)
"""Seeds of the correcting mechanism; its parameters were found with seeds 1 to 3, and these were run once."""

OWN = range(21, 31)
"""Seeds of the paper's mechanism. Seeds 11 to 20 gave 0.513 within 12 pixels after 3000 gazes with other
parameters. Those of now were found with seeds 1 to 8 after that, and these were run once.
"""

HALF, FEW = OWN[:5], 2
"""Seeds of the controls, and their number in the quick form."""

TESTS = 150
"""Single gazes that test a map."""

CHANGED = (0.8, 1.0, 1.2)
"""Factors of the gain of the camera, after a map was learned; 1 is the control."""

AFTER = (500,)
"""Gazes after the change, after which the map is tested; it is tested at once too."""


@dataclass(frozen=True)
class LearningRun:
    """A run of each seed.

    Attributes:
        mechanism: mechanism of learning.
        marks: numbers of gazes after which the map is tested.
        seeds: the seeds.
        settings: further arguments of the architecture.
        changes: whether the gain of the camera is changed afterwards.
    """

    mechanism: str
    marks: tuple[int, ...]
    seeds: Sequence[int] = SEEDS
    settings: Mapping[str, Any] = field(default_factory=dict[str, Any])
    changes: bool = False

    @property
    def last(self) -> int:
        """Number of gazes of a run."""
        return self.marks[-1]


def tested(quick: bool) -> dict[str, LearningRun]:
    """Return the names of the conditions of all rows, each with the run that it belongs to."""
    found: dict[str, LearningRun] = {}
    for name, condition in conditions(quick).items():
        found |= {after(name, mark): condition for mark in condition.marks}
        if condition.changes:
            found |= {after(name, mark, gain): condition for gain in CHANGED for mark in (0, *AFTER)}
    return found


def after(name: str, gazes: int, gain: float | None = None) -> str:
    """Return the name of the condition of a test.

    Args:
        name: name of the run.
        gazes: number of gazes, of the run or since the change of the gain.
        gain: factor of the gain; None: it was not changed.
    """
    return f"{name}/{gazes} gazes" if gain is None else f"{name}, gain x{gain:g}/{gazes} gazes"


def conditions(quick: bool) -> dict[str, LearningRun]:
    """Return the runs by name."""
    if quick:
        return {
            "correcting": LearningRun("correcting", (500, 1000, 1500), SEEDS[:FEW]),
            "paper": LearningRun("paper", (500, 1500), OWN[:FEW]),
            "no reward": LearningRun("paper", (1000,), OWN[:FEW], {"reward": False}),
        }
    return {
        "correcting": LearningRun("correcting", (250, 500, 1000, 1500), changes=True),
        "paper": LearningRun("paper", (500, 1000, 2000, 3000), OWN),
        "no reward": LearningRun("paper", (1000, 3000), HALF, {"reward": False}),
        "no memory": LearningRun("paper", (1000, 3000), HALF, {"memory": False}),
    }
