"""The demonstration: one run of learning, with tests of the map before, in between and after."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from deodar.analysis import statistics
from deodar.analysis.claims import Claim
from deodar.analysis.statistics import rounded
from deodar.architectures.looking import SAMPLES, looking
from deodar.model.model import Model
from deodar_papers.looking.gazes import NEAR, Learned, learn, observed, summary, test
from deodar_papers.looking.targets import SOURCE
from deodar_robots.eye.eye import PAN_TILT, Eye

TESTS = 100
"""Single gazes that test a map."""

GAZES = 1000
"""Gazes of the demonstration; from this number on the correcting mechanism is held to `LEARNED`."""

BEFORE, LEARNED = 0.2, 0.8
"""Largest share of near gazes before learning, and least share after `GAZES` gazes (choices of deodar)."""

SHARES = (0.25, 0.5, 1.0)
"""When the map is tested, as shares of the gazes."""


@dataclass
class Looked:
    """The run of the demonstration.

    Attributes:
        mechanism: mechanism of learning.
        seed: seed of the run.
        marks: numbers of gazes after which the map was tested, from 0.
        errors: distances of the target after the gazes of each test, pixels.
        learned: the run.
    """

    mechanism: str
    seed: int
    marks: tuple[int, ...]
    errors: Sequence[np.ndarray]
    learned: Learned

    @property
    def near(self) -> list[float]:
        """Share of near gazes in each test."""
        return [summary(errors)["near"] / len(errors) for errors in self.errors]

    def model(self) -> Model:
        """Return the architecture with the learned map."""
        return looking(self.mechanism, seed=self.seed, weights=self.learned.maps[self.marks[-1]])


def run(
    mechanism: str = "correcting",
    gazes: int = GAZES,
    seed: int = 0,
    show: Callable[[str, float], None] = lambda words, share: None,
) -> Looked:
    """Learn with one seed.

    Args:
        mechanism: `correcting` or `paper`.
        gazes: number of gazes.
        seed: seed of all noise, and of the map at the start.
        show: called with the present task and the completed share.
    """
    marks = tuple(sorted({max(1, round(share * gazes)) for share in SHARES}))
    show("learning", 0.02)
    model = observed(mechanism, seed=seed)
    start = learn(model, Eye(), seed, (0,)).maps[0]

    def told(done: int) -> None:
        show(f"{done} gazes", 0.85 * min(1.0, done / gazes))

    learned = learn(model, Eye(), seed, marks, told)
    maps = {0: start, **learned.maps}
    errors: list[np.ndarray] = []
    for k, mark in enumerate(maps):
        show(f"testing the map after {mark} gazes", 0.85 + 0.15 * k / len(maps))
        errors.append(test(mechanism, maps[mark], seed, TESTS, PAN_TILT, SAMPLES))
    return Looked(mechanism, seed, tuple(maps), errors, learned)


def claims(result: Looked) -> list[Claim]:
    """Return the claims on the first and the last test."""
    out: list[Claim] = []
    decides = result.mechanism == "correcting" and result.marks[-1] >= GAZES
    for k, mark in ((0, result.marks[0]), (-1, result.marks[-1])):
        near, n = result.near[k], len(result.errors[k])
        interval = rounded(statistics.wilson(round(near * n), n))
        text = f"{result.mechanism}: share of gazes within {NEAR:g} pixels after {mark} gazes"
        if k == 0:
            target, holds = f"<= {BEFORE:g}", near <= BEFORE
            out.append(Claim(text, near, target, holds, "required", SOURCE, n, interval, origin="ours"))
        elif decides:
            target, holds = f">= {LEARNED:g}", near >= LEARNED
            out.append(Claim(text, near, target, holds, "required", SOURCE, n, interval, origin="ours"))
        else:
            out.append(Claim(text, near, "none", None, "reported", SOURCE, n, interval, origin="none"))
    return out


def sentence(result: Looked) -> str:
    """Return the outcome in one line of plain words."""
    tests = [f"{100 * s:.0f} % after {m}" for m, s in zip(result.marks, result.near, strict=True)]
    return f"Gazes that end within {NEAR:g} pixels of the target: {', '.join(tests)} gazes of learning."
