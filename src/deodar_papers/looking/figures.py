"""The learning curves, and figures 7 and 8 of the paper, from the rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from deodar.experiments.rows import Row
from deodar_papers.figures.looking import Course, LearnedMap, LearningCurve, looking_figure
from deodar_papers.looking.conditions import conditions
from deodar_papers.looking.gazes import STEP
from deodar_papers.looking.narrative import Looked
from deodar_papers.looking.targets import of, shares
from deodar_papers.looking.trials import SHOWN_EVERY, course, projections

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAMES = {
    "correcting": "correcting",
    "paper": "paper",
    "no memory": "paper, no memory in learning",
    "no reward": "paper, no reward",
}


def figures(rows: Mapping[str, Row], quick: bool) -> dict[str, Figure]:
    """Draw what was run; nothing without a run of the correcting mechanism."""
    last = of(rows, "correcting", conditions(quick)["correcting"].last)
    if not last:
        return {}
    return {"looking": looking_figure(_curves(rows, quick), _course(last[0]), _map(last[0]))}


def of_demo(result: Looked) -> Figure:
    """Draw a run of the demonstration."""
    near = tuple(result.near)
    curve = LearningCurve(NAMES[result.mechanism], result.marks, near, tuple((s, s) for s in near))
    parts = {**course(result.learned), **projections(result.learned.maps[result.marks[-1]])}
    row: Row = {"gazes": result.marks[-1], **parts}
    return looking_figure([curve], _course(row), _map(row))


def _curves(rows: Mapping[str, Row], quick: bool) -> list[LearningCurve]:
    out: list[LearningCurve] = []
    for name, condition in conditions(quick).items():
        found = [(mark, shares(of(rows, name, mark))) for mark in condition.marks]
        there = [(mark, s) for mark, s in found if len(s)]
        if there:
            out.append(
                LearningCurve(
                    NAMES[name],
                    tuple(mark for mark, _ in there),
                    tuple(float(s.mean()) for _, s in there),
                    tuple((float(s.min()), float(s.max())) for _, s in there),
                )
            )
    return out


def _course(row: Row) -> tuple[Course, Course]:
    step = SHOWN_EVERY * STEP / 1000
    begin, end = (np.asarray(row["course"][name]) for name in ("begin", "end"))
    return Course("first gazes", step, begin), Course(f"after {row['gazes']} gazes", step, end)


def _map(row: Row) -> LearnedMap:
    kept = row["map"]
    return LearnedMap(np.asarray(kept["pan"]), np.asarray(kept["tilt"]), np.asarray(kept["shifts"]))
