"""Tables of the runs: conditions, times between instabilities, sentences of the paper, varied parameters."""

from __future__ import annotations

import numpy as np

from deodar_papers._report import NOT_RUN
from deodar_papers.serial_order import robustness, sentences
from deodar_papers.serial_order.parameters import TABLE
from deodar_papers.serial_order.targets import AT_ONCE, RowsOfConditions, in_order, repeated, visits

INSTABILITIES = (
    "satisfaction on",
    "action off",
    "peak in colour space off",
    "satisfaction off",
    "next node on",
    "next action on",
)

OUTCOMES = {
    "duplicates": "three duplicates of wanted blocks",
    "removed": "a wanted block that is taken away for a minute while the robot looks for it",
    "carried": "a robot that is carried elsewhere while it looks for its second colour",
    "wander": "the paper's search, which drives straight until an obstacle turns the robot",
    "ten": "sequences of all ten hues",
    "cued": "two sequences of three to five colours, which differ at every position, taught one after"
    " another, and the cue of either",
    "cued-changed": "a cue that changes while the robot looks for its second or third colour, so that it"
    " continues with the colours of the other sequence from this position on",
}
"""What differs in the conditions of which the manual states how many runs are complete and wrong."""


def write(by_condition: RowsOfConditions) -> dict[str, str]:
    """Return tables in Markdown by file name."""
    return {
        "conditions": conditions(by_condition),
        "transitions": transitions(by_condition),
        "parameters": robustness.table(by_condition),
        "sentences-runs": sentences.runs_table(by_condition),
        "sentences-parameters": sentences.parameters_table(),
    }


def numbers(by_condition: RowsOfConditions) -> dict[str, str]:
    """Return the results that the manual states, by name."""
    out = write(by_condition)
    for name in ("learning", "clutter"):
        rows = by_condition[name]
        out[f"learned:{name}"] = f"{sum(r['right'] for r in rows)} of {len(rows)}" if rows else NOT_RUN
    for name, rows in by_condition.items():
        if "/" in name or name in ("learning", "clutter"):
            continue
        for outcome in ("complete", "wrong", "unfinished"):
            hits = sum(r["outcome"] == outcome for r in rows)
            out[f"{outcome}:{name}"] = f"{hits} of {len(rows)}" if rows else NOT_RUN
    durations = [d for r in by_condition["arena"] for d in r["actions"]]
    for statistic, function in (("shortest", min), ("median", np.median), ("longest", max)):
        out[statistic] = f"{float(function(durations)):.2f}" if durations else NOT_RUN
    out["outcomes"] = outcomes(by_condition)
    out["without-runs"] = without_runs(by_condition)
    out["reasons"] = reasons(by_condition)
    out["table-b1"] = changed()
    out["parameters-picture"] = robustness.picture(by_condition)
    out["parameters-first"] = robustness.first(by_condition)
    return out


def conditions(by_condition: RowsOfConditions) -> str:
    """Return one line for each condition in which something is produced."""
    lines = [
        "| condition | runs | complete | unfinished | wrong | median time, s | longest, s | touching |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name, rows in by_condition.items():
        if name.startswith("vary/") or name in ("learning", "clutter") or not rows:
            continue
        counts = [sum(r["outcome"] == o for r in rows) for o in ("complete", "unfinished", "wrong")]
        times = [r["found"][-1] for r in rows if r["outcome"] == "complete"]
        times_shown = [f"{np.median(times):.1f}", f"{max(times):.1f}"] if times else ["", ""]
        touching = f"{np.mean([r['touching'] for r in rows]):.3f}"
        cells = [name, str(len(rows)), *map(str, counts), *times_shown, touching]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def outcomes(by_condition: RowsOfConditions) -> str:
    """Return a list: each condition of `OUTCOMES` that has runs, and repeated colours."""
    lines: list[str] = []
    for name, words in OUTCOMES.items():
        rows = by_condition[name]
        complete, wrong = (sum(r["outcome"] == o for r in rows) for o in ("complete", "wrong"))
        if rows:
            lines.append(f"* With {words}: complete {complete} of {len(rows)}, wrong {wrong} of {len(rows)}.")
    checks = {
        "A repeated colour is found at once, within 1 s": [
            duration <= AT_ONCE for row in by_condition["repetition"] for duration in repeated(row)
        ],
        "With `habituation=True` it is found by a second visit, after it left the middle of the picture": [
            left for row in by_condition["habituation"] for left in visits(row)
        ],
    }
    lines += [f"* {words}: {sum(true)} of {len(true)}." for words, true in checks.items() if true]
    return "\n".join(lines) + "\n" if lines else NOT_RUN


def reasons(by_condition: RowsOfConditions) -> str:
    """Return why productions were not completed, with their numbers."""
    counted: dict[tuple[str, str], int] = {}
    for name, rows in by_condition.items():
        for row in rows if not name.startswith("vary/") else ():
            if "reason" in row:
                # the colour and the item are those of the run
                why = row["reason"].partition(" for ")[0].partition(" (item")[0]
                why += ", on a path of less than 1 m" if row["length"] < 1000.0 else ""
                counted[name, why] = counted.get((name, why), 0) + 1
    if not counted:
        return NOT_RUN
    lines = ["| condition | reason | runs |", "|---|---|---|"]
    lines += [f"| {name} | {why} | {number} |" for (name, why), number in counted.items()]
    return "\n".join(lines) + "\n"


def without_runs(by_condition: RowsOfConditions) -> str:
    """Return the names of the conditions without runs; varied parameters are counted."""
    missing = [name for name, rows in by_condition.items() if not rows]
    varied = sum(name.startswith("vary/") for name in missing)
    names = [f"`{name}`" for name in missing if not name.startswith("vary/")]
    parts = [*names, f"{varied} conditions with a varied parameter"] if varied else names
    return ", ".join(parts) or "none"


def changed() -> str:
    """Return the parameters of table B.1 whose value differs from the printed one, each with the reason."""
    lines = ["| parameter | printed | deodar | reason |", "|---|---|---|---|"]
    for p in TABLE:
        if not np.isclose(p.printed, p.ours):
            lines.append(f"| {p.label} | {p.printed:g} | {p.ours:g} | {p.reason} |")
    return "\n".join(lines) + "\n"


def transitions(by_condition: RowsOfConditions) -> str:
    """Return the times of the instabilities of all transitions in arenas, from the ordinal node's off on."""
    every = [t for r in by_condition["arena"] for t in r["transitions"]]
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
    right = [step for r in by_condition["arena"] for step in in_order(r)]
    lines.append(f"| in the order of section 4.4 | {sum(right)} of {len(right)} | | | |")
    return "\n".join(lines) + "\n"
