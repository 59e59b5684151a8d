"""A world from above: its scene, and positions that are free."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from deodar.errors import UnknownName, WorldError
from deodar.worlds._scene import Mark, Scene, SceneBody, SceneBox
from deodar.worlds.arena.arena import Arena

GREY = (0.5, 0.5, 0.5)
SCENE = Scene(
    "m",
    (0.0, 0.0, 2.0, 1.0),
    (
        SceneBox("wall", (1.0, 0.8), (0.1, 0.4), GREY, fixed=True),
        SceneBox("crate", (0.3, 0.3), (0.2, 0.2), GREY),
    ),
    (Mark("goal", (1.8, 0.5)),),
    (SceneBody("robot", (1.5, 0.5), 0.0, 0.05),),
)
LAYOUT: dict[str, Any] = {
    "unit": "cm",
    "arena": {"x": [0, 120], "y": [0, 80]},
    "boxes": [{"name": "crate", "center": [30, 40], "size": [10, 20]}],
    "start": [90, 40],
    "goal": [110, 40],
}


def refusal(name: str, center: Any, size: Any) -> str:
    """Return the error of a position, "" if it fits."""
    try:
        SCENE.require_room(name, center, size)
    except WorldError as error:
        return str(error)
    return ""


def test_positions_that_fit_are_accepted() -> None:
    assert refusal("crate", (0.31, 0.3), (0.2, 0.2)) == ""
    assert refusal("new", (1.5, 0.2), (0.1, 0.1)) == ""
    assert refusal("goal", (1.8, 0.51), None) == ""
    assert refusal("crate", (1.4, 0.5), (0.1, 0.1)) == "", "it touches the robot"


@pytest.mark.parametrize(
    ("name", "center", "size", "message"),
    [
        ("crate", (2.1, 0.5), (0.1, 0.1), r"crate: \(2.1, 0.5\) lies outside the border, 0 to 2, 0 to 1 m"),
        ("goal", (1.0, 0.9), None, "goal: .* lies inside 'wall'"),
        ("crate", (1.0, 0.9), (0.1, 0.1), "crate: .* lies inside 'wall'"),
        ("crate", (1.41, 0.5), (0.1, 0.1), "crate: at .* it would cover 'robot'"),
        ("crate", (1.8, 0.45), (0.2, 0.2), "crate: at .* it would cover 'goal'"),
        ("crate", (float("nan"), 0.5), (0.1, 0.1), "crate.center: .* two finite numbers"),
        ("crate", (0.5, 0.5), (0.1,), "crate.size: .* two finite numbers"),
    ],
)
def test_positions_that_do_not_fit_are_refused_with_the_reason(
    name: str, center: Any, size: Any, message: str
) -> None:
    assert re.search(message, refusal(name, center, size))


def test_a_missing_or_fixed_object_cannot_be_moved() -> None:
    assert SCENE.entry("goal") == SCENE.marks[0] and SCENE.entry("crate") == SCENE.boxes[1]
    with pytest.raises(UnknownName, match=r"'crat'\. Did you mean 'crate'"):
        SCENE.entry("crat")
    with pytest.raises(WorldError, match="wall: cannot be moved by hand"):
        SCENE.entry("wall")


def test_the_scene_of_an_arena_has_its_objects_goal_and_vehicle_in_its_unit() -> None:
    arena = Arena(LAYOUT, unit="cm")
    assert arena.scene().bodies == (), "it has not begun"
    arena.reset(0)
    scene = arena.scene()
    assert scene.unit == "cm" and np.allclose(scene.border, (0, 0, 120, 80))
    assert [b.name for b in scene.boxes] == ["crate"] and np.allclose(
        (*scene.boxes[0].center, *scene.boxes[0].size), (30, 40, 10, 20)
    )
    assert np.allclose(scene.marks[0].center, (110, 40)) and not scene.marks[0].fixed
    assert (
        scene.bodies[0].name == "e-puck"
        and np.allclose(scene.bodies[0].center, (90, 40))
        and scene.bodies[0].radius == pytest.approx(3.7)
    )
    arena.act({"left": np.asarray([500.0]), "right": np.asarray([500.0])}, 0.0)
    assert arena.scene().bodies[0].center[0] > 90.3


def test_a_scene_has_the_present_objects_and_a_body_for_each_copy() -> None:
    arena = Arena(LAYOUT, unit="cm", goal=[(110, 40), (110, 60)])
    arena.place("guest", (60, 20), (5, 5), windows=(64, 128))
    arena.reset(0, [0, 1])
    seen = []
    for k in range(3):
        seen.append([b.name for b in arena.scene().boxes])
        arena.act({}, 64.0 * k)
    assert seen == [["crate"], ["crate", "guest"], ["crate"]]
    assert [b.name for b in arena.scene().bodies] == ["e-puck 0", "e-puck 1"]
    assert [(m.name, m.fixed) for m in arena.scene().marks] == [("goal 0", True), ("goal 1", True)]


def test_the_goal_of_an_arena_moves_by_its_name() -> None:
    arena = Arena(LAYOUT, unit="cm")
    arena.move("goal", (100, 60))
    assert np.allclose(arena.scene().marks[0].center, (100, 60))
    arena.place("goal", (60, 20), (5, 5))
    arena.move("goal", (60, 30))  # an object of that name is removed first
    assert np.allclose(arena.scene().marks[0].center, (100, 60)) and np.allclose(
        arena.scene().boxes[1].center, (60, 30)
    )
