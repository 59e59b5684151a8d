"""Runs that are taught two sequences, one after another; a cue says which one is produced."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from deodar.experiments.actions import Action, Set
from deodar.experiments.rows import Row
from deodar.experiments.trial import Trial
from deodar_papers.serial_order.conditions import CuedCondition, mixed, second_begins, taught
from deodar_papers.serial_order.runs import COARSE, TaughtRun, end_of_lessons, found

AFTER = 500.0
"""Time after a node became active at which the other cue is given, ms."""

NEVER = 1e8
"""Time of an action on other runs of the batch, ms."""


@dataclass(frozen=True)
class CuedRun(TaughtRun):
    """A run with two lessons; `sequence` is what its cues ask for.

    Attributes:
        pair: both sequences: that of cue 1, which is taught first, and that of cue 2.
        second: time at which the second lesson begins, ms.
        cue: the cue with which production begins.
        position: position at which the other cue is given; 0: never.
    """

    pair: tuple[str, str]
    second: float
    cue: int
    position: int = 0

    @property
    def positions(self) -> int:
        return max(map(len, self.pair))


def run_of(c: CuedCondition, k: int) -> CuedRun:
    """Return run k of a condition."""
    return CuedRun(
        c.sequence(k), *taught(c, k), c.arena(k), c.pair(k), second_begins(c, k), c.cue(k), c.position(k)
    )


def cues(runs: Sequence[CuedRun]) -> list[Action]:
    """Return the actions that give the cues in a batch: that of the second lesson when it begins, that of the
    production when it begins, and the other one while the vehicle looks for an item.
    """
    produced = end_of_lessons(runs)
    second = [COARSE * round((produced - run.taught + run.second) / COARSE) for run in runs]
    out: list[Action] = [
        Set(second, "cue", 2.0),
        Set([produced if run.cue == 1 else NEVER for run in runs], "cue", 1.0),
    ]
    for position in sorted({run.position for run in runs} - {0}):
        for cue in (1, 2):
            times = [AFTER if (run.position, run.cue) == (position, 3 - cue) else NEVER for run in runs]
            if min(times) < NEVER:
                out.append(Set(times, "cue", float(cue), when=f"looks for {position}"))
    return out


def cued_row(run: CuedRun, trial: Trial, produced: float) -> Row:
    """Return what a production leaves, with the position at which the other cue was given: from there the
    order continues with the other sequence.
    """
    out: Row = {"taught": list(run.pair), "cue": run.cue}
    if run.position:
        at = trial.events[f"looks for {run.position}"]
        position = None if at is None else _position(trial, at + AFTER)
        begun, cued = run.pair[run.cue - 1], run.pair[2 - run.cue]
        run = replace(run, sequence=mixed(begun, cued, run.position if position is None else position))
        out["changed"] = position
    return {**found(run, trial, produced), **out}


def _position(trial: Trial, time: float) -> int | None:
    """Return the position of the first node that is active from a time on."""
    begin = int(np.searchsorted(trial.times, time))
    count = sum(name.endswith(".node.activation") for name in trial.values)
    nodes = np.stack([trial.values[f"item {k}.node.activation"][begin:] > 0 for k in range(1, count + 1)], 1)
    active = np.flatnonzero(nodes.any(axis=1))
    return int(nodes[active[0]].argmax()) + 1 if len(active) else None
