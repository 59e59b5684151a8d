"""Lomp et al. (2016), section 5: an arm points at the object that a colour and a side name.

Most parameters were found with a separate prototype on other scenes and another camera, those of the
approach and of the condition of satisfaction on scenes for tuning. A first set, whose arm lost a target that
moved, was run on other test scenes; these test scenes were run once, with these parameters.

Reference:
    Lomp, Richter, Zibner & Schöner (2016), Developing dynamic field theory architectures for embodied
    cognitive systems with cedar, Front. Neurorobot. 10:14.
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

HELP = "Lomp et al. (2016): an arm points at the object that a colour and a side name (extra robots)"

BY_CONDITION = ("conditions",)
"""Entries of `about` that map names of conditions to their settings."""

PICTURES: dict[str, str] = {}
"""No picture of the manual is drawn from stored rows."""

__getattr__ = papers.files(__name__)


def about(quick: bool) -> JsonObject:
    """Return the settings of the design; rows with other settings are not mixed with these."""
    # start-up time: these bring JAX
    from deodar_papers.pointing import scenes, table, trials

    counts: dict[str, int] = {}
    for job in trials.jobs(quick):
        name = job.keys[0].split("/")[0]
        counts[name] = counts.get(name, 0) + 1
    return {
        "paper": "pointing",
        "quick": quick,
        "seeds": {"scene": scenes.TEST, "beyond": scenes.BAND},
        "noise": {"pixels": table.PIXEL_NOISE, "tool": table.TOOL_NOISE},
        "conditions": {name: {"trials": count} for name, count in counts.items()},
    }


def jobs(quick: bool) -> Sequence[Job]:
    """Return one job for each scene, photograph, changed parameter and special case.

    With `quick` there are 20 scenes, 10 of each case, and no changed parameters.
    """
    # start-up time: these bring JAX
    from deodar_papers.pointing import trials

    return trials.jobs(quick)


def kept(row: Row) -> Row:
    """Return the row as the repository stores it: unchanged."""
    return row


def report(rows: Mapping[str, Row], quick: bool) -> Report:
    """Return the claims, and tables of them and of the sensitivity."""
    # start-up time: these bring JAX
    from deodar_papers._report import Report
    from deodar_papers.pointing import targets

    claims = targets.claims(rows, quick)
    numbers = targets.numbers(claims, rows)
    tables = {name: numbers[name] for name in ("claims", "sensitivity")}
    return Report(claims, tables=tables, numbers=numbers)
