"""What is done to a running trial at a time that was set: things of its world come, move and go, parameters change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from deodar.errors import WorldError
from deodar.runtime.session import Session
from deodar.worlds._base import World
from deodar.worlds.arena import Arena


@dataclass(frozen=True)
class Place:
    """Put a thing into the arena, or another one in the place of one of that name.

    Attributes:
        at: document time from which on it stands there.
        thing: its name.
        center: x and y of its middle, in the unit of the arena.
        size: along x and y.
        color: red, green and blue, 0 to 1.
    """

    at: float
    thing: str
    center: Sequence[float]
    size: Sequence[float]
    color: Sequence[float] = (0.72, 0.53, 0.3)

    def apply(self, session: Session) -> None:
        """Do it now."""
        arena(session.world).place(self.thing, self.center, self.size, self.color)


@dataclass(frozen=True)
class Move:
    """Put a thing of the arena elsewhere: x and y of its middle, at a document time."""

    at: float
    thing: str
    center: Sequence[float]

    def apply(self, session: Session) -> None:
        """Do it now."""
        arena(session.world).move(self.thing, self.center)


@dataclass(frozen=True)
class Remove:
    """Take a thing out of the arena, at a document time."""

    at: float
    thing: str

    def apply(self, session: Session) -> None:
        """Do it now."""
        arena(session.world).remove(self.thing)


@dataclass(frozen=True)
class Set:
    """Give a parameter of the model another value, at a document time."""

    at: float
    path: str
    value: Any

    def apply(self, session: Session) -> None:
        """Do it now."""
        session.set(self.path, self.value)


Action = Place | Move | Remove | Set


def arena(world: World | None) -> Arena:
    """The world as one in which things stand, refused if it is another."""
    if not isinstance(world, Arena):
        what = "there is no world" if world is None else f"the world {type(world).__name__} has none"
        raise WorldError(f"things are placed, moved and removed in an arena, and {what}", fix="Give one: world=Arena('blocks')")
    return world
