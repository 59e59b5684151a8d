"""Influence of settings that the paper does not state: contact, the factor on the position input at high
noise, and the reflection of infrared light by walls.

These claims are not sentences of the paper. Each states that a setting has no influence, and fails if it has
one.
"""

from __future__ import annotations

from deodar.analysis.claims import Claim
from deodar.analysis.statistics import mean_interval
from deodar_papers.spa import cases
from deodar_papers.spa.condition_runs import Runs, count
from deodar_papers.spa.sentence import ALIKE, Sentence
from deodar_papers.spa.targets import MAZE


def claims(runs: Runs) -> list[Claim]:
    """Return two claims for each condition that differs from the planner in one setting: success, and Lp / Lo
    pair by pair.
    """
    return [
        claim
        for c in cases.conditions(runs.quick).values()
        if c.method == "planner" and c.terms
        for claim in _unchanged(runs, c)
    ]


def _unchanged(runs: Runs, varied: cases.Condition) -> list[Claim]:
    base = f"{varied.maze}/planner/{varied.noise}"
    [(name, value)] = varied.terms.items()
    setting = {
        "contact": "contact sticks",
        "factor": f"the factor on the place input is {value}",
        "reflection": f"walls reflect {value}",
    }[name]
    where = f"{MAZE[varied.maze]}, {varied.noise} noise"
    hits = [
        count(rows, lambda r: r["success"]) for rows in (runs.of(varied.name), runs.like(base, varied.name))
    ]
    text = f"{where}: where {setting}, the planner succeeds as often: difference to its own setting"
    out = [Sentence("", text).as_often(hits[0], hits[1])]
    before, after = runs.both(base, varied.name)
    shift = float((after - before).mean()) if len(before) else None
    text = (
        f"{where}: where {setting}, paths are as long: mean difference of Lp / Lo to its own setting, pair by"
        " pair"
    )
    out.append(Sentence("", text).equal(shift, mean_interval(after - before), len(before), -ALIKE, ALIKE))
    return out
