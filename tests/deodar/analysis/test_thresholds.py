"""Thresholds where a peak never appears, or always exists."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.analysis.isolated import isolate
from deodar.analysis.thresholds import thresholds


def node(resting_level: float, excitation: float = 3.0) -> dd.Field:
    kernel = [dd.Gaussian(excitation)]
    return dd.Field("n", [], tau=10, resting_level=resting_level, sigmoid=dd.Logistic(4), kernel=kernel)


def test_a_node_that_no_searched_input_activates_has_no_threshold(monkeypatch: pytest.MonkeyPatch) -> None:
    """It inhibits itself, so an input as large as the distance of its resting level is too small."""
    monkeypatch.setitem(thresholds.__globals__, "MOST_DOUBLINGS", 0)
    measured = thresholds(isolate(node(-4, excitation=-3)))
    assert (measured.detection, measured.reverse, measured.active_at_rest, measured.searched) == (
        None,
        None,
        False,
        4.0,
    )


def test_a_node_that_is_active_without_input_has_no_threshold() -> None:
    measured = thresholds(isolate(node(2)))
    assert (measured.detection, measured.reverse, measured.active_at_rest, measured.searched) == (
        None,
        None,
        True,
        0.0,
    )
