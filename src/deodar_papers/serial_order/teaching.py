"""Teaching: a block of each colour of a sequence is shown to the camera, one after another."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

FIRST = 1000.0
"""Time before the first block is shown, ms."""

SHORTEST, LONGEST = 1.0, 30.0
"""Range of the time for which a block is shown, s; its logarithm is drawn uniformly."""

PAUSE = 1.0, 4.0
"""Range of the pause after a block, s."""

ENTERS = 0.3, 1000.0
"""Share of its time, and most ms, for which a block is shown at the side, before it comes to the middle.

A block that appears in the middle satisfies the condition of satisfaction before its colour is learned.
"""

ASIDE, NEAR = (100.0, 60.0), (60.0, 85.0)
"""Distance ahead and to the side of the near face of a block that enters, and range of the distance ahead of
one in the middle, mm.
"""

LATERAL = 8.0
"""Largest deviation of a block from the middle, mm."""

BRIEF, BREAK = 2000.0, 1000.0
"""Time for which a block is shown in a brief lesson, and the pause after it, ms."""


@dataclass(frozen=True)
class Showing:
    """One block that is shown.

    Attributes:
        letter: its colour.
        begins, centred, ends: times at which it is shown at the side, in the middle, and taken away, ms.
        aside, ahead, lateral: distance to the left while it is at the side; distance of its near face while
            it is in the middle, and deviation from the middle, mm.
    """

    letter: str
    begins: float
    centred: float
    ends: float
    aside: float
    ahead: float
    lateral: float

    def later(self, by: float) -> Showing:
        """Return the same block, shown later by a time in ms."""
        return replace(self, begins=self.begins + by, centred=self.centred + by, ends=self.ends + by)


def lesson(sequence: str, seed: int, longest: float = LONGEST) -> tuple[tuple[Showing, ...], float]:
    """Draw a lesson: the showings of a sequence, and the time at which it ends, ms.

    Args:
        sequence: letters of the colours.
        seed: seed of the draw.
        longest: longest time for which a block is shown, s.
    """
    rng = np.random.default_rng((seed, 1))
    now, out = FIRST, list[Showing]()
    for letter in sequence:
        shown = 1000.0 * float(np.exp(rng.uniform(np.log(SHORTEST), np.log(longest))))
        enters = min(ENTERS[0] * shown, ENTERS[1])
        side = float(rng.choice([-1.0, 1.0]))
        ahead, lateral = float(rng.uniform(*NEAR)), float(rng.uniform(-LATERAL, LATERAL))
        out.append(Showing(letter, now, now + enters, now + shown, side * ASIDE[1], ahead, lateral))
        now += shown + 1000.0 * float(rng.uniform(*PAUSE))
    return tuple(out), now


def brief_lesson(sequence: str) -> tuple[tuple[Showing, ...], float]:
    """Return a lesson without randomness: each block is shown for `BRIEF` ms, and the time at which it ends,
    ms.
    """
    begins = [FIRST + (BRIEF + BREAK) * k for k in range(len(sequence) + 1)]
    enters, ahead = min(ENTERS[0] * BRIEF, ENTERS[1]), sum(NEAR) / 2
    showings = (
        Showing(letter, now, now + enters, now + BRIEF, ASIDE[1] * (-1) ** k, ahead, 0.0)
        for k, (letter, now) in enumerate(zip(sequence, begins, strict=False))
    )
    return tuple(showings), begins[-1]
