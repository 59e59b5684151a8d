"""Design: the conditions, and the runs of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from deodar.codec import JsonObject
from deodar_papers.serial_order.arenas import SearchArena, random_arena, ring
from deodar_papers.serial_order.colours import (
    CLUTTERED,
    FIVE,
    PAPER,
    TEN,
    random_pairs,
    random_sequences,
)
from deodar_papers.serial_order.parameters import PARAMETERS
from deodar_papers.serial_order.teaching import LONGEST, Showing, lesson

Ground = Literal["none", "arena", "ring"]

LIMIT = 600.0
"""Longest production, s."""

BRIEF = 5.0
"""Longest showing of a block in conditions that do not test its duration, s."""

CLUTTER = 0.25
"""Share of the background rows of the picture that random colours cover while `GYB` is learned."""

RING = ("RBGBY", "RGGY", "GYB", "VVRY")
RING_LIMIT = 45.0

BACK = 60.0
"""Time for which a block is taken away, s."""

CARRIED = 500.0
"""Time after the second node became active at which the vehicle is carried elsewhere, ms."""

WITHHELD = 0.2
"""Time within which a block is found in a picture that was taken before the block was, s."""

STEPS = {"-20": 0.8, "+20": 1.2}


@dataclass(frozen=True)
class SearchCondition:
    """A condition: runs that differ in their sequences, lessons, arenas and noise.

    Attributes:
        name: keys of rows begin with it.
        sequences: run k has sequence k modulo their number.
        count: number of runs.
        body: `none` (learning only, after which the weights are read), `arena` or `ring`.
        longest: longest showing of a block, s.
        duplicates: blocks whose colour another wanted block has, too; None: 0 or 1.
        clutter: share of the background rows that random colours cover.
        look_around, habituation: as in `color_search`.
        event: `removed`: the second block is taken away when the vehicle begins to look for it; `carried`:
            the vehicle is carried elsewhere while it does; empty: neither.
        limit: longest production, s.
        varied, factor: a parameter of table B.1, and its factor.
    """

    name: str
    sequences: tuple[str, ...]
    count: int
    body: Ground = "arena"
    longest: float = BRIEF
    duplicates: int | None = None
    clutter: float = 0.0
    look_around: bool = True
    habituation: bool = False
    event: Literal["", "removed", "carried"] = ""
    limit: float = LIMIT
    varied: str = ""
    factor: float = 1.0

    def sequence(self, k: int) -> str:
        """Return the sequence of run k."""
        return self.sequences[k % len(self.sequences)]

    def key(self, k: int) -> str:
        """Return the key of the row of run k."""
        return f"{self.name}/{k}"

    def arena(self, k: int) -> SearchArena:
        """Return the arena of run k."""
        if self.body == "ring":
            return ring()
        duplicates = k % 2 if self.duplicates is None else self.duplicates
        colours = tuple(TEN) if self.sequence(k)[0] in TEN else tuple(FIVE)
        return random_arena(self.wanted(k), (sum(map(ord, self.name)), k), duplicates, colours)

    def wanted(self, k: int) -> str:
        """Return the colours of which run k has a block."""
        return self.sequence(k)

    def settings(self) -> JsonObject:
        """Return the settings of the condition, as plain data."""
        return {**vars(self), "sequences": list(self.sequences)}


@dataclass(frozen=True)
class CuedCondition(SearchCondition):
    """A condition in which each run is taught two sequences, one after another, each with its own cue.

    Odd runs are produced with the second cue.

    Attributes:
        pairs: run k is taught pair k modulo their number; `sequences` is empty.
        changed: whether the other cue is given while the vehicle looks for the second item (in the first two
            runs of four) or the third one.
    """

    pairs: tuple[tuple[str, str], ...] = ()
    changed: bool = False

    def pair(self, k: int) -> tuple[str, str]:
        """Return both sequences of run k, in the order in which they are taught."""
        return self.pairs[k % len(self.pairs)]

    def cue(self, k: int) -> int:
        """Return the cue with which the production of run k begins."""
        return 1 + k % 2

    def position(self, k: int) -> int:
        """Return the position of run k at which the other cue is given; 0: never."""
        return 2 + k // 2 % 2 if self.changed else 0

    def sequence(self, k: int) -> str:
        """Return the sequence that run k is to produce."""
        pair, cue = self.pair(k), self.cue(k)
        return mixed(pair[cue - 1], pair[2 - cue], self.position(k)) if self.changed else pair[cue - 1]

    def wanted(self, k: int) -> str:
        return "".join(self.pair(k))

    def settings(self) -> JsonObject:
        return {**super().settings(), "pairs": [list(pair) for pair in self.pairs]}


def mixed(begun: str, cued: str, position: int) -> str:
    """Return what is produced if the cue of another sequence is given at a position: the order continues."""
    return begun[: position - 1] + cued[position - 1 :]


def conditions(quick: bool) -> dict[str, SearchCondition]:
    """Return all conditions by name, those of the paper first."""
    twenty = random_sequences()
    every = (*PAPER, *twenty)
    clear = tuple(s for s in every if s != CLUTTERED)
    listed = [
        SearchCondition("ring", RING, 4 if quick else 20, "ring", limit=RING_LIMIT),
        SearchCondition("learning", clear, 23 if quick else 13 * 23, "none", LONGEST),
        SearchCondition("clutter", (CLUTTERED,), 4 if quick else 13, "none", LONGEST, clutter=CLUTTER),
        SearchCondition("arena", every, 16 if quick else 5 * 24),
        SearchCondition("duplicates", every, 4 if quick else 52, duplicates=3),
        SearchCondition("removed", changing(every), 4 if quick else 60, duplicates=0, event="removed"),
        SearchCondition("habituation", ("RGGY",), 4 if quick else 24, habituation=True),
        SearchCondition("repetition", ("RGGY",), 4 if quick else 24),
        SearchCondition("wander", PAPER, 4 if quick else 52, look_around=False),
        SearchCondition("carried", changing(every), 4 if quick else 60, duplicates=0, event="carried"),
        SearchCondition("ten", ten_sequences(), 2 if quick else 50),
        CuedCondition("cued", (), 4 if quick else 50, pairs=random_pairs(True)),
        CuedCondition("cued-changed", (), 4 if quick else 50, pairs=random_pairs(False), changed=True),
    ]
    if not quick:
        simplest = listed[0]
        for parameter in PARAMETERS:
            for sign, factor in STEPS.items():
                name = f"vary/{parameter}/{sign}"
                listed.append(replace(simplest, name=name, varied=parameter, factor=factor))
    return {c.name: c for c in listed}


def changing(sequences: Sequence[str]) -> tuple[str, ...]:
    """Return the sequences whose second colour is not the first one, which would still be in view."""
    return tuple(s for s in sequences if s[0] != s[1])


def ten_sequences() -> tuple[str, ...]:
    """Draw ten sequences of all ten hues, each in an order of its own."""
    rng = np.random.default_rng(10)
    return tuple("".join(rng.permutation(list(TEN))) for _ in range(10))


def design(quick: bool) -> JsonObject:
    """Return the design as plain data."""
    return {"runs": {name: c.settings() for name, c in conditions(quick).items()}}


def taught(c: SearchCondition, k: int) -> tuple[Sequence[Showing], float]:
    """Return the lesson of run k, and its duration in ms; that of both sequences, if it has two."""
    if isinstance(c, CuedCondition):
        first, second = c.pair(k)
        showings, begins = lesson(first, k, c.longest)
        later, lasts = lesson(second, c.count + k, c.longest)
        return (*showings, *(s.later(begins) for s in later)), begins + lasts
    return lesson(c.sequence(k), k, c.longest)


def second_begins(c: CuedCondition, k: int) -> float:
    """Return the time at which the lesson of the second sequence of run k begins, ms."""
    return lesson(c.pair(k)[0], k, c.longest)[1]
