"""Worlds around another world."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from deodar.errors import Problem
from deodar.worlds._base import World
from deodar.worlds._motor_rule import MotorRule

INNER = (
    *("scene", "preview", "halt", "link", "narrow", "alternative"),
    *("place", "move", "remove", "push", "arrangement", "arrange", "validate_object"),
)
"""Methods that an `OuterWorld` calls in the world that it is around, with all arguments."""


class OuterWorld(World):
    """The base class of worlds around another one, `world`, whose scene, objects and link are theirs."""

    world: World

    @property
    def members(self) -> tuple[World, ...]:
        """The worlds that it is made of, `world` first."""
        return (self.world,)

    @property
    def stage(self) -> World:
        return self.world.stage

    @property
    def rules(self) -> Mapping[str, MotorRule]:  # type: ignore[override]
        """What motors allow, by name."""
        return self.world.rules

    @property
    def can_narrow(self) -> bool:
        return self.world.can_narrow

    @property
    def repeatable(self) -> bool:  # type: ignore[override]
        """Whether a restored state leads to the same readings again."""
        return all(member.repeatable for member in self.members)

    @property
    def wall_clock(self) -> bool:  # type: ignore[override]
        """Whether it follows the wall clock."""
        return any(member.wall_clock for member in self.members)

    def validate(self) -> Iterator[Problem]:
        for member in self.members:
            yield from member.validate()

    def close(self) -> None:
        for member in self.members:
            member.close()


def _passed_on(name: str) -> Callable[..., Any]:
    @functools.wraps(getattr(World, name))
    def method(self: OuterWorld, *args: Any, **given: Any) -> Any:
        return getattr(self.world, name)(*args, **given)

    return method


for _name in INNER:
    setattr(OuterWorld, _name, _passed_on(_name))
