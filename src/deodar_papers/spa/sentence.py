"""Sentence that the runs test: its text, its target and its assumptions; the values of the runs make it a
claim.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from deodar.analysis import statistics
from deodar.analysis.claims import Claim, ClaimKind, Origin
from deodar.analysis.statistics import rounded
from deodar.experiments.rows import Row
from deodar.numerics.intervals import Interval
from deodar_papers.spa.condition_runs import SOURCE, count

START = "the start of case 3, which the paper does not print"
PLACES = f"{START}, and its second location, which was read off a run of deodar"
REFLECTION = (
    "walls reflect 0.6 of the infrared light, which was fitted so that the planner passes the gaps of the"
    " large maze"
)

EFFECT = 0.1
"""Smallest difference of two shares of runs that counts (a choice of deodar)."""

ALIKE = 0.05
"""Largest difference of Lp / Lo, or of a ratio of its medians, that counts as equal: 5 % of the shortest
path (a choice of deodar).
"""


@dataclass(frozen=True)
class Sentence:
    """A sentence to test.

    Attributes:
        section: section of the paper; empty: a statement of deodar.
        text: the sentence.
        origin: where the target comes from.
        assumes, inferred, kind: see `Claim`.
        source: where the paper has the sentence, if not in the section.
    """

    section: str
    text: str
    origin: Origin = "ours"
    assumes: str = ""
    inferred: bool = False
    kind: ClaimKind = "reported"
    source: str = ""

    def judged(
        self, value: float | None, target: str, holds: bool | None, n: int, interval: Interval | None = None
    ) -> Claim:
        """Return the claim, with a decision that was made elsewhere."""
        name = f"{self.section}: {self.text}" if self.section and self.kind == "reported" else self.text
        own = f"{SOURCE}, section {self.section}" if self.section else "no sentence of the paper"
        shown = None if value is None else round(float(value), 4)
        marks = (self.kind, self.source or own, n, rounded(interval))
        return Claim(
            name,
            shown,
            target,
            holds,
            *marks,
            origin=self.origin,
            assumes=self.assumes,
            inferred=self.inferred,
        )

    def value(self, value: float | None, n: int) -> Claim:
        """Return a claim on a number without a target."""
        return Sentence(self.section, self.text, "none", self.assumes, source=self.source).judged(
            value, "none", None, n
        )

    def bounds(
        self,
        value: float | None,
        n: int,
        within: tuple[float, float],
        target: str,
        interval: Interval | None = None,
        quick: bool = False,
    ) -> Claim:
        """Return a claim that a number lies between two bounds; undecided if the runs are too few."""
        return self.judged(value, target, statistics.decided(value, interval, n, *within, quick), n, interval)

    def median(self, values: np.ndarray, low: float, high: float, target: str, quick: bool = False) -> Claim:
        """Return a claim that a median lies between two bounds."""
        value = float(np.median(values)) if len(values) else None
        return self.bounds(value, len(values), (low, high), target, statistics.median_interval(values), quick)

    def share(self, rows: Sequence[Row], true: Callable[[Row], bool], least: float, quick: bool) -> Claim:
        """Return a claim that at least a share of the runs have a property."""
        hits, n = count(rows, true)
        return self.bounds(
            hits / n if n else None, n, (least, 1.0), f">= {least:g}", statistics.wilson(hits, n), quick
        )

    def larger(
        self, value: float | None, interval: Interval | None, n: int, than: float = 0.0, by: float = EFFECT
    ) -> Claim:
        """Return a claim that a number is larger than another by an amount that counts."""
        return self.judged(
            value,
            f">= {than + by:g}, interval above {than:g}",
            statistics.larger(value, interval, than, by),
            n,
            interval,
        )

    def smaller(
        self, value: float | None, interval: Interval | None, n: int, than: float = 1.0, by: float = ALIKE
    ) -> Claim:
        """Return a claim that a number is smaller than another by an amount that counts."""
        return self.judged(
            value,
            f"<= {than - by:g}, interval below {than:g}",
            statistics.smaller(value, interval, than, by),
            n,
            interval,
        )

    def more_often(self, first: tuple[int, int], second: tuple[int, int], by: float = EFFECT) -> Claim:
        """Return a claim that more runs (hits, n) of the first kind than of the second have a property."""
        value, interval = statistics.share_difference(first, second)
        return self.larger(value, interval, min(first[1], second[1]), 0.0, by)

    def as_often(self, first: tuple[int, int], second: tuple[int, int]) -> Claim:
        """Return a claim that an equal share of the runs (hits, n) of both kinds have a property."""
        value, interval = statistics.share_difference(first, second)
        return self.equal(value, interval, min(first[1], second[1]), -EFFECT, EFFECT)

    def equal(self, value: float | None, interval: Interval | None, n: int, low: float, high: float) -> Claim:
        """Return a claim that the interval of a difference or ratio lies inside a margin."""
        return self.judged(
            value,
            f"interval inside {low:g} to {high:g}",
            statistics.equivalent(interval, low, high),
            n,
            interval,
        )
