"""Claims on the rows: each required one can fail, and states its interval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from deodar.analysis import statistics
from deodar.analysis.claims import Claim
from deodar.analysis.statistics import rounded
from deodar.experiments.rows import Row
from deodar_papers._report import NOT_RUN
from deodar_papers.looking.conditions import AFTER, CHANGED, after, conditions
from deodar_papers.looking.gazes import CLOSE

SOURCE = "Sandamirskaya (2014), Front. Neurosci. 7:276, section 3"

MEAN, EACH, MEDIAN = 0.95, 0.90, 6.0
"""Of the correcting mechanism: least mean share of near gazes, least share of each seed, largest median."""

PAPER, UNREWARDED = 0.55, 0.10
"""Least mean share of the paper's mechanism, and largest share without the reward."""

SEVERAL = 500
"""What "several hundred gaze movements" is taken to be."""


def claims(rows: Mapping[str, Row], quick: bool) -> list[Claim]:
    """Return all claims."""
    design = conditions(quick)
    last = {name: design[name].last for name in design}
    best = of(rows, "correcting", last["correcting"])
    out = [
        _mean(f"correcting, {last['correcting']} gazes: mean share within 12 pixels", best, MEAN, 1.0, quick),
        _least(f"correcting, {last['correcting']} gazes: every seed within 12 pixels", best, quick),
        _median(f"correcting, {last['correcting']} gazes: median distance of all tests, pixels", best),
    ]
    if not quick:
        for gain in CHANGED:
            what = "unchanged gain (control)" if gain == 1 else f"gain x{gain:g}"
            out.append(_reported(f"{what}: share within 12 pixels at once", of(rows, "correcting", 0, gain)))
            text = f"{what}: share within 12 pixels after {AFTER[-1]} gazes"
            out.append(_mean(text, of(rows, "correcting", AFTER[-1], gain), MEAN, 1.0, quick))
        text = f"paper, {last['paper']} gazes: mean share within 12 pixels"
        out.append(_mean(text, of(rows, "paper", last["paper"]), PAPER, 1.0, quick))
    text = f"paper without the reward, {last['no reward']} gazes: mean share within 12 pixels"
    out.append(_mean(text, of(rows, "no reward", last["no reward"]), 0.0, UNREWARDED, quick))
    if not quick:
        text = f"paper without the memory in learning, {last['no memory']} gazes: share within 12 pixels"
        out.append(_reported(text, of(rows, "no memory", last["no memory"])))
    for name in ("correcting", "paper"):
        text = f"{name}, several hundred ({SEVERAL}) gazes: share within 12 pixels"
        out.append(_reported(text, of(rows, name, SEVERAL), SOURCE))
    return out


def of(rows: Mapping[str, Row], name: str, gazes: int, gain: float | None = None) -> list[Row]:
    """Return the rows of a run after a number of gazes, by seed."""
    condition = after(name, gazes, gain)
    found = [r for r in rows.values() if r["condition"] == condition]
    return sorted(found, key=lambda row: row["seed"])


def shares(rows: Sequence[Row]) -> np.ndarray:
    """Return the share of near gazes of each row."""
    return np.asarray([row["near"] / row["tests"] for row in rows])


def errors(rows: Sequence[Row]) -> np.ndarray:
    """Return the distances of all tests, pixels; infinite without a gaze."""
    return np.asarray([np.inf if e is None else e for row in rows for e in row["errors"]])


def _mean(text: str, rows: Sequence[Row], low: float, high: float, quick: bool) -> Claim:
    """Return the required claim that the mean share over seeds is between two bounds."""
    found = shares(rows)
    value = float(found.mean()) if len(found) else None
    interval = statistics.mean_interval(found)
    holds = None if value is None else low <= value <= high
    if quick and holds is False and not _excluded(interval, low, high):
        holds = None
    target = f">= {low:g}" if high == 1.0 else f"<= {high:g}"
    shown = None if value is None else round(value, 4)
    return Claim(text, shown, target, holds, "required", SOURCE, len(rows), rounded(interval), origin="ours")


