"""What a change of each parameter of table B.1 by 20 % does on the ring: which breaks first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from deodar.experiments.rows import Row
from deodar_papers._report import NOT_RUN
from deodar_papers.serial_order.parameters import PARAMETERS
from deodar_papers.serial_order.targets import RowsOfConditions

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURE = "serial-order-parameters"
"""Name of the picture in the manual."""

FIGURE = "table-B1-varied"
"""Name of the figure that `deodar reproduce` writes."""


@dataclass(frozen=True)
class VariedRuns:
    """Runs with one value of a parameter.

    Attributes:
        runs: number of runs.
        complete, wrong: number of runs that were complete, and of runs with a wrong order or block.
        action: median duration of an action, s; None if no action was completed.
    """

    runs: int
    complete: int
    wrong: int
    action: float | None


@dataclass(frozen=True)
class VariedParameter:
    """A parameter of table B.1, and its runs at -20 % and at +20 %; None where nothing was run."""

    name: str
    lower: VariedRuns | None
    higher: VariedRuns | None

    @property
    def both(self) -> list[VariedRuns]:
        """The runs of the changes that were run."""
        return [runs for runs in (self.lower, self.higher) if runs is not None]


def counted(rows: Sequence[Row]) -> VariedRuns | None:
    """Count the outcomes of runs; None without any."""
    if not rows:
        return None
    durations = [d for r in rows for d in r["actions"]]
    return VariedRuns(
        len(rows),
        sum(r["outcome"] == "complete" for r in rows),
        sum(r["outcome"] == "wrong" for r in rows),
        float(np.median(durations)) if durations else None,
    )


def ranked(by_condition: RowsOfConditions) -> list[VariedParameter]:
    """Return all parameters that were varied, first those that break first.

    A parameter is before another one if fewer runs of its worse change are complete; then, if fewer runs of
    both changes are; then, if the duration of an action departs more from that without a change.
    """
    base = unvaried(by_condition)
    every = [
        VariedParameter(
            name, *(counted(by_condition.get(f"vary/{name}/{sign}", [])) for sign in ("-20", "+20"))
        )
        for name in PARAMETERS
    ]

    def key(parameter: VariedParameter) -> tuple[float, float, float]:
        shares = [runs.complete / runs.runs for runs in parameter.both]
        times = [runs.action for runs in parameter.both]
        # no action at all departs most
        departs = [abs(math.log(t / base)) if t and base else math.inf if t is None else 0.0 for t in times]
        return min(shares), sum(shares) / len(shares), -max(departs)

    return sorted((p for p in every if p.both), key=key)


def unvaried(by_condition: RowsOfConditions) -> float | None:
    """Return the median duration of an action on the ring without a change, s."""
    runs = counted(by_condition["ring"])
    return None if runs is None else runs.action


def table(by_condition: RowsOfConditions) -> str:
    """Return one line for each parameter that was varied, and one for the ring without a change."""
    parameters = ranked(by_condition)
    if not parameters:
        return NOT_RUN
    lines = [
        "| parameter | -20 %: complete | wrong | action, s | +20 %: complete | wrong | action, s |",
        "|---|---|---|---|---|---|---|",
    ]
    for parameter in parameters:
        cells = [*_cells(parameter.lower), *_cells(parameter.higher)]
        lines.append(f"| {parameter.name} | {' | '.join(cells)} |")
    same = counted(by_condition["ring"])
    if same is not None:
        lines.append(f"| none | {' | '.join([*_cells(same), '', '', ''])} |")
    return "\n".join(lines) + "\n"


def _cells(runs: VariedRuns | None) -> tuple[str, str, str]:
    if runs is None:
        return NOT_RUN, "", ""
    action = "none" if runs.action is None else f"{runs.action:.1f}"
    return f"{runs.complete} of {runs.runs}", str(runs.wrong), action


def first(by_condition: RowsOfConditions) -> str:
    """Return in words which parameters have runs that were not complete, the first ones to break first."""
    parameters = ranked(by_condition)
    if not parameters:
        return NOT_RUN
    broken = [p for p in parameters if any(runs.complete < runs.runs for runs in p.both)]
    names = ", ".join(f"{p.name} ({' and '.join(_lost(p))})" if _lost(p) else p.name for p in broken)
    whole = f"{len(parameters) - len(broken)} of {len(parameters)}"
    if not broken:
        return f"All runs are complete with {whole} parameters."
    return f"Runs are not complete with {names}. All runs are complete with {whole} parameters."


def _lost(parameter: VariedParameter) -> list[str]:
    """Return the changes of a parameter with which runs were not complete, each with the complete ones."""
    return [
        f"{sign} %: {runs.complete} of {runs.runs}"
        for sign, runs in (("-20", parameter.lower), ("+20", parameter.higher))
        if runs is not None and runs.complete < runs.runs
    ]


def picture(by_condition: RowsOfConditions) -> str:
    """Return the picture of the manual as Markdown; nothing without runs."""
    words = "Complete runs and duration of an action with each parameter of table B.1 changed by 20 %"
    return f"![{words}](pictures/{PICTURE}.png)\n" if ranked(by_condition) else NOT_RUN


def draw(by_condition: RowsOfConditions) -> dict[str, Figure]:
    """Draw the figure, if there are runs."""
    # matplotlib is imported where something is drawn
    from deodar_papers.figures.variations import variations_figure

    parameters = ranked(by_condition)
    if not parameters:
        return {}
    return {FIGURE: variations_figure(parameters, unvaried(by_condition), "-20 %", "+20 %")}
