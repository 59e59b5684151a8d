"""Handlers of requests about the world of the document."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from deodar.credentials import masked
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles
from deodar_studio.world.embodiment import preview
from deodar_studio.world.scene import SentBodies


@handles(to_server.UseWorld)
async def _use_world(hub: Hub, page: Page, m: to_server.UseWorld) -> None:
    world = await in_file_thread(lambda: _world(hub, m), masked(m.path))
    await hub.project.embody(world, m.kind, m.path)


@handles(to_server.PreviewWorld)
async def _preview_world(hub: Hub, page: Page, m: to_server.PreviewWorld) -> Answer:
    model = hub.project.history.model
    doc = None if model is None else model.document
    shown = await in_file_thread(lambda: preview(_world(hub, m), doc), masked(m.path))
    return Answer(request=m.request, preview=shown)


def _world(hub: Hub, m: to_server.UseWorld | to_server.PreviewWorld) -> World:
    """Open a world with a file below the root, a name that it knows, or another text."""
    cls = hub.embodiment.kind(m.kind)
    if not cls.opens or m.path in cls.names():
        return hub.embodiment.open(m.kind, m.path, m.path, m.settings)
    place = hub.workspace.inside(m.path)
    hub.workspace.require_file(place)
    return hub.embodiment.open(m.kind, str(place), m.path, m.settings)


@handles(to_server.UseWorldContent)
async def _use_world_content(hub: Hub, page: Page, m: to_server.UseWorldContent) -> None:
    world = await asyncio.to_thread(hub.embodiment.open_content, m.kind, m.name, m.content, m.settings)
    await hub.project.embody(world, m.kind, m.name)


@handles(to_server.WatchWorld)
async def _watch_world(hub: Hub, page: Page, m: to_server.WatchWorld) -> None:
    page.sent_bodies = SentBodies(m.solid) if m.on else None


@handles(to_server.MoveObject)
async def _move_object(hub: Hub, page: Page, m: to_server.MoveObject) -> None:
    await _rearrange(hub, page, lambda session: session.move(m.name, (m.x, m.y)))


@handles(to_server.PlaceObject)
async def _place_object(hub: Hub, page: Page, m: to_server.PlaceObject) -> None:
    place = m.name, (m.x, m.y), (m.width, m.height), m.color
    await _rearrange(hub, page, lambda session: session.place(*place))


@handles(to_server.RemoveObject)
async def _remove_object(hub: Hub, page: Page, m: to_server.RemoveObject) -> None:
    await _rearrange(hub, page, lambda session: session.remove(m.name))


@handles(to_server.PushBody)
async def _push_body(hub: Hub, page: Page, m: to_server.PushBody) -> None:
    if any(m.force):
        page.pushed.add(m.body)
    else:
        page.pushed.discard(m.body)
    await _rearrange(hub, page, lambda session: session.push_body(m.body, m.force))


async def _rearrange(hub: Hub, page: Page, how: Callable[[Session], None]) -> None:
    hub.project.require_run()
    await hub.in_engine(lambda: hub.engine.rearrange(how))
