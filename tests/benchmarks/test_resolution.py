"""Thresholds and positions of a memory, on a grid of 5 samples per kernel width, against a finer grid and
against theory.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import deodar as dd
from deodar.numerics.sigmoids import Step

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import resolution


def test_the_forgetting_threshold_of_the_logistic_is_that_of_a_finer_grid() -> None:
    g = dd.Logistic(4.0)
    fine = resolution.forgetting(1, 401, g, "point")
    assert abs(resolution.forgetting(1, 101, g, "cell") / fine - 1) < 0.005
    assert abs(resolution.forgetting(1, 51, g, "cell") / fine - 1) < 0.02
    assert abs(resolution.forgetting(1, 101, g, "point") / fine - 1) > 0.04, (
        "the sum over points has no error to correct"
    )


def test_the_forgetting_threshold_of_the_step_is_that_of_amari() -> None:
    assert abs(resolution.forgetting(1, 101, Step(), "cell") / resolution.amari() - 1) < 0.01
    assert abs(resolution.forgetting(1, 51, Step(), "cell") / resolution.amari() - 1) < 0.02
    assert abs(resolution.forgetting(1, 101, Step(), "point") / resolution.amari() - 1) > 0.5, (
        "the sum over points has no error to correct"
    )


@pytest.mark.parametrize(("dimensions", "samples"), [(1, 101), (2, 61)])
def test_a_memory_keeps_its_position(dimensions: int, samples: int) -> None:
    assert resolution.motion(dimensions, samples, dd.Logistic(4.0), "cell") < 0.1
    assert resolution.motion(dimensions, samples, dd.Logistic(4.0), "point") > 0.1, (
        "memories do not stick to the grid"
    )
