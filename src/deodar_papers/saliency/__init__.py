"""Sandamirskaya (2014), figure 2: a colour cue selects an object in a photograph, and a motor variable turns
to it.

The parameters were tuned on three photographs; twelve others test them.

Reference:
    Sandamirskaya (2014), Dynamic neural fields as a step toward cognitive neuromorphic architectures,
    Front. Neurosci. 7:276, figure 2.
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

HELP = "Sandamirskaya (2014): a colour cue selects an object in a photograph"

BY_CONDITION = ("photographs",)
"""Entries of `about` that map names of conditions to their settings."""

PICTURES: dict[str, str] = {}
"""No picture of the manual is drawn from stored rows."""

__getattr__ = papers.files(__name__)


def about(quick: bool) -> JsonObject:
    """Return the settings of the design; rows with other settings are not mixed with these."""
    # start-up time: these bring JAX
    from deodar_papers.saliency import scenes, trials

    cues = {s.name: [[c.hue, c.expect] for c in s.cues] for s in trials.scenes(quick)}
    return {"paper": "saliency", "quick": quick, "duration": scenes.DURATION, "seed": 0, "photographs": cues}


def jobs(quick: bool) -> Sequence[Job]:
    """Return one job for each photograph: three with `quick`, otherwise fifteen."""
    # start-up time: these bring JAX
    from deodar_papers.saliency import trials

    return trials.jobs(quick)


def kept(row: Row) -> Row:
    """Return the row as the repository stores it: unchanged."""
    return row


def report(rows: Mapping[str, Row], quick: bool) -> Report:
    """Return claims and the overview of the photographs that were run."""
    # start-up time: these bring JAX
    from deodar_papers._report import Report
    from deodar_papers.figures.cues import overview
    from deodar_papers.saliency import targets, trials

    found = trials.found(rows, quick)
    shown = [f for f in found if f.outcomes]
    claims = [*(claim for f in found for claim in targets.claims(f)), *targets.totals(found)]
    return Report(claims, {"overview": overview(shown)} if shown else {})
