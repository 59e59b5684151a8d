"""Sandamirskaya (2014), section 3: an event camera learns where to turn to have a target in its centre.

Parameters were found with separate prototypes and then on seeds 1 to 3; the seeds of these runs were run
once, with these parameters.

Reference:
    Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures,
    Front. Neurosci. 7:276, section 3.
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

HELP = "Sandamirskaya (2014): an event camera learns where to turn, from random gazes"

BY_CONDITION = ("conditions",)
"""Entries of `about` that map names of conditions to their settings."""

PICTURES = {"looking": "looking"}
"""The picture of the manual, and the figure that it shows."""

__getattr__ = papers.files(__name__)


def about(quick: bool) -> JsonObject:
    """Return the settings of the design; rows with other settings are not mixed with these."""
    # start-up time: these bring JAX
    from deodar_papers.looking import conditions

    return {
        "paper": "looking",
        "quick": quick,
        "tests": conditions.TESTS,
        "conditions": {
            name: {"mechanism": c.mechanism, "settings": dict(c.settings), "seeds": list(c.seeds)}
            for name, c in conditions.tested(quick).items()
        },
    }


def jobs(quick: bool) -> Sequence[Job]:
    """Return one job for each seed of each condition; with `quick` three seeds, and fewer gazes."""
    # start-up time: these bring JAX
    from deodar_papers.looking import trials

    return trials.jobs(quick)


def kept(row: Row) -> Row:
    """Return the row as the repository stores it: unchanged."""
    return row


def report(rows: Mapping[str, Row], quick: bool) -> Report:
    """Return the claims, the table of the learning curves, and the figures of the runs."""
    # start-up time: these bring JAX
    from deodar_papers._report import Report
    from deodar_papers.looking import figures, targets

    return Report(
        targets.claims(rows, quick),
        figures.figures(rows, quick),
        {"curves": targets.table(rows, quick)},
        targets.numbers(rows, quick),
    )
