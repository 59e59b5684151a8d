"""An arena named on the command line, with its settings."""

from __future__ import annotations

import dataclasses as dc

import numpy as np
import pytest

from deodar.errors import WorldError
from deodar.worlds._settings import parse_argument
from deodar.worlds.arena.arena import Arena
from deodar.worlds.arena.arena_settings import ArenaNoise, ArenaPhysics
from deodar.worlds.arena.khepera import KHEPERA


def test_an_argument_may_name_only_the_layout():
    assert parse_argument(Arena, "z") == ("z", {})


def test_settings_of_the_argument_are_passed_to_the_arena():
    arena = Arena.open(
        "z, unit=cm, start=-45 55 1.5, goal=-65 65, place_noise=0.5, place_every=2, contact=stick"
    )
    reopened = Arena(
        "z",
        (-45, 55, 1.5),
        (-65, 65),
        "cm",
        physics=ArenaPhysics(place_every=2, contact="stick"),
        noise=ArenaNoise(place_noise=0.5),
    )
    assert arena.describe()["settings"] == reopened.describe()["settings"]
    np.testing.assert_array_equal(arena.starts, reopened.starts)
    np.testing.assert_array_equal(arena.goals, reopened.goals)


def test_a_start_without_a_heading_faces_along_x():
    assert Arena.open("z, unit=cm, start=-45 55").starts[0, 2] == 0


def test_a_vehicle_is_chosen_by_its_name():
    arena = Arena.open("blocks, unit=cm, vehicle=khepera")
    assert arena.vehicle == Arena(vehicle="khepera").vehicle != Arena().vehicle
    assert arena.sensors["infrared"].shape == (6,) and arena.sensors["infrared"].unit == "mm"
    assert Arena.again(arena.describe()).vehicle == arena.vehicle


def test_an_arena_with_a_vehicle_of_your_own_is_not_opened_again():
    arena = Arena(vehicle=dc.replace(KHEPERA, radius=0.03))
    with pytest.raises(WorldError, match="custom vehicle"):
        Arena.again(arena.describe())


@pytest.mark.parametrize(
    ("argument", "message"),
    [
        ("z, gaol=1 2", "no setting 'gaol'. Did you mean 'goal'"),
        ("z, goal", "no setting 'goal'"),
        ("z, goal=1", r"goal: is \[1\.0\]; expected 2 finite numbers"),
        ("z, start=1 2 3 4", r"start: is \[1\.0, 2\.0, 3\.0, 4\.0\]; expected 3 finite numbers"),
        ("z, slip=much", "slip is 'much'; expected a number"),
        ("z, place_noise=-1", "place_noise is -1"),
        ("z, vehicle=kephera", "no vehicle 'kephera'. Did you mean 'khepera'"),
        ("z, unit=mile", "unit is 'mile'"),
    ],
)
def test_invalid_arguments_are_reported(argument, message):
    with pytest.raises(WorldError, match=message):
        Arena.open(argument)
