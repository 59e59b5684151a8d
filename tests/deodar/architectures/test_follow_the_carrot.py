"""Following a carrot: the steering against known values, and whole batches in the arena of the
architectures.
"""

from __future__ import annotations

import numpy as np
import pytest

from deodar.analysis.robot_paths import arena_grid, clearance, path_until, shortest_path
from deodar.architectures.follow_the_carrot import Carrot, Ending, follow
from deodar.errors import ParameterError
from deodar.worlds._settings import arguments
from deodar.worlds.arena.arena import Arena

BEND = {
    "unit": "cm",
    "arena": {"x": [0, 60], "y": [0, 60]},
    "walls": [{"name": "bar", "center": [20, 30], "size": [40, 4]}],
}
START, GOAL = [(10, 10, 0), (10, 15, 2.0)], [(10, 50), (15, 45)]


def arena(**options):
    return Arena(BEND, START, GOAL, "cm", **arguments(Arena, options))


def planned():
    boxes = [(0, 28, 40, 32)]
    on = arena_grid(boxes, (0, 0, 60, 60))
    return [shortest_path(on, s[:2], g) for s, g in zip(START, GOAL, strict=True)]


def test_the_vehicle_turns_towards_the_carrot():
    paths = np.asarray([[(0.0, 0), (0, 1), (0, 5)], [(1.0, 0), (2, 0), (3, 0)], [(0.0, 0), (0, 0), (0, 0)]])
    wheels = Carrot(speed=300, gain=100).wheels(np.zeros((3, 2)), np.asarray([np.pi / 2, 0.3, 0.0]), paths)
    np.testing.assert_allclose(wheels[0], [300, 300])  # straight ahead
    np.testing.assert_allclose(wheels[1], [300 + 15, 300 - 15])  # 0.3 rad to the right
    np.testing.assert_allclose(wheels[2], [300, 300])  # it is at its carrot


def test_the_vehicle_takes_the_shorter_turn():
    paths = np.asarray([[(-1.0, -0.2), (-1, -0.2)]])
    left, right = Carrot(gain=100).wheels(np.zeros((1, 2)), np.asarray([3.0]), paths)[0]
    assert right > left and right - left == pytest.approx(100 * (2 * np.pi - 3.0 - np.arctan2(0.2, -1)))


def test_the_carrot_is_the_nearest_point_ahead_on_the_path():
    line = np.asarray([[(0.0, 0), (1, 0.5), (1, -3)]])
    assert np.diff(Carrot(ahead=1.0).wheels(np.zeros((1, 2)), np.zeros(1), line)[0]) > 0
    assert np.diff(Carrot(ahead=3.0).wheels(np.zeros((1, 2)), np.asarray([-np.pi / 2]), line)[0]) > 0


@pytest.mark.parametrize("contact", ["slide", "stick"])
def test_the_vehicle_reaches_goals_behind_a_wall(contact):
    world = arena(contact=contact, place_noise=0.5, place_every=2)
    paths = planned()
    done = follow(world, paths, [0, 1], ending=Ending(limit=900))
    assert (done.steps < 900).all() and done.pose.shape == (done.steps.max() + 1, 2, 3)
    for k in range(2):
        course = done.pose[: done.steps[k] + 1, k]
        assert np.hypot(*(course[-1, :2] - GOAL[k])) < 7 and path_until(course, GOAL[k], 7.0) is not None
        assert clearance(course[:, :2], [(0, 28, 40, 32)], (0, 0, 60, 60)).min() > 3.69


def test_noise_is_keyed_by_the_trial():
    paths = planned()
    together = follow(arena(place_noise=1.0), paths, [0, 1], ending=Ending(limit=60))
    alone = follow(arena(place_noise=1.0), paths[1:], [1], ending=Ending(limit=60))
    np.testing.assert_allclose(together.pose[:, 1], alone.pose[:, 0], atol=1e-4)


def test_a_run_stops_at_the_limit_of_steps():
    done = follow(arena(), planned(), [0, 1], ending=Ending(limit=5))
    assert (done.steps == 5).all() and len(done.pose) == 6


def test_parameters_out_of_range_are_refused():
    with pytest.raises(ParameterError, match="above 0"):
        Carrot(speed=0)
    assert Carrot(speed=0.5, gain=0.5, ahead=0) == Carrot(0.5, 0.5, 0)


def test_lengths_for_cm_are_refused_in_an_arena_in_m():
    world = Arena(BEND, (0.1, 0.1, 0), (0.1, 0.5))
    with pytest.raises(ParameterError, match=r"ending.radius: is 7 m, longer than the arena, 0.6 x 0.6 m"):
        follow(world, [[(0.1, 0.1), (0.1, 0.5)]], [0])
