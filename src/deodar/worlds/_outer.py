"""Worlds around another world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from deodar.errors import Problem
from deodar.worlds._base import World
from deodar.worlds._link_state import LinkState
from deodar.worlds._scene import Scene


class OuterWorld(World):
    """The base class of worlds around another one, `world`, whose scene, objects and link are theirs."""

    world: World

    def scene(self) -> Scene | None:
        return self.world.scene()

    def link(self) -> LinkState | None:
        return self.world.link()

    @property
    def can_place(self) -> bool:
        return self.world.can_place

    def move(self, name: str, center: Sequence[float]) -> None:
        self.world.move(name, center)

    def place(
        self,
        name: str,
        center: Sequence[float],
        size: Sequence[float],
        color: Sequence[float] = (0.72, 0.53, 0.3),
    ) -> None:
        self.world.place(name, center, size, color)

    def remove(self, name: str) -> None:
        self.world.remove(name)

    def push(self, body: str, force: Sequence[float]) -> None:
        self.world.push(body, force)

    def arrangement(self) -> Any:
        return self.world.arrangement()

    def arrange(self, kept: Any) -> None:
        self.world.arrange(kept)

    def validate_object(self, name: str) -> Iterator[Problem]:
        return self.world.validate_object(name)