def _excluded(interval: tuple[float, float] | None, low: float, high: float) -> bool:
    return interval is not None and (interval[1] < low or interval[0] > high)


def _least(text: str, rows: Sequence[Row], quick: bool) -> Claim:
    found = shares(rows)
    value = round(float(found.min()), 4) if len(found) else None
    holds = None if value is None or (quick and value < EACH) else value >= EACH
    return Claim(text, value, f">= {EACH:g}", holds, "required", SOURCE, len(rows), origin="ours")


def _median(text: str, rows: Sequence[Row]) -> Claim:
    found = errors(rows)
    value = round(float(np.median(found)), 2) if len(found) else None
    interval = statistics.median_interval(found) if len(found) else None
    holds = None if value is None else value <= MEDIAN
    target = f"<= {MEDIAN:g}"
    return Claim(text, value, target, holds, "required", SOURCE, len(found), rounded(interval), origin="ours")


def _reported(text: str, rows: Sequence[Row], source: str = "") -> Claim:
    found = shares(rows)
    value = round(float(found.mean()), 4) if len(found) else None
    interval = rounded(statistics.mean_interval(found)) if len(found) else None
    return Claim(text, value, "none", None, "reported", source, len(rows), interval, origin="none")


def table(rows: Mapping[str, Row], quick: bool) -> str:
    """Return the learning curves as a table in Markdown."""
    lines = [
        "| condition | gazes | within 12 px: mean (seeds) | within 6 px | median, px | no gaze | seeds |",
        "|---|---|---|---|---|---|---|",
    ]
    named: list[tuple[str, int, float | None]] = [
        (name, mark, None) for name, c in conditions(quick).items() for mark in c.marks
    ]
    if not quick:
        named += [("correcting", mark, gain) for gain in CHANGED for mark in (0, *AFTER)]
    for name, mark, gain in named:
        found = of(rows, name, mark, gain)
        if not found:
            continue
        near, away = shares(found), errors(found)
        close = np.count_nonzero(away <= CLOSE) / len(away)
        missing = sum(row["no gaze"] for row in found)
        run, mean = after(name, mark, gain).rpartition("/")[0], f"{near.mean():.3f}"
        lines.append(
            f"| {run} | {mark} | {mean} ({near.min():.2f} to {near.max():.2f}) | {close:.2f} |"
            f" {np.median(away):.1f} | {missing} of {len(away)} | {len(found)} |"
        )
    return "\n".join(lines) if len(lines) > 2 else NOT_RUN


def numbers(rows: Mapping[str, Row], quick: bool) -> dict[str, str]:
    """Return what the manual states: the tables, and the shares by condition and number of gazes."""
    out = {"curves": table(rows, quick), "claims": _claims_table(claims(rows, quick))}
    for name, condition in conditions(quick).items():
        for mark in condition.marks:
            found = of(rows, name, mark)
            out[f"share:{name}/{mark}"] = f"{shares(found).mean():.3f}" if found else NOT_RUN
            out[f"median:{name}/{mark}"] = f"{np.median(errors(found)):.1f}" if found else NOT_RUN
    seconds = [
        row["seconds"] / row["gazes"] for row in of(rows, "correcting", conditions(quick)["correcting"].last)
    ]
    out["gaze"] = f"{np.mean(seconds):.2f} s" if seconds else NOT_RUN
    return out


def _claims_table(found: Sequence[Claim]) -> str:
    lines = ["| claim | value | 95 % interval | target |", "|---|---|---|---|"]
    for claim in found:
        between = "-" if claim.interval is None else " to ".join(f"{v:.3f}" for v in claim.interval)
        value = "-" if claim.value is None else f"{claim.value}"
        target = f"{claim.target}" if claim.kind == "required" else "reported"
        lines.append(f"| {claim.name} | {value} | {between} | {target} |")
    return "\n".join(lines)
