"""Billing, Lowe & Sandamirskaya (2015): the three test cases, run again.

Cases 1 and 2: pairs of start and goal in two mazes, the planner with low and high noise, and following the
carrot without, with low and with high noise. Case 3: an obstacle comes and goes while the robot plans or
drives.

Reference:
    Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), 243-264,
    sections 4 and 5.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from deodar.codec import JsonObject
from deodar_papers import papers

if TYPE_CHECKING:
    from deodar.experiments.jobs import Job
    from deodar.experiments.rows import Row
    from deodar_papers._report import Report

HELP = "Billing, Lowe & Sandamirskaya (2015): a robot plans its way through two mazes while it drives"

BY_CONDITION = ("runs", "carrots", "planners")
"""Entries of `about` that map names of conditions to their settings."""

PICTURES = {
    "spa-success": "figure-7-success",
    "spa-divergence": "figure-8-divergence",
    "spa-routes": "figure-13-routes",
    "spa-choice": "figure-16-full",
}
"""Pictures of the manual, each with its figure."""

__getattr__ = papers.files(__name__)


def about(quick: bool) -> JsonObject:
    """Return the settings of the design; rows with other settings are not mixed with these."""
    # start-up time: these bring JAX
    from deodar_papers.spa import cases

    return {"paper": "spa", "quick": quick, **cases.design(quick)}


def jobs(quick: bool) -> Sequence[Job]:
    """Return all trials, the quick ones first."""
    # start-up time: these bring JAX
    from deodar_papers.spa import trials

    return trials.jobs(quick)


def kept(row: Row) -> Row:
    """Return a row as the repository stores it.

    Paths of the carrot are omitted: they are the larger part, and no code reads them.
    """
    return {k: v for k, v in row.items() if k != "path" or "planner" in row["condition"]}


def report(rows: Mapping[str, Row], quick: bool) -> Report:
    """Return claims, figures, tables and numbers of the stored trials."""
    # start-up time: these bring JAX
    from deodar_papers._report import Report
    from deodar_papers.spa import figures, sentences, tables, targets, unstated_settings
    from deodar_papers.spa.condition_runs import Runs

    runs = Runs(rows, quick)
    said = [*targets.claims(runs), *sentences.claims(runs), *unstated_settings.claims(runs)]
    return Report(said, figures.draw(runs), tables.write(runs), tables.numbers(runs))
