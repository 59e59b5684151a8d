"""Claims on the rows: each required one can fail, and states its interval."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from deodar.analysis.claims import Claim
from deodar.architectures.pointing import CUES
from deodar.experiments.rows import Row
from deodar_papers._report import NOT_RUN, reported_share, required_share
from deodar_papers.pointing.sensitivity import changes
from deodar_papers.pointing.trials import CASES, VARIANTS

SOURCE = "Lomp et al. (2016), Front. Neurorobot. 10:14"
FIGURE_8, FIGURE_11 = f"{SOURCE}, figure 8", f"{SOURCE}, figure 11"

SILENT, RIGHT, CASE = 0.995, 0.99, 0.96
"""Least share of controls without a peak, of right cycles, and of right special cases (48 of 50)."""

WORDS = {
    "equal": "two equal, saturated matches for 2 s: exactly one is selected",
    "same": "the same cues again, the tool at the target: a whole cycle",
    "moved": "the target moves 10 cm during the reach: it is followed",
    "jumped": "the target jumps 12 cm during the reach: the tool ends at its new place",
    "removed": "the target is taken away: no peak, the tool is still, cues stay on; put back: the cycle ends",
    "pushed": "the arm is pushed during the reach: the cycle ends at the object",
    "noisy": "the noise of the camera is doubled: right, in order",
    "dim": "half of the light: right, in order",
}

STILL = 0.01
"""Largest way of the tool after the peak of a target that was taken away is gone, m."""


def claims(rows: Mapping[str, Row], quick: bool) -> list[Claim]:
    """Return all claims."""
    found = list(rows.values())
    out = _of_scenes([r for r in found if r["condition"] == "scene"], "", quick, required=True)
    for case in CASES:
        of = [r for r in found if r["condition"] == case]
        least = 1.0 if case == "equal" else CASE
        source = FIGURE_8 if case == "equal" else FIGURE_11
        out.append(required_share(WORDS[case], [judged(r) for r in of], least, source, quick))
    for name in VARIANTS:
        of = [r for r in found if r["condition"] == name]
        if not quick:
            good = [_good(r) for r in of if _counts(r)]
            out.append(required_share(f"{name}: {EVERYTHING}", good, RIGHT, "", quick))
    shown = [r for r in found if r["condition"] == "photograph"]
    out.append(
        required_share(PHOTOGRAPHS, [r["inside"] == r["match"] for r in shown], RIGHT, FIGURE_8, quick)
    )
    beyond = [r for r in found if r["condition"] == "beyond"]
    return [*out, *(_of_scenes(beyond, "beyond the range: ", quick, required=False) if not quick else [])]


PHOTOGRAPHS = "photographs: a peak inside the marked object for its colour and side, none for other pairs"
EVERYTHING = "controls are silent, and every match is selected, reached and ended in order"


def _of_scenes(rows: Sequence[Row], prefix: str, quick: bool, required: bool) -> list[Claim]:
    pairs = [r for r in rows if "matches" in r]
    one = [r for r in pairs if r["matches"] == 1 and not r["hidden"]]
    more = [r for r in pairs if r["matches"] > 1]
    matched = [*one, *more]
    reached = [r for r in matched if r["right"] and r["miss"] is not None]
    table: list[tuple[str, Sequence[Row], Callable[[Row], bool], float, str]] = [
        ("the camera alone: no peak", _named(rows, "camera"), _no_peak, SILENT, FIGURE_8),
        ("one cue alone: no peak", _named(rows, *CUES), _no_peak, SILENT, FIGURE_8),
        ("no match: no peak", [r for r in pairs if _unmatched(r)], silent, SILENT, FIGURE_8),
        ("one match: the right object, in order", one, cycled, RIGHT, FIGURE_11),
        ("several matches: exactly one, right, in order", more, single, RIGHT, FIGURE_8),
        ("the tool is inside the rim at satisfaction", reached, inside, RIGHT, ""),
        ("the tool is inside the rim 1 s later", reached, _stays_inside, RIGHT, ""),
        ("everything is below threshold afterwards", matched, _rests, RIGHT, FIGURE_11),
    ]
    out: list[Claim] = []
    for name, of, holds, least, source in table:
        good = [holds(r) for r in of]
        text = prefix + name
        out.append(
            required_share(text, good, least, source, quick)
            if required
            else reported_share(text, good, source)
        )
    misses = [100 * r["miss"] for r in reached]
    text = f"{prefix}distance of the tool from the middle of the object, cm: median and largest"
    value = [round(float(np.median(misses)), 2), round(max(misses), 2)] if misses else None
    return [*out, Claim(text, value, "none", None, "reported", n=len(misses), origin="none")]


def table(found: Sequence[Claim]) -> str:
    """Return the claims as a table in Markdown: share, number of runs, 95 % interval, target."""
    lines = ["| claim | share | runs | 95 % interval | target |", "|---|---|---|---|---|"]
    for claim in found:
        if claim.interval is None and not isinstance(claim.value, float):
            continue
        share = "-" if claim.value is None else f"{100 * float(str(claim.value)):.1f} %"
        between = "-" if claim.interval is None else " to ".join(f"{100 * v:.1f}" for v in claim.interval)
        target = f"{claim.target}" if claim.kind == "required" else "reported"
        lines.append(f"| {claim.name} | {share} | {claim.n} | {between} % | {target} |")
    return "\n".join(lines)


def sensitivity_table(rows: Mapping[str, Row]) -> str:
    """Return a table of the changed parameters in Markdown, those with the largest effect first.

    It counts the controls and the pairs without a match that are silent, and the matches that are selected
    and reached in order.
    """
    named: dict[str, dict[str, str]] = {}
    worst: dict[str, float] = {}
    for condition in changes():
        name, sign = condition.rsplit(" ", 2)[0], " ".join(condition.rsplit(" ", 2)[1:])
        of = [r for r in rows.values() if r["condition"] == condition and _counts(r)]
        if not of:
            return NOT_RUN
        met = [_good(r) for r in of if r.get("matches")]
        none = [_good(r) for r in of if not r.get("matches")]
        named.setdefault(name, {})[sign] = f"{sum(none)} of {len(none)} | {sum(met)} of {len(met)}"
        share = min(sum(none) / len(none), sum(met) / len(met))
        worst[name] = min(worst.get(name, 1.0), share)
    lines = ["| parameter | -20 %: silent | right | +20 %: silent | right |", "|---|---|---|---|---|"]
    for name in sorted(named, key=lambda n: (worst[n], n)):
        lines.append(f"| `{name}` | {named[name]['-20 %']} | {named[name]['+20 %']} |")
    return "\n".join(lines)


def numbers(found: Sequence[Claim], rows: Mapping[str, Row]) -> dict[str, str]:
    """Return what the manual states: the tables, and the distances of the tool."""
    out = {"claims": table(found), "sensitivity": sensitivity_table(rows)}
    for claim in found:
        if isinstance(claim.value, list) and claim.name.startswith("distance"):
            median, largest = claim.value
            out |= {"median": f"{median} cm", "largest": f"{largest} cm"}
    return {"median": NOT_RUN, "largest": NOT_RUN, **out}


def silent(row: Row) -> bool:
    """Return whether a pair of cues led to no peak."""
    return row["peaks"] == 0 and row["peak"] is None


def cycled(row: Row) -> bool:
    """Return whether a cycle selected the right object, and its events are in order."""
    return bool(row["right"] and row["ordered"])


def single(row: Row) -> bool:
    """Return whether it did so with one peak all the time."""
    return cycled(row) and row["peaks"] == 1


def inside(row: Row, at: str = "miss") -> bool:
    """Return whether the tool was inside the rim of the selected object."""
    return row[at] is not None and row["radius"] is not None and row[at] < row["radius"]


def _stays_inside(row: Row) -> bool:
    return inside(row, "miss_after")


def judged(row: Row) -> bool:
    """Return whether a special case went as it has to."""
    case = row["condition"]
    if case == "equal":
        return bool(row["right"]) and row["peaks"] == 1
    there = cycled(row) and inside(row) and _stays_inside(row)
    if case in ("moved", "jumped"):
        return there and row.get("way") is not None
    if case == "pushed":
        return there and bool(row.get("pushed"))
    if case == "removed":
        gone = row.get("gone") is not None and row["drift"] is not None and row["drift"] < STILL
        return there and gone and row.get("cues on") == 2
    return there


def _good(row: Row) -> bool:
    """Return whether a row of a scene went as it has to."""
    if "matches" not in row:
        return row["peaks"] == 0
    return silent(row) if _unmatched(row) else cycled(row) and inside(row)


def _counts(row: Row) -> bool:
    """Return whether a row is judged: objects that are partly hidden may be selected or not."""
    return "matches" not in row or not row["hidden"]


def _unmatched(row: Row) -> bool:
    return row["matches"] == 0 and not row["hidden"]


def _rests(row: Row) -> bool:
    return "rest" in row["events"]


def _no_peak(row: Row) -> bool:
    return row["peaks"] == 0


def _named(rows: Sequence[Row], *names: str) -> list[Row]:
    """Return the rows of controls with one of these names."""
    return [r for r in rows if r["key"].rpartition("/")[2].partition(" ")[2] in names]
