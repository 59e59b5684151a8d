"""The table of the experiment: one line for each condition."""

from __future__ import annotations

import numpy as np

from deodar.analysis.statistics import wilson
from deodar.papers.spa import cases
from deodar.papers.spa.route import NONE, NORTH, SOUTH, SWITCH
from deodar.papers.spa.runs import Runs, count, numbers

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


def write(runs: Runs) -> dict[str, str]:
    """Markdown by file name."""
    lines = [f"| {' | '.join(HEAD)} |", f"|{'---|' * len(HEAD)}"]
    for c in cases.conditions(runs.quick).values():
        rows = runs.of(c.name)
        if not rows:
            continue
        drawn = c.obstacle in cases.DRAW
        kept = runs.kept(c.obstacle, c.noise) if drawn else rows
        hits, n = count(kept, lambda r: r["success"])
        interval, ratio, arrival = wilson(hits, n), runs.divergences(c.name) if c.many_starts else np.zeros(0), numbers(kept, "arrival")
        routes = [str(sum(r.get("route") == way for r in kept)) if not c.many_starts else "" for way in (NORTH, SOUTH, SWITCH, NONE)]
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
        lines.append(f"| {' | '.join(cells)} |")
    return {"conditions": "\n".join(lines) + "\n"}
