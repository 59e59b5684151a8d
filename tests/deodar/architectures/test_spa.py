"""Simultaneous planning and action in the Z-maze: published results, in short runs."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.architectures.spa import CASE_3, DIRECTIONS, maze, place, spa, space
from deodar.worlds.arena.arena import Arena
from tests.deodar.errors.refused import refused

INTENDED = [f"{name}.strongest.output" for name in DIRECTIONS]
RECORD = (
    "pose.output",
    *INTENDED,
    "west.motivation.activation",
    "occupied.output",
    "goal place.output",
    "own place.output",
)
"""What every test records, so that all of one structure run one program."""


def run(arena: Arena, steps: int, noise: str = "low", seed: int = 0) -> xarray.Dataset:
    return dd.simulate(spa(arena, noise), steps, record=RECORD, world=arena, seed=seed)


@functools.cache
def one_step() -> xarray.Dataset:
    """Return what the model sees at the start of case 3, in a maze without noise."""
    return run(maze("z", noise="none"), 1)


def test_grids_and_starts_are_those_of_the_published_model() -> None:
    x, y = space(maze("z"))
    assert (x.samples, y.samples, x.step, y.step) == (100, 100, 1, 1)
    assert place(100, 1) == (x.lower, y.lower) and place(1, 100) == (x.upper, y.upper)
    large = space(maze("large"))
    assert [a.samples for a in large] == [210, 210] and place(1, 210) == (large[0].upper, large[1].upper)
    assert np.isclose(maze("z").starts[0], [*(v / 100 for v in place(*CASE_3[0])), 0]).all()


def test_the_document_has_one_parameter_per_strength_for_all_four_behaviours(tmp_path: Path) -> None:
    model = spa(maze("z"))
    dd.save(model, tmp_path / "spa.json")
    loaded = dd.load(tmp_path / "spa.json")
    assert loaded.document == model.document and not loaded.check()
    loaded.set("2a precondition to motivation", 4.0)
    assert {loaded.get(f"{name}.precondition to motivation.factor") for name in DIRECTIONS} == {4.0}


def test_the_map_marks_walls_and_margins_as_in_the_published_model() -> None:
    record = one_step()
    occupied = record["occupied.output"].values[-1]
    assert occupied[:5].all() and occupied[-6:].all() and occupied[:, :6].all() and occupied[:, -5:].all(), (
        "the margin"
    )
    x, y = (record[name].values for name in ("x", "y"))
    assert not occupied[np.ix_(np.isin(x, [-45, -65]), np.isin(y, [55, 65]))].any(), (
        "start and goal of case 3"
    )
    assert 0.25 < occupied.mean() < 0.4


def test_arenas_in_metres_and_centimetres_give_equal_inputs() -> None:
    names = ("occupied.output", "goal place.output", "own place.output")
    metres = Arena("z", [v * 0.01 for v in place(*CASE_3[0])] + [0.0], [v * 0.01 for v in place(*CASE_3[1])])
    metric, scaled = one_step(), run(metres, 1)
    for name in names:
        assert metric[name].values.max() >= 1
        np.testing.assert_allclose(scaled[name].values, metric[name].values, atol=1e-3)


def test_in_case_3_the_robot_plans_for_about_210_steps_and_takes_the_north_route() -> None:
    """Section 5.2 and figure 10: the wave passes west of the start near 150, the plan is complete near 210,
    and the robot leaves.
    """
    record = run(maze("z"), 400)
    pose = record["pose.output"].values
    moved = np.linalg.norm(pose[:, :2] - pose[0, :2], axis=1)
    intended = np.max([record[name].values for name in INTENDED], axis=0)
    start = int(np.argmax(moved > 2.5))
    planned = 1 + int(np.flatnonzero(intended[:start] <= 0.5)[-1])
    assert 189 <= planned <= 231 and planned <= start < planned + 40
    second = record["west.motivation.activation"].sel(x=slice(-53, -46), y=90).values.max(axis=1)
    assert 130 <= np.argmax(second > 0) <= 170
    assert pose[-1, 1] > 75, "north of the Z"


@pytest.mark.parametrize("noise", ["low", "high"])
def test_the_robot_reaches_a_nearby_goal(noise: str) -> None:
    """From the east of the maze to a goal 25 cm further north, without a corner between."""
    arena = maze("z", noise, start=(-25.0, 50.0, 2.0), goal=(-27.0, 78.0))
    pose = run(arena, 200, noise, seed=2)["pose.output"].values
    distance = np.linalg.norm(pose[:, :2] - [-27, 78], axis=1)
    assert distance[0] > 25 and distance[-1] < 7
    assert np.linalg.norm(np.diff(pose[:, :2], axis=0), axis=1).max() < 0.5, "it drives, and does not jump"


def test_unknown_mazes_and_levels_of_noise_are_refused() -> None:
    refused(
        lambda: maze("z", noise="lo"),
        dd.errors.ParameterError,
        "no level of noise 'lo'",
        "Did you mean 'low'",
    )
    refused(lambda: maze("y"), dd.errors.WorldError, "no arena")
