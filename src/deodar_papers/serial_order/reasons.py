"""Why a sequence cannot be produced: checks before a run, and the reason why a run ended before its end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from deodar.errors import ParameterError, Problem
from deodar.experiments.trial import Trial
from deodar_papers.serial_order.arenas import SearchArena
from deodar_papers.serial_order.colours import letter_at
from deodar_papers.serial_order.teaching import Showing

LATEST = 200.0
"""Time before the end of a run within which a node was active if it is the present one, ms."""


class SearchTask(Protocol):
    """What is taught and looked for: a sequence of letters, its lesson, and the arena."""

    @property
    def sequence(self) -> str: ...

    @property
    def lesson(self) -> Sequence[Showing]: ...

    @property
    def taught(self) -> float: ...

    @property
    def arena(self) -> SearchArena: ...


def require_possible(runs: Sequence[SearchTask], single: bool = True) -> None:
    """Refuse runs whose sequence cannot be taught or found.

    Args:
        runs: the runs.
        single: whether their lessons teach the sequence alone.

    Raises:
        ParameterError: a lesson shows another number of colours than the sequence has, or lasts longer than
            it is taught, or an arena has no block of a wanted colour.
    """
    problems: list[Problem] = []
    for number, run in enumerate(runs):
        where = f"run {number}" if len(runs) > 1 else ""
        if single and len(run.lesson) != len(run.sequence):
            fault = (
                f"the lesson shows {len(run.lesson)} colours, and the sequence {run.sequence} has"
                f" {len(run.sequence)}"
            )
            fix = "Show each colour of the sequence once: the node of a missing one learns the next colour,"
            problems.append(Problem(where, fault, f"{fix} and no node learns one too many"))
        late = [shown.letter for shown in run.lesson if shown.ends > run.taught]
        if late:
            fault = (
                f"the lesson still shows {', '.join(late)} when production begins, after {run.taught:g} ms;"
                " nothing is learned while a sequence is produced"
            )
            problems.append(Problem(where, fault, "End the lesson later, or show these colours before"))
        missing = [letter for letter in dict.fromkeys(run.sequence) if letter not in _letters(run)]
        if missing:
            fault = (
                f"the arena has no block of the colour {', '.join(missing)}, which the sequence"
                f" {run.sequence} wants, so its production would never finish"
            )
            problems.append(Problem(where, fault, "Add a block of this colour to the arena"))
    if problems:
        raise ParameterError(problems)


def reason(run: SearchTask, trial: Trial, produced: float) -> str:
    """Return why a production ended before the sequence was complete, from the nodes that are active at its
    end and the peak of the action field.

    Args:
        run: the sequence and its arena.
        trial: the trial, as `run_many` returns it.
        produced: time at which production began, ms.
    """
    v, times = trial.values, trial.times
    count = sum(name.endswith(".node.activation") for name in v)
    total = len(run.sequence)
    late = times >= max(produced, float(times[-1]) - LATEST)
    nodes = np.stack([v[f"item {k}.node.activation"] > 0 for k in range(1, count + 1)], axis=1)
    active = np.flatnonzero(nodes[late].any(axis=0))
    if not len(active):
        return "no ordinal node is active"
    item = int(active[-1]) + 1
    if item > total:
        return f"all {total} nodes of the sequence have been active"
    hues = v["hue of action.output"][late & nodes[:, item - 1]]
    recalled_hues = hues[hues >= 0]
    if not len(recalled_hues):
        return f"item {item} of {total} has learned no colour"
    letters = sorted({*_letters(run), *run.sequence})
    letter = letter_at(float(recalled_hues[-1]), letters)
    absent = "" if letter in _letters(run) else ", of which the arena has no block"
    return f"still looking for {letter} (item {item} of {total}){absent}"


def _letters(run: SearchTask) -> set[str]:
    return {block.letter for block in run.arena.blocks}
