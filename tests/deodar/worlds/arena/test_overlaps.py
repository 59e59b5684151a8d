"""Blocks at one place, outside the arena and on the start: warnings with their names before a run."""

from __future__ import annotations

from typing import Any

import pytest

import deodar as dd
from deodar.errors import RunWarning
from deodar.worlds.arena.arena import Arena

ROOM: dict[str, Any] = {"unit": "mm", "arena": {"x": [-300, 300], "y": [-300, 300]}}


def room(*blocks: dict[str, Any], walls: tuple[dict[str, Any], ...] = (), **arguments: Any) -> Arena:
    layout = {**ROOM, "blocks": list(blocks), "walls": list(walls)}
    options: dict[str, Any] = {"start": (0, 0, 0), "unit": "mm", **arguments}
    return Arena(layout, **options)


def block(name: str, x: float, y: float) -> dict[str, Any]:
    return {"name": name, "center": [x, y], "size": [50, 50]}


def warnings_of(world: Arena) -> list[str]:
    return [str(p) for p in world.validate()]


def test_blocks_of_a_layout_that_overlap_are_named() -> None:
    (text,) = warnings_of(room(block("red", 200, 0), block("green", 220, 40), block("blue", -200, 0)))
    assert text.startswith("arena: the blocks 'red' and 'green' overlap by 30 x 10 mm. Move one of them")
    assert "arena.place('green', windows=...)" in text


def test_blocks_that_touch_and_walls_that_overlap_are_no_fault() -> None:
    assert warnings_of(room(block("red", 200, 0), block("green", 250, 0))) == []
    assert warnings_of(room(block("red", 200, 0), walls=(block("one", 200, 20), block("two", 200, 30)))) == []
    for name in ("blocks", "z", "large"):
        assert warnings_of(Arena(name)) == []


def test_a_block_that_replaces_another_one_is_no_overlap() -> None:
    world = room()
    world.place("first", (200, 0), (50, 50), windows=(0, 800))
    world.place("second", (200, 0), (50, 50), windows=(800, 1600))
    assert warnings_of(world) == []
    world.place("second", (200, 0), (50, 50), windows=(700, 1600))
    assert "the blocks 'first' and 'second' overlap by 50 x 50 mm" in warnings_of(world)[0]
    world.remove("first")
    assert warnings_of(world) == []


def test_the_trial_in_which_blocks_overlap_is_named() -> None:
    world = room(block("red", 200, 0))
    world.place("green", [(0, 200), (0, 200), (200, 30)], (50, 50))
    (text,) = warnings_of(world)
    assert "'red' and 'green' overlap by 50 x 20 mm in trial 2" in text
    assert warnings_of(world.for_trial(1)) == []


@pytest.mark.parametrize(
    ("place", "windows", "says"),
    [
        ((400, 0), None, "the block 'red' lies outside the arena"),
        ((400, 0), (800, 1600), "the block 'red' lies outside the arena"),
        ((400, 0), (0, 0), ""),
        ((310, 0), None, ""),
        ((20, 0), None, "the block 'red' covers the start of the e-puck, which is pushed aside"),
        ((20, 0), (800, 1600), ""),
    ],
)
def test_a_block_outside_or_on_the_start_is_named(place: Any, windows: Any, says: str) -> None:
    world = room()
    world.place("red", place, (50, 50), windows=windows)
    texts = warnings_of(world)
    assert len(texts) == bool(says) and all(says in text for text in texts)


def test_a_run_warns_of_overlapping_blocks_and_its_record_does_not_name_walls() -> None:
    model = dd.Model("parked", dt=64)
    model.add(dd.Boost("go", amplitude=0.0)) >> model.add(dd.Motor("left", motor="left"))
    world = room(block("red", 200, 0), walls=(block("one", -200, 20), block("two", -200, 30)))
    assert warnings_of(Arena.again(world.describe())) == []
    world.place("green", (210, 0), (50, 50))
    with pytest.warns(RunWarning, match="the blocks 'red' and 'green' overlap by 40 x 50 mm"):
        dd.Session(model, world=world)
