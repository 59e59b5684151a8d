"""Move, place, remove and push objects in the world of a session; each function returns a journal entry."""

from __future__ import annotations

from collections.abc import Sequence

from deodar.errors import WorldError
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar.worlds._scene import Scene, SceneBox


def move(world: World, scene: Scene, name: str, center: Sequence[float]) -> tuple[str, tuple[float, ...]]:
    """Move an object or a mark; return the entry for the journal.

    Raises:
        UnknownName: the scene has no object or mark of that name.
        WorldError: it does not fit at the position, or cannot be moved.
    """
    item = scene.entry(name)
    scene.require_room(name, center, item.size if isinstance(item, SceneBox) else None)
    with errors_of(world, "move"):
        world.move(name, center)
    return f"world.move {name}", tuple(center)


def place(
    world: World,
    scene: Scene,
    name: str,
    center: Sequence[float],
    size: Sequence[float],
    color: Sequence[float] | None,
) -> tuple[str, tuple[tuple[float, ...], ...]]:
    """Add an object, or replace the one of the same name; return the entry for the journal.

    Raises:
        WorldError: it does not fit at the position, or a mark has that name.
    """
    coloured = () if color is None else (tuple(color),)
    scene.require_room(name, center, size)
    if name in [mark.name for mark in scene.marks]:
        raise WorldError("is the name of a mark", where=name, fix="Choose another name")
    with errors_of(world, "place"):
        world.place(name, center, size, *coloured)
    return f"world.place {name}", (tuple(center), tuple(size), *coloured)


def remove(world: World, scene: Scene, name: str) -> tuple[str, None]:
    """Remove an object; return the entry for the journal.

    Raises:
        UnknownName: the scene has no object of that name.
        WorldError: it is a mark, or cannot be moved.
    """
    if not isinstance(scene.entry(name), SceneBox):
        raise WorldError("is a mark; it can be moved, not removed", where=name)
    with errors_of(world, "remove"):
        world.remove(name)
    return f"world.remove {name}", None


def push(world: World, body: str, force: Sequence[float]) -> tuple[str, tuple[float, ...]]:
    """Push a body until the next push; return the entry for the journal.

    Raises:
        UnknownName: the world has no such body.
        WorldError: nothing in this world can be pushed, or the force is invalid.
    """
    with errors_of(world, "push"):
        world.push(body, force)
    return f"world.push {body}", tuple(force)
