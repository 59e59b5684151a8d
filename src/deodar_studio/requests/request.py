"""Requests of a page: each is declared by the function that serves it.

The keywords of the function are the fields of the message, its docstring is the description in the protocol,
its name in CamelCase that of the class, and its name or `tag` the `type` on the wire. A function with more
keywords than a reader follows is the method `serve` of a class instead.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Awaitable, Callable
from typing import Annotated, Concatenate, ParamSpec

import msgspec

from deodar.family import Family
from deodar.model.document import Document
from deodar_studio.messages.message import Message
from deodar_studio.messages.to_page import Answer, Fits, Folder
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page

P = ParamSpec("P")

Text = Annotated[str, msgspec.Meta(max_length=4096)]
Count = Annotated[int, msgspec.Meta(ge=0, le=2**31 - 1)]

Served = Answer | Folder | Fits | None
"""What a function returns to its page; None: that it was done. `Request.answers` fills in the number."""

Serve = Callable[Concatenate[Hub, Page, P], Awaitable[Served]]
Edit = Callable[Concatenate[Document, P], Document]

answer = functools.partial(Answer, request=0)


class Request(Message, frozen=True):
    """Base class of requests. If `request` is not 0, an `answer` with the same number follows."""

    request: Count = 0

    async def serve(self, hub: Hub, page: Page) -> Served:
        """Do what the page asks for."""
        raise NotImplementedError

    async def answers(self, hub: Hub, page: Page) -> list[Answer | Folder | Fits]:
        """Serve the request, and return its answers; the last one ends it."""
        first = msgspec.structs.replace(await self.serve(hub, page) or answer(), request=self.request)
        return [first] if isinstance(first, Answer) else [first, Answer(request=self.request)]


MESSAGES = Family(Request)
"""All messages to the server."""


class DocumentRequest(Request, frozen=True):
    """A request that opens, closes or changes a document or an experiment.

    The server handles the requests of all pages one after the other. `session` is the number of the document
    that the request is meant for, as in `opened`; the request is refused if another document was opened
    since. With 0 it is meant for any open document.
    """

    session: Count = 0

    async def answers(self, hub: Hub, page: Page) -> list[Answer | Folder | Fits]:
        """Serve the request after all earlier changes; the answer names the version that has the change."""

        async def change() -> list[Answer | Folder | Fits]:
            out = await super(DocumentRequest, self).answers(hub, page)
            version = hub.project.history.version
            return [msgspec.structs.replace(a, version=version) if isinstance(a, Answer) else a for a in out]

        return await hub.project.queue.run(change, self.session)


class OpeningRequest(DocumentRequest, frozen=True):
    """A request that opens another document, whichever is open."""


class RepeatRequest(Request, frozen=True):
    """A request that repeats a run and may take as long; later requests of the page are served meanwhile."""


@MESSAGES.register
class Drawn(Request, frozen=True, kw_only=True, tag="drawn"):
    """Confirm that the page has drawn the frames up to the clock of this number; the next ones follow."""

    frame: Count


def asks(tag: str = "", base: type[Request] = Request) -> Callable[[Serve[P]], Serve[P]]:
    """Decorator: the function serves a request of the sort `base`."""

    def declare(serve: Serve[P]) -> Serve[P]:
        _declare(serve, base, tag)
        return serve

    return declare


changes = functools.partial(asks, base=DocumentRequest)
opens = functools.partial(asks, base=OpeningRequest)
repeats = functools.partial(asks, base=RepeatRequest)


def edits(tag: str = "") -> Callable[[Edit[P]], Edit[P]]:
    """Decorator: the function makes a document from the open one, which is one step of undo."""

    def declare(edit: Edit[P]) -> Edit[P]:
        @functools.wraps(edit)
        async def serve(hub: Hub, page: Page, *args: P.args, **fields: P.kwargs) -> None:
            await hub.project.history.change(lambda doc: edit(doc, *args, **fields))

        _declare(serve, DocumentRequest, tag)
        return edit

    return declare


def _declare(function: Callable[..., Awaitable[Served]], base: type[Request], tag: str) -> None:
    """Register the message whose fields are the keywords of a function."""
    parameters = inspect.signature(function, eval_str=True).parameters.values()
    fields = [p for p in parameters if p.kind is p.KEYWORD_ONLY]

    async def serve(self: Request, hub: Hub, page: Page) -> Served:
        return await function(hub, page, **{p.name: getattr(self, p.name) for p in fields})

    message = msgspec.defstruct(
        function.__name__.title().replace("_", ""),
        [(p.name, p.annotation, *(() if p.default is p.empty else (p.default,))) for p in fields],
        bases=(base,),
        module=function.__module__,
        namespace={"__doc__": function.__doc__, "serve": serve},
        tag=tag or function.__name__,
        frozen=True,
        kw_only=True,
    )
    MESSAGES.register(message)
