"""The handler of each message class; `handles` registers them."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

from deodar.errors import ModelError
from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer, Fits, Folder
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page

R = TypeVar("R", bound=to_server.Request)
Handler = Callable[[Hub, Page, R], Awaitable[Answer | Folder | Fits | None]]
HANDLERS: dict[type[to_server.Request], Handler[Any]] = {}


def handles(kind: type[R]) -> Callable[[Handler[R]], Handler[R]]:
    """Decorator that registers the handler of a message class.

    Raises:
        ModelError: the message has a handler already.
    """

    def register(handler: Handler[R]) -> Handler[R]:
        if kind in HANDLERS:
            raise ModelError(f"the message {kind.__name__} has a handler already")
        HANDLERS[kind] = handler
        return handler

    return register
