"""Worlds around another one pass on whatever concerns the inner world, with all arguments."""

from __future__ import annotations

import inspect
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.experiments.actions import changed
from deodar.worlds._base import World
from deodar.worlds._outer import INNER, OuterWorld
from deodar.worlds.arena.arena import Arena
from deodar.worlds.combined import Combined
from deodar.worlds.picture import Picture

TALL = dd.Place(64.0, "tower", (0.3, 0.3), (0.05, 0.05), height=0.05)


class Around(OuterWorld):
    def __init__(self, world: World) -> None:
        self.world = world


@pytest.mark.parametrize("name", INNER)
def test_methods_about_the_inner_world_are_passed_on_with_all_arguments(name: str):
    inner: Any = Mock()
    arguments = [object() for _ in list(inspect.signature(getattr(World, name)).parameters)[1:]]
    returned = getattr(Around(inner), name)(*arguments, other=3)
    getattr(inner, name).assert_called_once_with(*arguments, other=3)
    assert returned is getattr(inner, name).return_value


def test_every_method_of_worlds_is_passed_on_or_defined_by_the_outer_world():
    methods = {name for name, m in vars(World).items() if inspect.isfunction(m) and not name.startswith("_")}
    exchange = {
        "reset",
        "sense",
        "sense_all",
        "act",
        "keep",
        "older_form",
        "put",
        "describe",
        "validate_axes",
    }
    assert methods - exchange - {"require", "require_motor"} == {*INNER, "validate", "close"}


def test_an_object_of_an_experiment_has_the_arguments_of_the_inner_world():
    arena = Arena("blocks")
    world = Combined(Around(arena), {"eye": Picture.example()})
    assert changed(TALL, world) is world and world.can_place and world.stage is arena
    world.place("tower", (0.3, 0.3), (0.05, 0.05), height=0.05)
    assert [t.height for t in arena.objects.present(1, 0) if t.name == "tower"] == [0.05]


def test_an_inner_world_without_objects_is_named():
    world = Combined(Picture.example(), {"eye": Picture.example()})
    assert not world.can_place
    with pytest.raises(WorldError, match=r"calls World\.place, which the world Picture does not have"):
        changed(TALL, world)


def test_the_preview_is_that_of_the_inner_world():
    class Seen(Picture):
        def preview(self) -> np.ndarray:
            return np.ones((2, 2, 3))

    world = Combined(Seen(np.zeros((4, 4, 3))), {"eye": Picture.example()})
    assert world.preview() is not None


def test_an_inner_world_that_cannot_be_narrowed_is_named():
    world = Combined(Around(Arena("blocks")), {"eye": Picture.example()})
    assert not world.can_narrow
    with pytest.raises(WorldError, match="left: the world Arena cannot narrow what its motors allow"):
        world.narrow("left", (-1.0, 1.0))
