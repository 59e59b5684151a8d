"""Routes, obstacles placed on the robot, and standstill, on constructed paths."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from deodar.architectures.spa import place
from deodar_papers.spa.route import covered, route, stillness


def through(*cells):
    """Return a path of steps of 0.25 cm through rows and columns of the published fields."""
    corners = np.asarray([place(*c) for c in cells])
    pieces = [
        np.linspace(a, b, int(np.linalg.norm(b - a) / 0.25) + 1) for a, b in itertools.pairwise(corners)
    ]
    return np.concatenate(pieces)


@pytest.mark.parametrize(
    ("cells", "way"),
    [
        ([(50, 60), (15, 57), (15, 30), (40, 40)], "north"),
        ([(50, 60), (80, 60), (80, 30), (40, 40)], "south"),
        ([(50, 60), (15, 57), (80, 60), (80, 30), (40, 40)], "switch"),
        ([(50, 60), (40, 60), (45, 60)], "none"),
        ([(50, 60), (52, 60), (15, 57), (15, 30), (40, 40)], "north"),
    ],
)
def test_a_route_follows_from_its_rows(cells, way):
    assert route(through(*cells)) == way


def test_an_obstacle_that_appears_on_the_robot_is_detected():
    path = through((15, 60), (15, 20))
    assert covered(path, "full") and covered(path, "partial") and covered(path, "narrative")
    assert not covered(path[:20], "full")
    # the partial obstacle leaves a passage of 10 cm free
    assert not covered(through((10, 60), (10, 20)), "partial") and covered(
        through((13, 60), (13, 20)), "partial"
    )
    assert not covered(path[:0], "full")


def test_time_without_motion_is_counted_in_steps():
    path = through((50, 60), (15, 60))
    waits = np.concatenate([path[:60], np.repeat(path[60:61], 80, axis=0), path[60:]])
    assert stillness(path) == 0 and abs(stillness(waits) - 80) <= 6
    assert stillness(path[:3]) == 0
