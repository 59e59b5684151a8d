"""Claims: the required ones, and the sentences of the paper with deodar's numbers."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from deodar.analysis import statistics
from deodar.analysis.claims import Claim, ClaimKind
from deodar.analysis.statistics import rounded
from deodar.experiments.rows import Row
from deodar_papers._report import reported_share, required_share
from deodar_papers.serial_order import sentences
from deodar_papers.serial_order.conditions import BACK, CARRIED, WITHHELD, conditions

SOURCE = "Sandamirskaya & Schöner (2010)"
NONE = "no sentence of the paper"

AT_ONCE = 1.0
"""Duration up to which a repeated colour was found at once, s."""

RowsOfConditions = Mapping[str, Sequence[Row]]
"""Rows of each condition, in the order of their trials."""


def by_condition(rows: Mapping[str, Row], quick: bool) -> dict[str, list[Row]]:
    """Return the rows of each condition, in the order of their trials."""
    out: dict[str, list[Row]] = {name: [] for name in conditions(quick)}
    for row in rows.values():
        out[row["condition"]].append(row)
    return {name: sorted(group, key=lambda row: row["trial"]) for name, group in out.items()}


def claims(rows_by_condition: RowsOfConditions, quick: bool) -> list[Claim]:
    """Return all claims."""
    return [
        *_required(rows_by_condition, quick),
        *_reported(rows_by_condition, quick),
        *sentences.claims(rows_by_condition),
    ]


def _required(rows_by_condition: RowsOfConditions, quick: bool) -> list[Claim]:
    taught = [*rows_by_condition["learning"], *rows_by_condition["clutter"]]
    withheld = [
        r for r in rows_by_condition["removed"] if len(r["actions"]) < 2 or r["actions"][1] > WITHHELD
    ]
    searched = [r for name, rows in rows_by_condition.items() if not _apart(name) for r in rows]
    steps = [right for row in rows_by_condition["arena"] for right in in_order(row)]

    def share(
        name: str, rows: Sequence[Row], true: Callable[[Row], bool], least: float, source: str
    ) -> Claim:
        return required_share(name, [true(row) for row in rows], least, source, quick)

    return [
        share("a sequence is learned", taught, lambda r: r["right"], 0.99, f"{SOURCE}, sections 6.1 and 6.5"),
        _none(
            "production in arenas without an error of order, a skip, a repetition, or a condition of"
            " satisfaction on a wrong or distant block",
            [r["outcome"] == "wrong" for r in rows_by_condition["arena"]],
            f"{SOURCE}, section 6.2",
        ),
        share(
            "production complete within 600 s",
            rows_by_condition["arena"],
            _complete,
            0.95,
            f"{SOURCE}, section 6.2",
        ),
        required_share(
            "all transitions in the order of section 4.4", steps, 1.0, f"{SOURCE}, section 4.4", quick
        ),
        share("production on the ring, without search", rows_by_condition["ring"], _complete, 1.0, NONE),
        share(
            f"a block is taken away for {BACK:g} s: the vehicle looks for it until it is back, and completes"
            " the sequence",
            withheld,
            _waits,
            1.0,
            f"{SOURCE}, section 6.3",
        ),
        _none(
            "three duplicates of wanted blocks: no error of order",
            [r["outcome"] == "wrong" for r in rows_by_condition["duplicates"]],
            f"{SOURCE}, section 6.2",
        ),
        _none(
            "three duplicates of wanted blocks: one is chosen, and none is found while a peak in the"
            " colour-space field lies on another",
            [n != 1 for r in rows_by_condition["duplicates"] for n in r["chosen"]],
            f"{SOURCE}, section 5.2",
        ),
        _none("no error of order in any arena", [r["outcome"] == "wrong" for r in searched], SOURCE),
    ]


def _reported(rows_by_condition: RowsOfConditions, quick: bool) -> list[Claim]:
    durations = np.asarray([d for r in rows_by_condition["arena"] for d in r["actions"]])
    out: list[Claim] = []
    for name, function in (("shortest", np.min), ("median", np.median), ("longest", np.max)):
        duration = round(float(function(durations)), 2) if len(durations) else None
        out.append(_value(f"{name} action, s", duration, len(durations), f"{SOURCE}, section 6.3"))
    repetitions = [d for r in rows_by_condition["repetition"] for d in repeated(r)]
    out.append(
        _share_only(
            "a repeated colour is found within 1 s", [d <= AT_ONCE for d in repetitions], "section 6.4"
        )
    )
    out.append(
        _share_only(
            "with habituation a repeated colour is found by a second visit (its block left the middle of the"
            " picture before)",
            [left for r in rows_by_condition["habituation"] for left in visits(r)],
            "section 6.4",
        )
    )
    for name, text in (
        ("habituation", "production complete, with habituation"),
        ("wander", "production complete without looking around, as in the paper"),
        ("carried", "production complete although the vehicle is carried elsewhere while it searches"),
        ("ten", "production of ten colours complete"),
        ("cued", "production complete, two sequences taught and one of them cued"),
        ("cued-changed", "production complete, the cue changed at the second or third item"),
    ):
        rows = [r for r in rows_by_condition[name] if name != "carried" or _was_carried(r)]
        out.append(_share_only(text, [_complete(r) for r in rows], "", NONE))
        out.append(_share_only(f"{text}: wrong", [r["outcome"] == "wrong" for r in rows], "", NONE))
    return out


def in_order(row: Row) -> list[bool]:
    """Return for each transition of a run whether its instabilities have the order of section 4.4."""
    last = len(row["sequence"])
    return [
        ordered(transition, node == last)
        for node, transition in zip(row["nodes"], row["transitions"], strict=False)
    ]


def ordered(transition: Sequence[float | None], last: bool = False) -> bool:
    """Return whether the instabilities of a transition have the order of section 4.4: satisfaction on, node
    off, action off, satisfaction off, next node on, next action on.

    Args:
        transition: their times; equal times are those of one step.
        last: whether it is the transition to the node behind the sequence, which has no action.
    """
    satisfied, action, _, gone, node, again = transition
    times = [satisfied, 0.0, action, gone, node, again]
    if satisfied is None or action is None or gone is None or node is None or (again is None and not last):
        return False
    known = [t for t in times if t is not None]
    return all(a <= b for a, b in itertools.pairwise(known))


def repeated(row: Row) -> list[float]:
    """Return the durations of the actions whose colour is that of the action before, s."""
    letters = row["sequence"]
    return [
        duration
        for k, duration in enumerate(row["actions"])
        if 0 < k < len(letters) and letters[k] == letters[k - 1]
    ]


def visits(row: Row) -> list[bool]:
    """Return whether the block left the middle of the picture before each action whose colour is that of the
    action before.
    """
    letters = row["sequence"]
    return [
        left for k, left in enumerate(row["left"]) if 0 < k < len(letters) and letters[k] == letters[k - 1]
    ]


def _complete(row: Row) -> bool:
    return bool(row["outcome"] == "complete")


def _waits(row: Row) -> bool:
    """Return whether the second block was found after it was back, and the others too."""
    return _complete(row) and row["actions"][1] >= BACK


def _was_carried(row: Row) -> bool:
    """Return whether the vehicle still looked for the second block when it was carried elsewhere."""
    return len(row["actions"]) < 2 or bool(row["actions"][1] > CARRIED / 1000)


def _apart(name: str) -> bool:
    """Return whether the rows of a condition have no order that is judged in an arena."""
    return name in ("learning", "clutter", "ring") or name.startswith("vary/")


def _none(name: str, true: Sequence[bool], source: str) -> Claim:
    """Return the claim that something occurs in no run; the interval is that of its share."""
    interval = statistics.wilson(sum(true), len(true)) if true else None
    holds = None if not true else not any(true)
    value = sum(true) if true else None
    kind: ClaimKind = "required"
    return Claim(name, value, "none", holds, kind, source, len(true), rounded(interval), origin="ours")


def _share_only(name: str, true: Sequence[bool], section: str, source: str = SOURCE) -> Claim:
    """Return a share without a target."""
    return reported_share(name, true, f"{source}, {section}" if section else source)


def _value(name: str, value: float | None, n: int, source: str) -> Claim:
    return Claim(name, value, "none", None, "reported", source, n, origin="none")
