"""What is tuned, before the search."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

import deodar as dd
from deodar.analysis.tuning.request import requested
from deodar.analysis.tuning.requirement import Requirement
from tests.deodar.analysis.maps.test_regime_map import line


def strength(requirements: Sequence[Requirement]) -> float:
    return requested(line(31), ["u.resting_level"], requirements, "", None, {}).strength


def test_inputs_exceed_the_required_threshold_or_else_the_scale_of_the_field() -> None:
    usual = strength([dd.remembers()])
    assert strength([dd.detects(3, within=0.2)]) == pytest.approx(3.6)
    assert strength([dd.remembers(), dd.detects(4, within=0.2)]) == pytest.approx(4.8)
    for at in (0, -1):  # input of such a strength makes no peak
        assert strength([dd.detects(at, within=0.2)]) == usual > 0
