"""Carry out the requests of a page: each message of `to_server` has one handler, registered by `handles`."""

from __future__ import annotations

import msgspec

from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer, Fits, Folder
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests import build_requests as build_requests  # these register their handlers
from deodar_studio.requests import edit_requests as edit_requests
from deodar_studio.requests import experiment_requests as experiment_requests
from deodar_studio.requests import field_requests as field_requests
from deodar_studio.requests import file_requests as file_requests
from deodar_studio.requests import record_requests as record_requests
from deodar_studio.requests import run_requests as run_requests
from deodar_studio.requests import stream_requests as stream_requests
from deodar_studio.requests import world_requests as world_requests
from deodar_studio.requests.handlers import HANDLERS

Answers = list[Answer | Folder | Fits]


async def do(hub: Hub, page: Page, message: to_server.Request) -> Answers:
    """Handle a request, and return its answers; the last one ends the request.

    Requests that change the document are handled one after the other.
    """
    if isinstance(message, to_server.DocumentRequest):
        return await hub.project.queue.run(lambda: _change(hub, page, message), message.session)
    return await _done(hub, page, message)


async def _done(hub: Hub, page: Page, message: to_server.Request) -> Answers:
    done = await HANDLERS[type(message)](hub, page, message)
    if isinstance(done, (Folder, Fits)):
        return [done, Answer(request=message.request)]
    return [done or Answer(request=message.request)]


async def _change(hub: Hub, page: Page, message: to_server.DocumentRequest) -> Answers:
    answers = await _done(hub, page, message)
    version = hub.project.history.version
    return [msgspec.structs.replace(a, version=version) if isinstance(a, Answer) else a for a in answers]
