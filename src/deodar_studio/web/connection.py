"""The connection of one page: it handles the requests one after the other, and sends the state of the studio.

Only answers are queued. After each exchange the page confirms that it has drawn everything (`drawn`); only
then the connection sends the next exchange, from the state at that moment. A slow page receives fewer frames,
and the server buffers none for it.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import time
from collections import deque
from collections.abc import Awaitable
from typing import Any

import msgspec
from starlette.websockets import WebSocket, WebSocketDisconnect

from deodar import codec, last_error
from deodar.errors import DeodarError
from deodar.model.unit import unit_seconds
from deodar.session.port_reader import PortKey
from deodar_studio.live.published import PublishedState
from deodar_studio.messages.message import Message, made_of, union
from deodar_studio.messages.to_page import (
    Answer,
    Fits,
    Folder,
    ListedProblem,
    RobotLink,
    TimelineView,
    WorldScene,
)
from deodar_studio.pages.hub import Hub
from deodar_studio.project.confirmation import ConfirmationRequired
from deodar_studio.requests.request import MESSAGES, Drawn, RepeatRequest, Request
from deodar_studio.streams.source import FrameSource
from deodar_studio.views import view
from deodar_studio.world import scene

MOST_ANSWERS = 64
"""Largest number of queued answers; the connection reads no requests from a page that has more."""

MOST_MALFORMED = 20
IDLE = 0.25
"""Longest wall time between two checks for news, in seconds."""

LINK_EVERY = 0.25
"""Shortest wall time between two messages on the link with a robot, in seconds."""


class PageConnection:
    """The socket of one page."""

    def __init__(self, socket: WebSocket, hub: Hub) -> None:
        self._hub = hub
        self.page = hub.new_page()
        self._socket = socket
        self._room = asyncio.Event()
        self._answers: deque[Answer | Folder | Fits] = deque()
        self._exchange = 0
        self._ready = True
        self._published = self._published_other = -1
        self._spoke = False
        self._known: dict[type[Message], Message] = {RobotLink: RobotLink()}
        self._link_sent = 0.0
        self._timeline: TimelineView | None = None
        self._session, self._version, self._experiment = -1, -1, -1
        self._rows = (0, 0)  # the run whose rows the page has, and how many
        self._malformed = 0
        self._decoder = msgspec.json.Decoder(union(MESSAGES))

    async def run(self) -> None:
        """Serve the page until it disconnects."""
        await self._socket.accept()
        self._hub.enter(self.page)
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
                self._answers.append(_refused(_request(text), f"The message is not understood: {error}"))
                self.page.wake()
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
            if isinstance(message, RepeatRequest):
                self._hub.project.queue.start_task(self._do(message))
                continue
            await self._do(message)
            while len(self._answers) >= MOST_ANSWERS:
                self._room.clear()
                await self._room.wait()

    async def _do(self, message: Request) -> None:
        try:
            answers = await message.answers(self._hub, self.page)
        except ConfirmationRequired as required:
            answers = [Answer(request=message.request, ask=required.question, file=required.file)]
        except DeodarError as error:
            model = self._hub.project.history.model
            doc = None if model is None else model.document
            problems = view.problems(error.problems, doc, buttons=False)
            answers = [Answer(request=message.request, problems=problems)]
        except OSError as error:
            what = f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}"
            answers = [_refused(message.request, what)]
        except Exception as error:
            logging.getLogger("deodar.studio").exception("a request of the page failed")
            await asyncio.to_thread(last_error.note, error, "studio", self._names())
            what = (
                f"This is an error of deodar itself ({type(error).__name__}: {error}). The terminal of the"
                " studio shows the details."
            )
            answers = [msgspec.structs.replace(_refused(message.request, what), fault=True)]
        self._answers.extend(a for a in answers if message.request)
        self.page.wake()

    def _names(self) -> list[object]:
        """Return what a fault report leaves out: the names of the open document and its file."""
        model, file = self._hub.project.history.model, self._hub.project.file.path
        return [name for name in (None if model is None else model.document.name, file) if name is not None]

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
        except WebSocketDisconnect:
            pass  # the page has disconnected; `_receive` ends the connection

    async def _say(self) -> None:
        """Send everything that is new, followed by a clock."""
        hub, engine = self._hub, self._hub.engine
        self._spoke = False
        while True:
            source = hub.source(self.page)
            state = await self._shown(source)
            for message in await self._news_of_state():
                await self._text(message)
            # an answer is never sent before its change, and frames belong to the document that was sent
            now = hub.project.session, hub.project.history.version, hub.experiment.version
            known = self._session, self._version, self._experiment
            if known == now and hub.source(self.page).identity is source.identity:
                answers = list(self._answers)
                break
        for message in self._news_of_world(state):
            await self._text(message)
        sent = state.number != self._published
        self._published = state.number
        await self._send_frames(source, state, self.page.moment, False, sent)
        others = hub.other_source(self.page)
        if others is not None:
            found = await others.at(state.time, 0, self._places(True))
            if found is not None:
                sent = found[1].number != self._published_other
                self._published_other = found[1].number
                await self._send_frames(others, found[1], found[1], True, sent)
        for answer in answers:
            self._answers.popleft()
            await self._text(answer)
            self._room.set()
        clock = hub.clock(self._timeline)
        if self._new(clock) or self._spoke:
            self._exchange += 1
            self._ready = False
            await self._text(msgspec.structs.replace(clock, frame=self._exchange))
        else:
            # the last state contained nothing for this page, which still waits for one that does
            engine.want()

    def _places(self, other: bool) -> set[PortKey]:
        """Return the ports whose frames the page watches, of the open record or of the other one."""
        watched = (s for s in self.page.streams.values() if s.request is None and s.other == other)
        return {stream.place for stream in watched if stream.place is not None}

    async def _send_frames(
        self,
        source: FrameSource,
        state: PublishedState,
        past: PublishedState | None,
        other: bool,
        sent: bool,
    ) -> None:
        """Send what is new of the streams of one source."""
        for stream in [s for s in self.page.streams.values() if s.other == other]:
            news = stream.news(source, past)
            if news is not None:
                await self._text(news)
                sent = True
            trace = None if stream.request is None else source.trace(stream.request)
            more = sent or (trace is not None and source.present() is None)  # a record is being read
            data = stream.frame(state, trace) if more else None
            if data is not None:
                self._spoke = True
                await _to_socket(self._socket.send_bytes(data))

    async def _shown(self, source: FrameSource) -> PublishedState:
        """Return the state that the page shows, after what it asked for, and keep its timeline."""
        page, present = self.page, source.present()
        if page.identity is not source.identity:
            page.identity, page.moment, page.asked = source.identity, None, None
        asked, page.asked = page.asked, None
        kept = page.moment if asked is None else None
        time = kept.time if kept is not None else None if asked is None else asked.time
        if present is not None and time is None:
            page.moment, self._timeline = None, self._moments(source, None)
            return present
        places = self._places(False)
        found = await source.at(
            -math.inf if time is None else time, 0 if asked is None else asked.further, places
        )
        if found is None and present is not None:
            page.moment, self._timeline = None, self._moments(source, None)
            return present
        number, state = found or (0, PublishedState(0, 0.0, 0, {}))
        if kept is not None and present is not None and state.time != kept.time:
            state = kept  # it is older than all that is stored
        page.moment, self._timeline = state, self._moments(source, (number, state.time))
        return state

    def _moments(self, source: FrameSource, at: tuple[int, float] | None) -> TimelineView | None:
        """Return what the page can show, and the number and time of what it shows (None: the present)."""
        span, (unit, step) = source.span(), source.time_unit
        if span is None:
            return None
        return made_of(
            TimelineView,
            span,
            frame=span.frames - 1 if at is None else at[0],
            time=None if at is None else at[1],
            second=1 / unit_seconds(unit),
            step=step,
        )

    async def _news_of_state(self) -> list[Message]:
        project, experiment = self._hub.project, self._hub.experiment
        out: list[Message] = []
        now = project.session, project.history.version
        if (self._session, self._version) != now:
            changes = project.changes_since(self._session, self._version)
            if changes is None:
                whole = await project.opened()
                now = whole.session, whole.version
                self._known.pop(WorldScene, None)  # each document gets the scene of its world
                out += [whole, *self._new(await self._hub.gallery())]
            else:
                out.extend(changes)
            self._session, self._version = now
        out += self._new(*self._hub.topics())
        self._experiment = experiment.version
        rows = experiment.rows_after(*self._rows)
        if rows is not None:
            self._rows = rows.run, rows.first + len(rows.rows)
            out.append(rows)
        return out

    def _news_of_world(self, state: PublishedState) -> list[Message]:
        session, record = self._hub.engine.session, self._hub.project.record
        world = None if session is None or record.reader is not None else session.world
        out = self._new(scene.scene(state.scene, record.scene[1], world))
        model = self._hub.project.history.model
        if model is not None:
            out += self._new(self._hub.embodiment.offered(model.document, world))
        now = time.monotonic()
        if now - self._link_sent >= LINK_EVERY:
            self._link_sent = now
            out += self._new(scene.robot_link(world))
        sent = self.page.sent_bodies
        return out if sent is None else [*out, *sent.news(state)]

    def _new(self, *topics: Message | None) -> list[Message]:
        """Return the messages that the page does not know; it has the latest one of each class."""
        new = [m for m in topics if m is not None and m != self._known.get(type(m))]
        self._known.update((type(m), m) for m in new)
        return new

    async def _text(self, message: Message) -> None:
        self._spoke = True
        await _to_socket(self._socket.send_text(msgspec.json.encode(message).decode()))


async def _to_socket(sending: Awaitable[None]) -> None:
    """Wait until something is sent.

    Raises:
        WebSocketDisconnect: the page has disconnected. The socket itself raises RuntimeError or OSError then,
            which would hide errors of what is to be sent.
    """
    try:
        await sending
    except (RuntimeError, OSError) as error:
        raise WebSocketDisconnect from error


def _refused(request: int, what: str) -> Answer:
    return Answer(request=request, problems=[ListedProblem(what=what)])


def _request(text: str) -> int:
    """Return the number of a malformed request, or 0 if it cannot be read."""
    try:
        number: Any = codec.parse(text)["request"]
    except (ValueError, TypeError, KeyError, RecursionError):
        return 0
    return number if isinstance(number, int) and 0 <= number < 2**31 else 0
