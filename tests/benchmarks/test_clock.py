"""A short form of the benchmark of the clock: its four runs agree with their names."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import clock


def test_overruns_occur_only_in_runs_with_too_little_time() -> None:
    """Only bounds that also hold on a busy machine: a run may be late, and is never early."""
    plain, slow, stays, grows = clock.measure(1.2).values()
    assert plain.steps == 1200 and slow.steps == 20 and slow.factor < 0.13 and plain.factor < 1.3
    for meter in (plain, slow):
        assert meter.lengthened == 0
    assert stays.lengthened == 0 and stays.step == 1 and stays.drift > 20 and stays.overruns >= 1
    assert grows.lengthened > 0 and 1 < grows.step <= clock.LONGEST
