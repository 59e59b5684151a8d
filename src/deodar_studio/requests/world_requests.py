"""Requests about the world of the document."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any

import msgspec

from deodar.credentials import masked
from deodar.errors import WorldError
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages.to_page import Answer, MotorLimits
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import MESSAGES, Request, Text, answer, asks, changes
from deodar_studio.world.embodiment import preview
from deodar_studio.world.scene import SentBodies

Limits = Annotated[Sequence[MotorLimits], msgspec.Meta(max_length=1000)]


@changes()
async def use_world(
    hub: Hub,
    page: Page,
    *,
    kind: Text,
    path: Text,
    settings: Mapping[str, Any] = {},
    limits: Limits = (),
) -> None:
    """Use a world of a kind, opened with a file below the root, or with another argument of `open`.

    `settings` are further arguments of its constructor. Motors are narrowed to `limits` before the first
    command.
    """
    world = await in_file_thread(lambda: _narrow_world(hub, kind, path, settings, limits), masked(path))
    await hub.project.embody(world, kind, path)


@asks()
async def preview_world(
    hub: Hub, page: Page, *, kind: Text, path: Text, settings: Mapping[str, Any] = {}
) -> Answer:
    """Open a world as `use_world` does, without using it; the answer has its `preview`."""
    model = hub.project.history.model
    doc = None if model is None else model.document
    picture = await in_file_thread(lambda: preview(_world(hub, kind, path, settings), doc), masked(path))
    return answer(preview=picture)


@asks()
async def narrow_motor(hub: Hub, page: Page, *, limits: MotorLimits) -> None:
    """Narrow what a motor of the running world allows, from its next command on; nothing widens it again."""
    hub.project.require_run()
    await hub.in_engine(lambda: _narrow(hub, limits))


def _narrow(hub: Hub, limits: MotorLimits) -> None:
    session = hub.engine.session
    world = None if session is None else session.world
    hub.engine.narrow(limits.motor, *_narrower(limits, world))


def _narrow_world(
    hub: Hub, kind: str, path: str, settings: Mapping[str, Any], limits: Sequence[MotorLimits]
) -> World:
    """Open a world, and narrow its motors; after an error it is closed."""
    world = _world(hub, kind, path, settings)
    try:
        with errors_of(world, "narrow"):
            for narrow in limits:
                world.narrow(narrow.motor, *_narrower(narrow, world))
    except BaseException:
        world.close()
        raise
    return world


def _narrower(limits: MotorLimits, world: World | None) -> tuple[tuple[float, float] | None, float | None]:
    """Return the arguments of `World.narrow`; an end that is missing is that of the world."""
    rule = None if world is None else world.rules.get(limits.motor)
    ends = (None, None) if rule is None or rule.limits is None else rule.limits
    lower = ends[0] if limits.lower is None else limits.lower
    upper = ends[1] if limits.upper is None else limits.upper
    if lower is None and upper is None:
        return None, limits.slew
    if lower is None or upper is None:
        raise WorldError("has one end; a range has two", where=limits.motor, fix="Type both numbers")
    return (lower, upper), limits.slew


def _world(hub: Hub, kind: str, path: str, settings: Mapping[str, Any]) -> World:
    """Open a world with a file below the root, a name that it knows, or another text."""
    cls = hub.embodiment.kind(kind)
    if not cls.opens or path in cls.names():
        return hub.embodiment.open(kind, path, path, settings)
    place = hub.workspace.inside(path)
    hub.workspace.require_file(place)
    return hub.embodiment.open(kind, str(place), path, settings)


@changes()
async def use_world_content(
    hub: Hub, page: Page, *, kind: Text, name: Text, content: str, settings: Mapping[str, Any] = {}
) -> None:
    """Use a world of a kind, made from the content (base64) of a file that was dropped on the page."""
    world = await asyncio.to_thread(hub.embodiment.open_content, kind, name, content, settings)
    await hub.project.embody(world, kind, name)


@asks()
async def watch_world(hub: Hub, page: Page, *, on: bool, solid: bool = False) -> None:
    """Start or stop sending `bodies`; `solid`: with the solids and their poses."""
    page.sent_bodies = SentBodies(solid) if on else None


@asks()
async def move_object(hub: Hub, page: Page, *, name: Text, x: float, y: float) -> None:
    """Move an object or a mark of the world; `x` and `y` are its new middle."""
    await _rearrange(hub, lambda session: session.move(name, (x, y)))


@MESSAGES.register
class PlaceObject(Request, frozen=True, kw_only=True, tag="place_object"):
    """Add an object to the world, with its middle and its size.

    `color` is red, green and blue, 0 to 1; None: that of the world.
    """

    name: Text
    x: float
    y: float
    width: float
    height: float
    color: list[float] | None = None

    async def serve(self, hub: Hub, page: Page) -> None:
        place = self.name, (self.x, self.y), (self.width, self.height), self.color
        await _rearrange(hub, lambda session: session.place(*place))


@asks()
async def remove_object(hub: Hub, page: Page, *, name: Text) -> None:
    """Remove an object from the world."""
    await _rearrange(hub, lambda session: session.remove(name))


@asks()
async def push_body(hub: Hub, page: Page, *, body: Text, force: Sequence[float]) -> None:
    """Push a body of the world with a force along x, y and z, in N, until the next one; zeros end it.

    It ends too when the page disconnects.
    """
    if any(force):
        page.pushed.add(body)
    else:
        page.pushed.discard(body)
    await _rearrange(hub, lambda session: session.push_body(body, force))


async def _rearrange(hub: Hub, how: Callable[[Session], None]) -> None:
    hub.project.require_run()
    await hub.in_engine(lambda: hub.engine.rearrange(how))
