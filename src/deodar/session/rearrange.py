"""Move, place and remove things in the world of a session; each function returns the entry of the journal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from deodar.errors import WorldError
from deodar.worlds._base import World
from deodar.worlds._scene import Scene, SceneBox


def move(world: World, scene: Scene, name: str, center: Sequence[float]) -> tuple[str, Any]:
    """Put a thing or a mark elsewhere; returns the entry of the journal.

    Raises:
        UnknownName: nothing is called so.
        WorldError: it does not fit there, or the world is not seen from above.
    """
    thing = scene.thing(name)
    scene.require_room(name, center, thing.size if isinstance(thing, SceneBox) else None)
    world.move(name, center)
    return f"world.move {name}", tuple(center)


def place(
    world: World, scene: Scene, name: str, center: Sequence[float], size: Sequence[float]
) -> tuple[str, Any]:
    """Put a thing there, or another one in the place of one of that name; refused as in `move`."""
    scene.require_room(name, center, size)
    if name in [mark.name for mark in scene.marks]:
        raise WorldError("is the name of a mark", where=name, fix="Choose another name")
    world.place(name, center, size)
    return f"world.place {name}", (tuple(center), tuple(size))


def remove(world: World, scene: Scene, name: str) -> tuple[str, Any]:
    """Take a thing away; refused as in `move`."""
    if not isinstance(scene.thing(name), SceneBox):
        raise WorldError("is a mark; it can be moved, not taken away", where=name)
    world.remove(name)
    return f"world.remove {name}", None
