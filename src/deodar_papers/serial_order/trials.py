"""Jobs: batches of runs, and the row of each run."""

from __future__ import annotations

import itertools
import math
import zlib
from collections.abc import Sequence

import numpy as np

from deodar.experiments.actions import Action, Move, Place, Remove
from deodar.experiments.jobs import Job
from deodar.experiments.rows import Row
from deodar_papers.serial_order.arenas import BLOCK, SearchArena
from deodar_papers.serial_order.colours import rgb
from deodar_papers.serial_order.conditions import (
    BACK,
    CARRIED,
    CuedCondition,
    SearchCondition,
    conditions,
    taught,
)
from deodar_papers.serial_order.cued import cued_row, cues, run_of
from deodar_papers.serial_order.parameters import values
from deodar_papers.serial_order.runs import (
    PEAKS,
    Settings,
    TaughtRun,
    found,
    learned,
    read_weights,
    run_many,
)

BATCH = 16
"""Runs in a batch."""

VARIED = 8
"""Conditions with a varied parameter whose runs make one batch."""

SECONDS = {"none": 2.0, "arena": 4.0, "ring": 3.0}
"""Approximate duration of a run by its body, s."""

ASIDE = math.radians(15)
"""Largest angle between the heading and the next block of the ring, rad."""


def jobs(quick: bool) -> list[Job]:
    """Return the jobs of all conditions: batches of runs whose sequences have equal length."""
    out: list[Job] = []
    found = conditions(quick).values()
    for c in found:
        for trials in () if c.varied else batches(c):
            keys = tuple(c.key(k) for k in trials)
            given = {"name": c.name, "quick": quick, "trials": list(trials)}
            out.append(Job(keys, run, given, SECONDS[c.body] * len(trials)))
    varied = [c for c in found if c.varied]
    for n in range(0, len(varied), VARIED):
        together = varied[n : n + VARIED]
        for trials in batches(together[0]):
            keys = tuple(c.key(k) for c in together for k in trials)
            given = {"names": [c.name for c in together], "trials": list(trials)}
            out.append(Job(keys, run_varied, given, SECONDS["ring"] * len(keys)))
    return out


def batches(c: SearchCondition) -> list[tuple[int, ...]]:
    """Return the runs of a condition in batches: sequences of one length, lessons of similar durations.

    Runs on the ring have actions that depend on the sequence; runs with an event have actions of their own.
    """

    def kind(k: int) -> tuple[int, str]:
        return len(c.sequence(k)), c.sequence(k) if c.body == "ring" else ""

    def order(k: int) -> tuple[tuple[int, str], float]:
        return kind(k), taught(c, k)[1]

    out: list[tuple[int, ...]] = []
    for _, group in itertools.groupby(sorted(range(c.count), key=order), kind):
        members = list(group)
        width = 1 if c.event else BATCH
        out += [tuple(members[n : n + width]) for n in range(0, len(members), width)]
    return out


def run(name: str, quick: bool, trials: Sequence[int]) -> Sequence[Row]:
    """Run some runs of a condition as one batch, and return their rows."""
    c = conditions(quick)[name]
    seed = zlib.crc32(c.key(trials[0]).encode()) % 2**31
    if isinstance(c, CuedCondition):
        return _rows(c, trials, _cued(c, trials, seed))
    runs = [TaughtRun(c.sequence(k), *taught(c, k), c.arena(k)) for k in trials]
    settings = Settings(
        limit=1000.0 * c.limit,
        clutter=c.clutter,
        look_around=c.look_around,
        habituation=c.habituation,
        actions=actions(c, runs[0]),
        # a batch stops at each sample while an action waits for an event
        coarse=c.body == "ring" or bool(c.duplicates) or bool(c.event),
    )
    if c.body == "none":
        done = [
            learned(r, weights) for r, weights in zip(runs, read_weights(runs, settings, seed), strict=True)
        ]
    else:
        watch = [PEAKS] if c.duplicates else []
        done = [found(r, *made) for r, made in zip(runs, run_many(runs, settings, seed, watch), strict=True)]
    return _rows(c, trials, done)


def run_varied(names: Sequence[str], trials: Sequence[int]) -> Sequence[Row]:
    """Run the same runs on the ring in several conditions, each with a varied parameter, as one batch, and
    return their rows.
    """
    together = [conditions(False)[name] for name in names]
    pairs = [(c, k) for c in together for k in trials]
    runs = [TaughtRun(c.sequence(k), *taught(c, k), c.arena(k)) for c, k in pairs]
    nodes = len(runs[0].sequence) + 1
    settings = Settings(
        limit=1000.0 * together[0].limit,
        varied=[values(c.varied, c.factor, nodes) for c, _ in pairs],
        actions=actions(together[0], runs[0]),
        coarse=True,
    )
    seed = zlib.crc32(together[0].key(trials[0]).encode()) % 2**31
    made = run_many(runs, settings, seed)
    return [
        row
        for (c, k), r, (trial, begins) in zip(pairs, runs, made, strict=True)
        for row in _rows(c, [k], [found(r, trial, begins)])
    ]


def _cued(c: CuedCondition, trials: Sequence[int], seed: int) -> list[Row]:
    """Run some runs that are taught two sequences."""
    runs = [run_of(c, k) for k in trials]
    settings = Settings(limit=1000.0 * c.limit, actions=cues(runs), coarse=True, cues=2)
    return [cued_row(r, *made) for r, made in zip(runs, run_many(runs, settings, seed), strict=True)]


def _rows(c: SearchCondition, trials: Sequence[int], done: Sequence[Row]) -> list[Row]:
    return [
        {"key": c.key(k), "condition": c.name, "trial": k, **row} for k, row in zip(trials, done, strict=True)
    ]


def actions(c: SearchCondition, first: TaughtRun) -> tuple[Action, ...]:
    """Return the actions on the runs of a batch; those of a condition with an event are for its first run."""
    if c.body == "ring":
        return tuple(_in_front(first.arena, first.sequence))
    if c.event == "removed" and len(first.sequence) > 1:
        k = next(n for n, b in enumerate(first.arena.blocks) if b.letter == first.sequence[1])
        name, center, color = f"block {k}", first.arena.blocks[k].center, rgb(first.sequence[1])
        return (
            Remove(0.0, name, when="looks for 2"),
            Place(1000.0 * BACK, name, center, (BLOCK, BLOCK), color, when="looks for 2"),
        )
    if c.event == "carried":
        return (Move(CARRIED, "khepera", free(first), when="looks for 2"),)
    return ()


def _in_front(arena: SearchArena, sequence: str) -> Sequence[Action]:
    """Return actions that put the vehicle into the middle of the ring at each new item, heading for its block
    but for a few degrees.
    """
    rng = np.random.default_rng(0)
    place = {b.letter: b.center for b in arena.blocks}
    out: list[Action] = []
    for k, letter in enumerate(sequence, 1):
        x, y = place[letter]
        heading = math.atan2(y, x) + float(rng.uniform(-ASIDE, ASIDE))
        out.append(Move(0.0, "khepera", (0.0, 0.0, heading), when=f"looks for {k}"))
    return out


def free(run: TaughtRun) -> tuple[float, float, float]:
    """Return a place away from all blocks, and a heading."""
    rng = np.random.default_rng((5, round(run.taught)))
    while True:
        x, y = rng.uniform(-200.0, 200.0, 2).tolist()
        if all(
            max(abs(x - a), abs(y - b)) > BLOCK / 2 + 60.0 for a, b in (k.center for k in run.arena.blocks)
        ):
            return x, y, float(rng.uniform(-math.pi, math.pi))
