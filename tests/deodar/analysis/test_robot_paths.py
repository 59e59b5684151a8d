"""Lengths, entries and distances of paths with known values."""

from __future__ import annotations

import numpy as np
import pytest

from deodar.analysis import robot_paths
from deodar.errors import AnalysisError

SQUARE = [(0, 0), (3, 0), (3, 4)]


def test_the_length_is_the_sum_of_the_pieces():
    assert robot_paths.path_length(SQUARE) == 7.0
    assert robot_paths.path_length([(1, 1)]) == 0.0
    assert robot_paths.path_length([(0, 0, 0.1), (3, 4, 0.9)]) == 5.0  # a heading does not count


def test_a_path_ends_where_it_enters_the_disc():
    cut = robot_paths.path_until(SQUARE, (3, 4), 1.5)
    np.testing.assert_allclose(cut, [(0, 0), (3, 0), (3, 2.5)])
    assert robot_paths.path_length(cut) == pytest.approx(5.5)


def test_a_path_outside_of_the_disc_has_no_end_and_one_that_starts_inside_no_divergence():
    assert robot_paths.path_until(SQUARE, (10, 10), 1.0) is None
    assert len(robot_paths.path_until(SQUARE, (0, 0), 1.0)) == 1
    assert robot_paths.path_divergence(SQUARE, SQUARE, (10, 10), 1.0) is None
    assert robot_paths.path_divergence(SQUARE, SQUARE, (0, 0), 1.0) is None


def test_both_lengths_end_at_the_same_radius():
    # the detour is 7 long, the straight line 5; a radius of 1 takes 1 from each
    assert robot_paths.path_divergence(SQUARE, [(0, 0), (3, 4)], (3, 4), 1.0) == pytest.approx(6 / 4)


def test_a_segment_that_crosses_the_disc_without_a_point_inside_does_not_enter_it():
    assert robot_paths.path_until([(-5, 0), (5, 0)], (0, 0), 1.0) is None


def test_clearance_is_the_distance_to_the_nearest_obstacle():
    boxes, border = [(2, 2, 4, 4)], (0, 0, 10, 10)
    got = robot_paths.clearance([(1, 3), (7, 8), (3, 3), (12, 5), (5, 5)], boxes, border)
    np.testing.assert_allclose(got, [1, 2, 0, 0, np.sqrt(2)])


def test_speeds_are_distances_over_durations():
    np.testing.assert_allclose(robot_paths.speeds([(0, 0), (1, 0), (3, 0)], [0, 2, 4]), [0.5, 1.0])
    np.testing.assert_allclose(robot_paths.speeds([(0, 0), (1, 0), (3, 0)], [0, 2, 4], over=2), [0.75])


@pytest.mark.parametrize("bad", [[], [(1,)], [(1, np.nan)], 3.0])
def test_a_value_that_is_not_a_path_is_refused(bad):
    with pytest.raises(AnalysisError, match="a path is rows of x and y"):
        robot_paths.path_length(bad)
