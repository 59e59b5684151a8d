"""Arenas as files: their content and errors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deodar.errors import WorldError
from deodar.worlds.arena.arena import Arena
from deodar.worlds.arena.arena_layout import ArenaLayout, builtin, load

ROOM: dict[str, Any] = {
    "arena": {"x": [0, 2], "y": [0, 1]},
    "walls": [{"name": "w", "center": [1, 0.5], "size": [0.1, 0.4]}],
}


def test_the_published_mazes_are_read_unchanged() -> None:
    """Cells of the publication: 100 (x + 0.95) + 10 on the first axis, 100 (0.95 - z) + 10 on the second;
    north is less, east more.
    """
    raw = builtin()
    for name, count, start in (("z", 5, (0.1, 1.0)), ("large", 17, (-1.0, 1.0))):
        layout = load(name)
        assert (
            len(layout.objects) == count == len(raw[name]["walls"])
            and layout.border[0] == -start[1]
            and layout.border[2] == -start[0]
        )
        for block, wall in zip(layout.objects, raw[name]["walls"], strict=True):
            first, second = 100 * (wall["center"][0] + 0.95) + 10, 100 * (0.95 - wall["center"][1]) + 10
            x, y = block.center
            np.testing.assert_allclose([105 - 100 * y, 105 + 100 * x], [first, second], rtol=1e-9)
            assert block.size == (wall["size"][1], wall["size"][0]) and block.name == wall["name"]
    assert load("z").goal == (-0.6489, 0.6502)


def test_layouts_are_read_from_files_in_any_unit_and_by_name(tmp_path: Path) -> None:
    one, many = tmp_path / "one.json", tmp_path / "many.json"
    centimetres = {
        "unit": "cm",
        "arena": {"x": [0, 200], "y": [0, 100]},
        "walls": [{"name": "w", "center": [100, 50], "size": [10, 40]}],
    }
    one.write_text(json.dumps(centimetres))
    many.write_text(
        json.dumps(
            {
                "a": ROOM,
                "b": {
                    **ROOM,
                    "start": [0.3, 0.4],
                    "heading": 1.5,
                    "goal": [1.8, 0.5],
                    "blocks": [],
                    "note": 1,
                },
            }
        )
    )
    assert load(one) == load(ROOM) == load(f"{many}#a")
    assert load(f"{many}#b").start == (0.3, 0.4, 1.5) and load(f"{many}#b").goal == (1.8, 0.5)
    for wrong, says in ((many, "holds several arenas"), (f"{many}#c", "holds no arena 'c'")):
        with pytest.raises(WorldError, match=f"{says}.*many.json#a"):
            load(wrong)


def test_the_description_of_a_layout_is_read_as_the_same_layout() -> None:
    for name in builtin():
        reloaded = load(load(name).to_data())
        assert (
            reloaded.border == load(name).border
            and reloaded.goal == load(name).goal
            and reloaded.start == load(name).start
        )
        assert [t.box for t in reloaded.objects] == [t.box for t in load(name).objects]


@pytest.mark.parametrize("color", [(0.0, 0.0, 0.0), (0.0, 0.5, 1.0), (0.25, 1.0, 0.0)])
def test_start_goal_and_colours_are_written_and_read(color: tuple[float, float, float]) -> None:
    block = {"name": "b", "center": [0.5, 0.2], "size": [0.1, 0.2], "color": list(color)}
    layout = load({**ROOM, "blocks": [block], "start": [0.3, 0.4], "heading": 1.5, "goal": [1.8, 0.5]})
    reloaded = load(layout.to_data())
    assert reloaded == layout and (reloaded.start, reloaded.goal) == ((0.3, 0.4, 1.5), (1.8, 0.5))
    assert [t.color for t in reloaded.objects] == [(0.45, 0.45, 0.45), color]


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        (
            {"walls": [{"center": [1, 0.5], "size": [0, 0.4]}]},
            r"walls.0: has the size \[0, 0.4\]; both are above 0, or it has no area",
        ),
        ({"walls": [{"center": [1, 0.5], "size": [-1, 0.4]}]}, "has no area"),
        (
            {"walls": [{"center": [float("nan"), 0.5], "size": [1, 1]}]},
            r"walls.0.center: is \[nan, 0.5\]; expected two finite numbers",
        ),
        ({"walls": [{"center": [1, 0.5], "size": [float("inf"), 1]}]}, "walls.0.size.*two finite numbers"),
        ({"walls": [{"center": [1], "size": [1, 1]}]}, "walls.0.center"),
        ({"walls": [{"center": "ab", "size": [1, 1]}]}, "walls.0.center: is 'ab'"),
        ({"walls": ["w"]}, "walls.0: is 'w'; expected an object"),
        ({"walls": {"w": 1}}, "walls: .*expected a list"),
        ({"boxes": ROOM["walls"]}, "w: is the name of two objects"),
        (
            {"blocks": [{"center": [1, 1], "size": [1, 1], "color": [2, 0, 0]}]},
            "blocks.0.color: .*each from 0 to 1",
        ),
        ({"blocks": [{"center": [1, 1], "size": [1, 1], "color": "red"}]}, "blocks.0.color"),
        ({"arena": {"x": [0, 2]}}, "arena: "),
        ({"arena": {"x": [2, 0], "y": [0, 1]}}, "arena.x: .*lower < upper"),
        ({"arena": None}, "arena: "),
        ({"unit": "ft"}, "unit: is 'ft'; expected one of m, cm, mm"),
        ({"plane": "y,z"}, "plane: is 'y,z'"),
        ({"heading": "north"}, "heading: is 'north'; expected an angle in rad"),
        ({"start": [1]}, "start: "),
        ({"goal": [1, None]}, "goal: "),
        ({"wals": []}, "has the unknown key 'wals'. Did you mean 'walls'?"),
    ],
)
def test_invalid_layouts_are_reported(changed: dict[str, Any], says: str) -> None:
    with pytest.raises(WorldError, match=says):
        load({**ROOM, **changed})


def test_all_problems_of_a_layout_are_listed() -> None:
    with pytest.raises(WorldError) as caught:
        load(
            {
                "arena": {"x": [1, 0], "y": [0, 1]},
                "walls": [{"center": [0, 0], "size": [0, 0]}, {"size": [1, 1]}],
                "unit": "ft",
            }
        )
    assert len(caught.value.problems) == 4


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("{", "is not JSON: .* in line 1, column 2"),
        ('{"a": 1, "a": 2}', "the key 'a' occurs twice"),
        ("[]", "an arena is an object"),
        ("{}", "holds no arena"),
        ('{"a": 3}', "is 3; an arena is an object"),
    ],
)
def test_files_without_an_arena_are_refused(tmp_path: Path, text: str, says: str) -> None:
    file = tmp_path / "arena.json"
    file.write_text(text)
    with pytest.raises(WorldError, match=says):
        load(file)
    for nothing in (tmp_path / "none.json", "lrge", 5):
        with pytest.raises(WorldError):
            load(nothing)  # type: ignore[arg-type]
    with pytest.raises(WorldError, match="Did you mean 'large'"):
        load("lrge")


def test_a_layout_may_be_given_as_data() -> None:
    assert isinstance(load("z"), ArenaLayout) and load("z") == load("z")


def test_an_arena_that_is_too_long_for_its_width_is_refused(tmp_path: Path) -> None:
    longest = {"arena": {"x": [0, 1e12], "y": [0, 1]}, "walls": []}
    layout = tmp_path / "long.json"
    layout.write_text(json.dumps(longest))
    with pytest.raises(WorldError, match=r"long\.json: an arena of 1e\+12 x 1 is too long for its width"):
        Arena(layout)
