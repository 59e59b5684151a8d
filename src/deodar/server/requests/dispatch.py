"""Carry out the requests of a page: each message of `to_server` has one handler, registered by `handles`."""

from __future__ import annotations

import msgspec

from deodar.server.messages import to_server
from deodar.server.messages.to_page import Answer, Fits, Folder
from deodar.server.pages.hub import Hub
from deodar.server.pages.page import Page
from deodar.server.requests import build_requests as build_requests  # these register their handlers
from deodar.server.requests import edit_requests as edit_requests
from deodar.server.requests import experiment_requests as experiment_requests
from deodar.server.requests import field_requests as field_requests
from deodar.server.requests import file_requests as file_requests
from deodar.server.requests import record_requests as record_requests
from deodar.server.requests import run_requests as run_requests
from deodar.server.requests import stream_requests as stream_requests
from deodar.server.requests import world_requests as world_requests
from deodar.server.requests.handlers import HANDLERS

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
