"""Table of the experiment, one line for each condition, and the numbers of the runs that the manual
states.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from deodar.analysis.statistics import wilson
from deodar.architectures.spa import NOISE
from deodar_papers._report import NOT_RUN
from deodar_papers.spa import cases
from deodar_papers.spa.condition_runs import METHODS, Runs, count
from deodar_papers.spa.condition_runs import numbers as entries
from deodar_papers.spa.route import NONE, NORTH, SOUTH, SWITCH
from deodar_papers.spa.targets import MAZE

HEAD = (
    "condition",
    "runs",
    "left out",
    "success",
    "95 % interval",
    "Lp / Lo mean",
    "Lp / Lo median",
    "arrival, median steps",
    "north",
    "south",
    "switch",
    "neither",
)
SHORT = 8
"""Columns of a table of conditions without an obstacle."""


def write(runs: Runs) -> dict[str, str]:
    """Return tables in Markdown by file name."""
    return {"conditions": _table(runs, cases.conditions(runs.quick), len(HEAD))}


def numbers(runs: Runs) -> dict[str, str]:
    """Return the results that the manual states, by name: `success:CONDITION`, `ratio:CONDITION`,
    `arrival:CONDITION`, and tables.
    """
    found = cases.conditions(runs.quick)
    out = {
        "runs": str(sum(len(runs.of(name)) for name in found)),
        "of": str(sum(len(c.trials) for c in found.values())),
    }
    for name, c in found.items():
        out |= _of_condition(runs, name, c.many_starts)
    for maze in MAZE:
        out[f"weak:{maze}"] = _weak(runs, maze)
    stuck, n = count(
        [r for m in MAZE for k in ("low", "high") for r in runs.of(f"{m}/planner/{k}")],
        lambda r: not r["success"],
    )
    out["factor"] = f"{NOISE['high'][2]:g}"
    out["reflection"] = f"{cases.world(found['large/planner/low']).physics.reflection:g}"
    out["stuck"] = f"{stuck} of {n}" if n else NOT_RUN
    out["main"] = _table(
        runs, [f"{maze}/{method}/{noise}" for maze in MAZE for method, noise in METHODS], SHORT
    )
    own = [f"{maze}/planner/{noise}" for maze in MAZE for noise in ("low", "high")]
    varied = [c.name for c in found.values() if c.name in own or (c.method == "planner" and c.terms)]
    out["settings"] = _table(
        runs,
        sorted(varied, key=lambda name: (not name.startswith("z"), name.rpartition("/")[2] == "high", name)),
        SHORT,
    )
    return out


def _of_condition(runs: Runs, name: str, many_starts: bool) -> dict[str, str]:
    rows, ratio = runs.of(name), runs.divergences(name)
    hits, n = count(rows, lambda r: r["success"])
    arrival = entries(rows, "arrival")
    return {
        f"success:{name}": f"{hits} of {n}" if n else NOT_RUN,
        f"ratio:{name}": f"{ratio.mean():.2f}" if many_starts and len(ratio) else NOT_RUN,
        f"arrival:{name}": f"{np.median(arrival):.0f}" if len(arrival) else NOT_RUN,
    }


def _weak(runs: Runs, maze: str) -> str:
    """Return the range of successes with a weak carrot over all noises."""
    counts = [
        count(runs.of(f"{maze}/weak-carrot/{k}"), lambda r: r["success"]) for k in ("none", "low", "high")
    ]
    hits = sorted(h for h, _ in counts)
    return f"{hits[0]} to {hits[-1]} of {counts[0][1]}" if all(n for _, n in counts) else NOT_RUN


def _table(runs: Runs, names: Iterable[str], columns: int) -> str:
    """Return one line for each of these conditions that has runs."""
    lines = [f"| {' | '.join(HEAD[:columns])} |", f"|{'---|' * columns}"]
    for c in (cases.conditions(runs.quick)[name] for name in names):
        rows = runs.of(c.name)
        if not rows:
            continue
        drawn = c.obstacle in cases.DRAW
        kept = runs.kept(c.obstacle, c.noise) if drawn else rows
        hits, n = count(kept, lambda r: r["success"])
        interval, ratio, arrival = (
            wilson(hits, n),
            runs.divergences(c.name) if c.many_starts else np.zeros(0),
            entries(kept, "arrival"),
        )
        routes = [
            str(sum(r.get("route") == way for r in kept)) if not c.many_starts else ""
            for way in (NORTH, SOUTH, SWITCH, NONE)
        ]
        cells = [
            c.name,
            str(n),
            str(len(rows) - n if drawn else len(c.left_out)),
            f"{hits / n:.1%}" if n else "",
            "" if interval is None else f"{interval[0]:.1%} to {interval[1]:.1%}",
            f"{ratio.mean():.3f}" if len(ratio) else "",
            f"{np.median(ratio):.3f}" if len(ratio) else "",
            f"{np.median(arrival):.0f}" if len(arrival) else "",
            *routes,
        ]
        lines.append(f"| {' | '.join(cells[:columns])} |")
    return "\n".join(lines) + "\n" if len(lines) > 2 else NOT_RUN
