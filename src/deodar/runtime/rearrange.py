"""A hand in the world of a session: things are put elsewhere while it runs, and the journal tells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from deodar.errors import WorldError
from deodar.worlds._base import World
from deodar.worlds._scene import Box, Scene

if TYPE_CHECKING:
    from deodar.runtime.session import Session


def move(session: Session, name: str, center: Sequence[float]) -> tuple[str, Any]:
    """Put a thing or a mark elsewhere; returns the entry of the journal.

    Raises:
        UnknownName: nothing is called so.
        WorldError: it does not fit there, or the world is not seen from above.
    """
    world, scene = _seen(session)
    thing = scene.thing(name)
    scene.require_room(name, center, thing.size if isinstance(thing, Box) else None)
    world.move(name, center)
    return f"world.move {name}", tuple(center)


def place(session: Session, name: str, center: Sequence[float], size: Sequence[float]) -> tuple[str, Any]:
    """Put a thing there, or another one in the place of one of that name; refused as in `move`."""
    world, scene = _seen(session)
    scene.require_room(name, center, size)
    if name in [mark.name for mark in scene.marks]:
        raise WorldError("is the name of a mark", where=name, fix="Choose another name")
    world.place(name, center, size)
    return f"world.place {name}", (tuple(center), tuple(size))


def remove(session: Session, name: str) -> tuple[str, Any]:
    """Take a thing away; refused as in `move`."""
    world, scene = _seen(session)
    if not isinstance(scene.thing(name), Box):
        raise WorldError("is a mark; it can be moved, not taken away", where=name)
    world.remove(name)
    return f"world.remove {name}", None


def _seen(session: Session) -> tuple[World, Scene]:
    scene = session.scene()
    if session.world is None or scene is None:
        raise WorldError("there is no world that is seen from above", fix="Give one: --world arena:blocks, or world=Arena('blocks')")
    return session.world, scene
