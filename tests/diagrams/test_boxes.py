"""The glyphs of boxes."""

from __future__ import annotations

import pytest

from deodar.diagrams import boxes


def test_a_peak_is_symmetric_and_highest_over_the_middle_of_its_base() -> None:
    start, rise, fall = ([float(v) for v in numbers] for _, *numbers in boxes._bump(10, 50, 20, 15))
    assert (start, rise[-2:], fall[-2:]) == ([10, 50], [20, 35], [30, 50])
    mirrored = [v for x, y in ((rise[2], rise[3]), (rise[0], rise[1])) for v in (40 - x, y)]
    assert fall[:4] == pytest.approx(mirrored)
