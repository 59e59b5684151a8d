"""Each row of the table of docs/safety.md that a failure of a process or a link can reach."""

from __future__ import annotations

import math
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import stops

SLACK = 2.0
"""Delay of a machine that other tests use too, s."""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot stop a process")
@pytest.mark.parametrize("case", stops.CASES)
def test_motors_come_to_rest_in_the_stated_time(case: str) -> None:
    for stop in stops.stops(case, 2 if case == "studio" else 3, 1.0):
        assert max(stop.times) < stop.limit + SLACK, stop


def test_a_motor_that_does_not_stop_or_moves_again_is_found() -> None:
    began = time.monotonic()

    def commands(turns_until: float, turns_again: float) -> list[tuple[float, float]]:
        times = [0.02 * k for k in range(int((time.monotonic() - began) / 0.02))]
        return [(began + t, float(t < turns_until or t >= turns_again)) for t in times]

    assert stops.moved(lambda: commands(math.inf, math.inf), began, seconds=0.2) == math.inf
    assert stops.moved(lambda: commands(0.3, math.inf), began) == pytest.approx(0.3, abs=0.03)
    assert stops.moved(lambda: commands(0.3, 1.5), began, still=2.0) == math.inf
