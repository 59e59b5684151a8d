"""The connection of one page: it handles the requests one after the other, and sends the state of the studio.

Only answers are queued. After each exchange the page confirms that it has drawn everything (`drawn`); only
then the connection sends the next exchange, from the state at that moment. A slow page receives fewer frames,
and the server buffers none for it.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections import deque
from typing import Any

import msgspec
from starlette.websockets import WebSocket, WebSocketDisconnect

from deodar import codec
from deodar.errors import DeodarError
from deodar.server import requests, scene, view
from deodar.server.hub import Hub
from deodar.server.message import Message, union
from deodar.server.project import ConfirmationRequired
from deodar.server.to_page import (
    Answer,
    Checked,
    Costs,
    FileProblems,
    Folder,
    Gallery,
    ListedProblem,
    Opened,
    RunClock,
    WorldScene,
)
from deodar.server.to_server import MESSAGES, Drawn

MOST_ANSWERS = 64
"""Largest number of queued answers; the connection reads no requests from a page that has more."""

MOST_MALFORMED = 20
IDLE = 0.25
"""Longest wall time between two checks for news, in seconds."""


class PageConnection:
    """The socket of one page."""

    def __init__(self, socket: WebSocket, hub: Hub) -> None:
        self._hub = hub
        self.page = hub.new_page()
        self._socket = socket
        self._room = asyncio.Event()
        self._answers: deque[Answer | Folder] = deque()
        self._exchange = 0
        self._ready = True
        self._published = -1
        self._known: dict[str, Any] = {}
        self._session, self._version = -1, -1
        self._malformed = 0
        self._decoder = msgspec.json.Decoder(union(MESSAGES))

    async def run(self) -> None:
        """Serve the page until it disconnects."""
        await self._socket.accept()
        self._hub.pages.add(self.page)
        both = [asyncio.create_task(self._receive()), asyncio.create_task(self._send())]
        try:
            done, _ = await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                # an error of deodar appears on the terminal; the page connects again with a new state
                task.result()
        finally:
            self._hub.leave(self.page)
            for task in both:
                task.cancel()

    # ------------------------------------------------------------------------------------------ from the page

    async def _receive(self) -> None:
        while True:
            data = await self._socket.receive()
            if data["type"] == "websocket.disconnect":
                return
            text = data.get("text") or ""
            try:
                message = self._decoder.decode(text)
            except (msgspec.DecodeError, RecursionError, UnicodeEncodeError) as error:
                self._malformed += 1
                self._refuse(_request(text), f"The message is not understood: {error}")
                if self._malformed >= MOST_MALFORMED:
                    await self._socket.close(1008, "too many messages that are not understood")
                    return
                continue
            if isinstance(message, Drawn):
                if message.frame == self._exchange:
                    self._ready = True
                    self._hub.engine.want()
                    self.page.wake()
                continue
            await self._do(message)
            while len(self._answers) >= MOST_ANSWERS:
                self._room.clear()
                await self._room.wait()

    async def _do(self, message: Any) -> None:
        try:
            answers = await requests.do(self._hub, self.page, message)
        except ConfirmationRequired as required:
            answers = [Answer(request=message.request, ask=required.question)]
        except DeodarError as error:
            model = self._hub.project.model
            problems = view.problems(error.problems, None if model is None else model.document)
            answers = [Answer(request=message.request, problems=problems)]
        except OSError as error:
            what = f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}"
            answers = [Answer(request=message.request, problems=[ListedProblem(what=what)])]
        except Exception as error:
            logging.getLogger("deodar.studio").exception("a request of the page failed")
            what = (
                f"This is an error of deodar itself ({type(error).__name__}: {error}). The terminal of the"
                " studio shows the details."
            )
            answers = [Answer(request=message.request, problems=[ListedProblem(what=what)])]
        self._answers.extend(a for a in answers if message.request)
        self.page.wake()

    def _refuse(self, request: int, what: str) -> None:
        self._answers.append(Answer(request=request, problems=[ListedProblem(what=what)]))
        self.page.wake()

    # -------------------------------------------------------------------------------------------- to the page

    async def _send(self) -> None:
        try:
            await self._text(self._hub.welcome)
            while True:
                self.page.news.clear()
                if self._ready:
                    await self._say()
                # `wait_for` of Python 3.11 loses a cancellation at the moment of an event
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(IDLE):
                        await self.page.news.wait()
        except (WebSocketDisconnect, RuntimeError, OSError):
            pass  # the page has disconnected; `_receive` ends the connection

    async def _say(self) -> None:
        """Send everything that is new, followed by a clock."""
        hub, engine = self._hub, self._hub.engine
        spoke = False
        while True:
            for message in await self._news_of_state():
                await self._text(message)
                spoke = True
            # an answer is never sent before its change
            if (self._session, self._version) == (hub.project.session, hub.project.version):
                break
        published = engine.published
        sent = published.number != self._published
        self._published = published.number
        for stream in list(self.page.streams.values()):
            news = stream.news(engine.session)
            if news is not None:
                await self._text(news)
                sent = spoke = True
            data = stream.frame(engine) if sent else None
            if data is not None:
                await self._socket.send_bytes(data)
                spoke = True
        while self._answers:
            await self._text(self._answers.popleft())
            self._room.set()
            spoke = True
        clock = hub.clock(0)
        if spoke or clock != self._known.get("clock"):
            self._known["clock"] = clock
            self._exchange += 1
            self._ready = False
            await self._text(msgspec.structs.replace(clock, frame=self._exchange))
        else:
            # the last state contained nothing for this page, which still waits for one that does
            engine.want()

    async def _news_of_state(self) -> list[Message]:
        project = self._hub.project
        out: list[Message] = []
        now = project.session, project.version
        if (self._session, self._version) != now:
            changes = project.changes_since(self._session, self._version)
            if changes is None:
                out.append(Opened(session=project.session, version=project.version, document=project.view()))
                self._new("gallery", await self._hub.gallery(), out)
            else:
                out.extend(changes)
            self._session, self._version = now
            file, problems = project.file_problems
            self._new("file_problems", FileProblems(file=file, problems=view.problems(problems)), out)
        if project.checker.found is not None:
            self._new("checked", project.checker.found, out)
        self._new("costs", self._hub.costs(), out)
        track = self._hub.engine.track
        self._new("scene", scene.scene(track.scene), out)
        moved = None if self.page.sent_bodies is None else self.page.sent_bodies.news(track)
        return out if moved is None else [*out, moved]

    def _new(
        self,
        what: str,
        message: Gallery | FileProblems | Checked | RunClock | Costs | WorldScene,
        out: list[Message],
    ) -> None:
        if self._known.get(what) != message:
            self._known[what] = message
            out.append(message)

    async def _text(self, message: Message) -> None:
        await self._socket.send_text(msgspec.json.encode(message).decode())


def _request(text: str) -> int:
    """Return the number of a malformed request, or 0 if it cannot be read."""
    try:
        number: Any = codec.parse(text)["request"]
    except (ValueError, TypeError, KeyError, RecursionError):
        return 0
    return number if isinstance(number, int) and 0 <= number < 2**31 else 0
