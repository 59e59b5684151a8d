"""Run of figure 11: a sequence is taught in a short lesson, and produced in a random arena."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray

from deodar.analysis.claims import Claim
from deodar.architectures.color_search import column_axis, hue_axis
from deodar.errors import ParameterError, option
from deodar.experiments.trial import Trial
from deodar_papers.serial_order.arenas import random_arena
from deodar_papers.serial_order.colours import FIVE, letter_at
from deodar_papers.serial_order.reasons import reason
from deodar_papers.serial_order.runs import ABSENT, CHANGED, COARSE, FAR, Settings, TaughtRun, found, run_many
from deodar_papers.serial_order.teaching import brief_lesson

SOURCE = "Sandamirskaya & Schöner (2010), Neural Networks 23(10), figure 11"

SEQUENCE = "RBGBY"
"""The sequence of figure 11."""

MOST = 10
"""Largest number of colours in a sequence."""

LIMIT = 200_000.0
"""Longest production, ms."""

EVERY = 2
"""Samples of the run per sample of the written record."""

CALL = 24 * COARSE
"""Simulated time of one call of the program, ms."""

PEAK = 0.5
"""Output of the colour-space field above which it has a peak."""

FIELDS = ("action", "satisfaction")
PROJECTION = "columns of the peak.output"
MEANINGS = "all meanings.output"
POSE = "pose.output"


@dataclass(frozen=True)
class SearchRun:
    """A sequence that was taught and produced.

    Attributes:
        taught: the sequence, its lesson and the arena; times of the lesson are those of the record.
        begins: time at which production begins, ms.
        record: activation of the ordinal nodes and of both fields over hue, output of the colour-space field
            over image columns, and pose of the vehicle, over time.
        recalled: letter of the colour that each ordinal node activates in the action field; `-` for a node
            that did not become active.
        weights: weights of the ordinal nodes to the action field, (nodes, hues), with those of the node
            behind the sequence, as each node activates them in production; 0 of one that did not become
            active.
        produced: letters of the blocks that were found.
        found: time at which each block was found, ms.
        seen: time at which a block of each wanted colour came into view, ms; None for a block that did not.
        distances: distance of each block when it was found, mm; infinite if no such block was in view.
        reason: why the run ended before all blocks were found; empty if they were.
    """

    taught: TaughtRun
    begins: float
    record: xarray.Dataset
    recalled: str
    weights: np.ndarray
    produced: str
    found: tuple[float, ...]
    seen: tuple[float | None, ...]
    distances: tuple[float, ...]
    reason: str = ""

    @property
    def sequence(self) -> str:
        """Letters of the taught colours."""
        return self.taught.sequence

    @property
    def hues(self) -> Mapping[str, float]:
        """Samples of hue of all colours, by letter."""
        return FIVE

    @property
    def small(self) -> xarray.Dataset:
        """The record as it is written, with every second sample."""
        return self.record.isel(time=slice(None, None, EVERY))


def checked(sequence: str) -> str:
    """Return a sequence in capital letters.

    Raises:
        ParameterError: it is empty or too long, or a letter is not that of a colour.
    """
    letters = sequence.upper()
    if not 1 <= len(letters) <= MOST:
        raise ParameterError(
            f"the sequence {sequence!r} has {len(letters)} colours; expected 1 to {MOST}",
            where="--sequence",
            fix=option("For example", "sequence", SEQUENCE, repr(SEQUENCE)),
        )
    unknown = [letter for letter in letters if letter not in FIVE]
    if unknown:
        raise ParameterError(
            f"the sequence {sequence!r} has the letter {unknown[0]!r}, which is not that of a colour",
            where="--sequence",
            fix=f"Use the letters {', '.join(FIVE)} (red, yellow, green, blue, violet)",
        )
    return letters


def run(
    sequence: str = SEQUENCE,
    seed: int = 0,
    done: Callable[[float, bool], None] = lambda *_: None,
    clutter: float = 0.0,
) -> SearchRun:
    """Teach a sequence and produce it.

    Args:
        sequence: letters of its colours.
        seed: seed of the arena and of all noise.
        done: called with the completed share of the longest run, and whether production has begun.
        clutter: share of the background of the picture that random colours cover while it is taught.
    """
    letters = checked(sequence)
    lesson, taught = brief_lesson(letters)
    run = TaughtRun(letters, lesson, taught, random_arena(letters, (seed,)))
    calls = 0

    def between(_: int) -> None:
        nonlocal calls
        calls += 1
        done(min(1.0, calls * CALL / (taught + LIMIT)), calls * CALL > taught)

    watch = [*(f"{name}.activation" for name in FIELDS), PROJECTION, MEANINGS]
    settings = Settings(limit=LIMIT, clutter=clutter, coarse=True, ends_unlearned=True)
    [(trial, begins)] = run_many([run], settings, seed, watch, between)
    return read(run, trial, begins)


def read(run: TaughtRun, trial: Trial, begins: float) -> SearchRun:
    """Find the events of a trial in which production begins at a time."""
    row = found(run, trial, begins)
    times = trial.times
    ends = tuple(begins + 1000.0 * t for t in np.asarray(row["found"], float).tolist())
    peak = trial.values["strongest peak.output"] > PEAK
    seen: list[float | None] = []
    for begun, end in zip((begins, *ends), (*ends, times[-1]), strict=True):
        # the peak at the block that was found last ends before the next one can begin
        inside = np.flatnonzero((times > begun) & (times <= end))
        onsets = inside[peak[inside] & ~peak[inside - 1]]
        seen.append(float(times[onsets[-1]]) if len(onsets) else None)
    later = begins - run.taught
    return SearchRun(
        replace(run, lesson=[showing.later(later) for showing in run.lesson]),
        begins,
        _record(run, trial),
        "".join(_recalled(run, trial, begins, k) for k in range(1, len(run.sequence) + 1)),
        np.stack([_weights(trial, begins, k) for k in range(1, len(run.sequence) + 2)]),
        str(row["produced"]),
        ends,
        tuple(seen[: len(ends)]),
        tuple(np.asarray(row["distances"], float).tolist()),
        reason(run, trial, begins) if row["outcome"] == "unfinished" else "",
    )


def _recalled(run: TaughtRun, trial: Trial, begins: float, item: int) -> str:
    """Return the colour in the action field when a node was last active, `-` if it was not."""
    active = trial.values[f"item {item}.node.activation"] > 0
    hues = trial.values["hue of action.output"]
    at = np.flatnonzero(active & (hues != ABSENT) & (trial.times >= begins))
    return letter_at(float(hues[at[-1]]), tuple(FIVE)) if len(at) else "-"


def _weights(trial: Trial, begins: float, item: int) -> np.ndarray:
    """Return the weights of a node: what all nodes activate while it alone is active."""
    active = trial.values[f"item {item}.node.activation"] > 0
    at = np.flatnonzero(active & (trial.times >= begins + CHANGED))
    meanings = trial.values[MEANINGS]
    return meanings[at[len(at) // 2]] if len(at) else np.zeros(meanings.shape[1])


def _record(run: TaughtRun, trial: Trial) -> xarray.Dataset:
    v, hue, column = trial.values, hue_axis(), column_axis()
    nodes = [f"item {k}.node.activation" for k in range(1, len(run.sequence) + 2)]
    variables = {
        **{name: (("time",), v[name]) for name in nodes},
        **{f"{name}.activation": (("time", "hue"), v[f"{name}.activation"]) for name in FIELDS},
        PROJECTION: (("time", "column"), v[PROJECTION]),
        POSE: (("time", "x_y_heading"), v[POSE]),
    }
    coords = {
        "time": ("time", trial.times, {"units": "ms"}),
        "hue": ("hue", hue.points, {"periodic": 1, "lower": hue.lower, "upper": hue.upper}),
        "column": ("column", column.points, {"periodic": 0, "lower": column.lower, "upper": column.upper}),
    }
    return xarray.Dataset(variables, coords, {"title": f"the sequence {run.sequence}, taught and produced"})


def claims(search: SearchRun) -> list[Claim]:
    """Return the claims on a run, computed from it."""
    r = search
    within = bool(r.distances) and max(r.distances) <= FAR
    took = np.diff([r.begins, *r.found]) / 1000
    ours: dict[str, Any] = {"source": SOURCE, "origin": "ours"}
    return [
        Claim(
            "each ordinal node recalls its colour: colours in the action field",
            r.recalled,
            r.sequence,
            r.recalled == r.sequence,
            **ours,
        ),
        Claim(
            "all blocks are found in the learned order: colours",
            r.produced,
            r.sequence,
            r.produced == r.sequence,
            **ours,
        ),
        Claim(
            "a block of the wanted colour is in the middle of the picture when it is found: distances, mm",
            [round(d, 1) if np.isfinite(d) else None for d in r.distances],
            f"<= {FAR:g}",
            within,
            **ours,
        ),
        Claim(
            "durations of the searches, s",
            [round(float(t), 2) for t in took],
            "none",
            None,
            "reported",
            origin="none",
        ),
    ]


def sentence(search: SearchRun) -> str:
    """Return the outcome in one line of plain words."""
    r = search
    found_after = [
        f"{letter} after {(at - r.begins) / 1000:.1f} s"
        for letter, at in zip(r.produced, r.found, strict=True)
    ]
    text = f"Taught {r.sequence}; found {', '.join(found_after) or 'nothing'}"
    missing = len(r.sequence) - len(r.produced)
    took = (float(r.record["time"][-1]) - r.begins) / 1000
    why = f": {r.reason}" if r.reason else ""
    return text + (f"; {missing} not found in {took:.1f} s{why}." if missing > 0 else ".")
