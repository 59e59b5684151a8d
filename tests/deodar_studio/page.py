"""A page without a browser that uses the studio's protocol over a real socket."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any, TypeVar
from urllib.parse import urlsplit

import numpy as np
import websockets

from deodar_studio.messages import frames
from deodar_studio.web.serve import prepare
from deodar_studio.web.service import Service

WAIT = 600.0
"""Wall time in seconds after which a wait fails; it is not a measurement."""


@contextlib.contextmanager
def studio(
    root: Path,
    file: Path | None = None,
    host: str = "127.0.0.1",
    trust: bool = False,
    world: Any = None,
    token: bool = True,
    port: int = 0,
    unattended: bool = False,
) -> Iterator[str]:
    """Run a studio in a thread of its own; yield its address, with the token."""
    up: list[str] = []
    ready = threading.Event()

    def say(address: str) -> None:
        up.append(address)
        ready.set()

    server, bound = prepare(Service(root, file, trust, world, host, port, token, unattended), say)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [bound]})
    thread.start()
    try:
        assert ready.wait(WAIT), "the studio did not start"
        yield up[0]
    finally:
        server.should_exit = True
        thread.join(WAIT)
        bound.close()
        assert not thread.is_alive(), "the studio did not stop"


def unpacked(message: bytes) -> tuple[int, int, float, np.ndarray]:
    """Return the stream, number, time and values (flat) of a frame."""
    stream, frame, time = frames.HEADER.unpack_from(message)
    return stream, frame, time, np.frombuffer(message, "<f4", offset=frames.HEADER.size)


def applied(before: Any, difference: dict[str, Any]) -> Any:
    """Return an object or a list after a difference of the message `edited`."""
    after = {str(k): v for k, v in enumerate(before)} if isinstance(before, list) else dict(before)
    for key, inside in difference.get("inside", {}).items():
        after[key] = applied(after[key], inside)
    for key in difference.get("removed", []):
        del after[key]
    changed = difference.get("changed", {})
    if not isinstance(before, list):
        return after | changed
    entries = list(after.values())
    for index, entry in changed.items():
        entries.insert(int(index), entry)
    return entries


class Page:
    """A page and its present state; `draws=False` simulates a page that has stalled."""

    def __init__(self, socket: Any, draws: bool = True) -> None:
        self.socket, self.draws = socket, draws
        self.said: dict[str, dict[str, Any]] = {}
        self.all: list[dict[str, Any]] = []
        self.frames: dict[int, tuple[float, np.ndarray]] = {}
        self.samples: dict[int, list[tuple[float, float]]] = {}
        self.rows: dict[int, np.ndarray | None] = {}
        self.forms: dict[int, dict[str, Any]] = {}
        self.lost: dict[int, dict[str, Any]] = {}
        self.clocks = 0
        self._request = 0
        self._answers: dict[int, dict[str, Any]] = {}
        # whether messages arrived since the last clock: a clock ends each group of messages
        self._late = False
        self._news = asyncio.Event()

    async def listen(self) -> None:
        """Read messages until the connection ends."""
        async for message in self.socket:
            if isinstance(message, bytes):
                stream, _, time, values = unpacked(message)
                if stream in self.rows:
                    self._take_rows(stream, time, values)
                elif self.forms[stream]["shape"] == [2] and not self.forms[stream]["axes"]:
                    self.samples.setdefault(stream, []).extend(
                        (time + a, b) for a, b in values.reshape(-1, 2).tolist()
                    )
                else:
                    self.frames[stream] = (time, values.reshape(self.forms[stream]["shape"]))
            else:
                await self._take(json.loads(message))
            self._news.set()

    def _take_rows(self, stream: int, time: float, values: np.ndarray) -> None:
        rows = values.reshape(-1, *self.forms[stream]["shape"]).astype(float)
        rows[:, 0] += time
        before = self.rows[stream]
        self.rows[stream] = rows if before is None else np.concatenate([before, rows])

    async def _take(self, m: dict[str, Any]) -> None:
        self.all.append(m)
        self.said[m["type"]] = m
        if m["type"] == "answer":
            self._answers[m["request"]] = m
            self._late = True
        elif m["type"] == "announced":
            self.forms[m["stream"]] = m
            self.frames.pop(m["stream"], None)
        elif m["type"] == "lost":
            self.lost[m["stream"]] = m
        elif m["type"] == "opened":
            self._late = True
        elif m["type"] == "edited":
            self._late = True
            document = applied(self.document, m["difference"])
            self.said["opened"] = self.said["opened"] | {"document": document, "version": m["version"]}
        elif m["type"] == "clock":
            self.clocks += 1
            self._late = False
            if self.draws:
                await self.send(type="drawn", frame=m["frame"])

    async def send(self, **message: Any) -> None:
        """Send a message."""
        if message["type"] == "rows" and isinstance(message.get("stream"), int):
            self.rows[message["stream"]] = None
        await self.socket.send(json.dumps(message))

    async def ask(self, type: str, **message: Any) -> dict[str, Any]:
        """Send a request and wait for the answer."""
        self._request += 1
        number = self._request
        await self.send(type=type, request=number, **message)
        await self.until(lambda: number in self._answers and not self._late)
        return self._answers.pop(number)

    async def do(self, type: str, **message: Any) -> dict[str, Any]:
        """Send a request that must succeed."""
        answer = await self.ask(type, **message)
        assert not answer["problems"] and not answer["ask"], answer
        return answer

    async def until(self, condition: Callable[[], Any]) -> Any:
        """Wait until a condition holds."""

        async def wait() -> Any:
            while not (found := condition()):
                self._news.clear()
                await self._news.wait()
            return found

        return await asyncio.wait_for(wait(), WAIT)

    # the state of the page

    @property
    def document(self) -> dict[str, Any]:
        return self.said["opened"]["document"]

    @property
    def clock(self) -> dict[str, Any]:
        return self.said["clock"]

    def element(self, path: str) -> str:
        """Return the id of an element."""
        return next(e["id"] for e in self.document["elements"] if e["path"] == path)

    async def open(self, type: str, **message: Any) -> None:
        """Open a document and wait until it can run."""
        await self.do(type, **message)
        await self.runs()

    async def runs(self) -> None:
        """Wait until the open document is compiled."""
        await self.until(
            lambda: self.said.get("opened", {}).get("document") and not self._late and not self.clock["busy"]
        )


P = TypeVar("P", bound=Page)


@contextlib.asynccontextmanager
async def page(address: str, draws: bool = True, kind: type[P] = Page, **options: Any) -> AsyncIterator[P]:  # type: ignore[assignment]
    """Connect to a studio."""
    there = urlsplit(address)
    async with websockets.connect(
        f"ws://{there.netloc}/ws?{there.query}", max_size=None, **options
    ) as socket:
        one = kind(socket, draws)
        listening = asyncio.create_task(one.listen())
        try:
            await one.until(lambda: "clock" in one.said)
            yield one
        finally:
            listening.cancel()
            with contextlib.suppress(asyncio.CancelledError, websockets.ConnectionClosed):
                await listening


def play(address: str, scene: Callable[[Page], Coroutine[Any, Any, None]], **options: Any) -> None:
    """Run a scene with one page."""

    async def main() -> None:
        async with page(address, **options) as visitor:
            await scene(visitor)

    asyncio.run(main())
