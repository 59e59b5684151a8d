"""The copies of a model that one program computes at once."""

from __future__ import annotations

import dataclasses as dc
import math
from typing import Literal

from deodar.model.document import Leaf

Divided = Literal["points", "trials"]
"""The copies that several devices divide among themselves: points of a sweep, or trials."""


@dc.dataclass(frozen=True)
class Batch:
    """The copies of a model that run at once.

    Attributes:
        points: number of points of a sweep; None without a sweep.
        trials: number of trials; None without such an axis.
        sweep: the leaves that differ between points, for each entry of the sweep.
        begun: number of copies with which a batch began that has fewer now; 0: those that it has. The
            operations are those of that number, so that the state of the larger batch fits.
        restarts: each copy begins at a tick of its own, a multiple of this number, from which its time and
            its noise count (`BEGUN` of the keys); 0: all copies begin together.
        own_noise: whether each point has trial numbers of its own: (points, trials) instead of (trials).
    """

    points: int | None = None
    trials: int | None = None
    sweep: tuple[tuple[Leaf, ...], ...] = ()
    begun: int = 0
    restarts: int = 0
    own_noise: bool = False

    @property
    def numbered(self) -> tuple[int, ...]:
        """The shape of the trial numbers."""
        return (self.points or 1, self.trials or 1) if self.own_noise else (self.trials or 1,)

    @property
    def shape(self) -> tuple[int, ...]:
        """The leading axes of batched arrays."""
        return tuple(n for n in (self.points, self.trials) if n is not None)

    @property
    def size(self) -> int:
        """The number of copies."""
        return math.prod(self.shape)

    def share(self, along: Divided, parts: int) -> Batch:
        """Return one of several equal parts along the points or the trials."""
        if along == "points":
            return dc.replace(self, points=(self.points or 1) // parts)
        return dc.replace(self, trials=(self.trials or 1) // parts)

    @property
    def planned(self) -> int:
        """The number of copies for which operations are chosen."""
        return self.begun or self.size
