"""Tables of the runs: conditions, times between instabilities, sentences of the paper, varied parameters."""

from __future__ import annotations

import numpy as np

from deodar.papers._report import NOT_RUN
from deodar.papers.serial_order import robustness, sentences
from deodar.papers.serial_order.targets import RowsOfConditions, in_order

INSTABILITIES = (
    "satisfaction on",
    "action off",
    "peak in colour space off",
    "satisfaction off",
    "next node on",
    "next action on",
)


def write(found: RowsOfConditions) -> dict[str, str]:
    """Return tables in Markdown by file name."""
    return {
        "conditions": conditions(found),
        "transitions": transitions(found),
        "parameters": robustness.table(found),
        "sentences": sentences.table(sentences.claims(found)),
    }


def numbers(found: RowsOfConditions) -> dict[str, str]:
    """Return the results that the manual states, by name."""
    out = write(found)
    for name in ("learning", "clutter"):
        rows = found[name]
        out[f"learned:{name}"] = f"{sum(r['right'] for r in rows)} of {len(rows)}" if rows else NOT_RUN
    for name, rows in found.items():
        if "/" in name or name in ("learning", "clutter"):
            continue
        for outcome in ("complete", "wrong", "unfinished"):
            hits = sum(r["outcome"] == outcome for r in rows)
            out[f"{outcome}:{name}"] = f"{hits} of {len(rows)}" if rows else NOT_RUN
    durations = [d for r in found["arena"] for d in r["actions"]]
    for what, function in (("shortest", min), ("median", np.median), ("longest", max)):
        out[what] = f"{float(function(durations)):.2f}" if durations else NOT_RUN
    out["parameters-picture"] = robustness.picture(found)
    out["parameters-first"] = robustness.first(found)
    return out


def conditions(found: RowsOfConditions) -> str:
    """Return one line for each condition in which something is produced."""
    lines = [
        "| condition | runs | complete | unfinished | wrong | median time, s | longest, s | touching |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name, rows in found.items():
        if name.startswith("vary/") or name in ("learning", "clutter") or not rows:
            continue
        counts = [sum(r["outcome"] == o for r in rows) for o in ("complete", "unfinished", "wrong")]
        times = [r["found"][-1] for r in rows if r["outcome"] == "complete"]
        times_shown = [f"{np.median(times):.1f}", f"{max(times):.1f}"] if times else ["", ""]
        touching = f"{np.mean([r['touching'] for r in rows]):.3f}"
        cells = [name, str(len(rows)), *map(str, counts), *times_shown, touching]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def transitions(found: RowsOfConditions) -> str:
    """Return the times of the instabilities of all transitions in arenas, from the ordinal node's off on."""
    every = [t for r in found["arena"] for t in r["transitions"]]
    lines = ["| instability | median, ms | earliest | latest | transitions |", "|---|---|---|---|---|"]
    for k, name in enumerate(INSTABILITIES):
        times = [t[k] for t in every if t[k] is not None]
        if times:
            cells = [
                name,
                f"{np.median(times):.0f}",
                f"{min(times):.0f}",
                f"{max(times):.0f}",
                str(len(times)),
            ]
            lines.append(f"| {' | '.join(cells)} |")
    right = [step for r in found["arena"] for step in in_order(r)]
    lines.append(f"| in the order of section 4.4 | {sum(right)} of {len(right)} | | | |")
    return "\n".join(lines) + "\n"
