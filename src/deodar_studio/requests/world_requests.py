"""Requests about the world of the document."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from deodar.credentials import masked
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import MESSAGES, Request, Text, answer, asks, changes
from deodar_studio.world.embodiment import preview
from deodar_studio.world.scene import SentBodies


@changes()
async def use_world(
    hub: Hub, page: Page, *, kind: Text, path: Text, settings: Mapping[str, Any] = {}
) -> None:
    """Use a world of a kind, opened with a file below the root, or with another argument of `open`.

    `settings` are further arguments of its constructor.
    """
    world = await in_file_thread(lambda: _world(hub, kind, path, settings), masked(path))
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
