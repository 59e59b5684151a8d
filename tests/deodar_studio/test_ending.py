"""The studio ends while a compilation or a world works, which nothing interrupts."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
import time
from pathlib import Path
from typing import Any

import pytest
import uvicorn

from deodar.errors import DocumentError
from deodar_studio.files import content
from deodar_studio.live.unwaited import UnwaitedThreads
from deodar_studio.project import run
from deodar_studio.web import app, serve
from deodar_studio.web.service import Service
from tests.deodar_studio.page import Page, play, studio

SOON = 30.0
"""Wall time in seconds that a busy machine may need; the work of these tests does not end by itself."""


def test_a_studio_ends_while_a_document_is_compiled(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun, ended = threading.Event(), threading.Event()

    def compiled(*arguments: Any, **options: Any) -> Any:
        begun.set()
        ended.wait()
        raise RuntimeError("nothing is left that takes it")

    monkeypatch.setattr(run, "Session", compiled)
    try:
        with studio(root, root / "node.json"):
            assert begun.wait(SOON)
            since = time.monotonic()
        assert time.monotonic() - since < SOON
    finally:
        ended.set()


def test_a_studio_ends_while_a_change_is_compiled_or_a_world_waits(root: Path) -> None:
    ended = threading.Event()

    async def story(p: Page) -> None:
        await p.runs()
        # as a step of a session whose world waits for a robot
        hubs[0].engine.call(ended.wait)
        hubs[0].engine._compiler.submit(ended.wait)

    hubs: list[Any] = []
    hub_class = app.Hub
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(app, "Hub", lambda *words: hubs.append(hub_class(*words)) or hubs[0])
            with studio(root, root / "node.json") as address:
                play(address, story)
                since = time.monotonic()
        assert time.monotonic() - since < SOON
        assert hubs[0].working()
    finally:
        ended.set()
    while hubs[0].working():
        assert time.monotonic() - since < 2 * SOON


@pytest.mark.parametrize("begins", [True, False], ids=["while it opens", "before it opens"])
def test_a_studio_ends_while_its_first_document_is_opened(
    root: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, begins: bool
) -> None:
    begun, ended, ready = threading.Event(), threading.Event(), list[str]()

    def loaded(*arguments: Any) -> Any:
        begun.set()
        ended.wait()
        raise DocumentError("nothing is left that takes it")

    monkeypatch.setattr(content, "load", loaded)
    server, bound = serve.prepare(Service(root, root / "node.json", port=0), ready.append)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [bound]})
    if not begins:
        server.handle_exit(signal.SIGINT, None)
    thread.start()
    try:
        assert not begins or begun.wait(SOON)
        since = time.monotonic()
        if begins:
            server.handle_exit(signal.SIGINT, None)
        thread.join(SOON)
        assert not thread.is_alive() and time.monotonic() - since < SOON
    finally:
        ended.set()
        thread.join()
        bound.close()
    assert not ready, "the address of a studio that ends is not printed, and no browser is opened"
    assert not caplog.records


def test_threads_that_work_are_told_from_those_that_have_ended() -> None:
    threads, ended = UnwaitedThreads(2), threading.Event()
    assert not threads.working(0.0)
    work = threads.submit(ended.wait)
    waiting = [threads.submit(ended.wait) for _ in range(3)]
    threads.shutdown(wait=True)
    assert threads.working(0.0) and waiting[-1].cancelled()
    ended.set()
    assert work.result(SOON) and not threads.working(SOON)


def test_the_end_rests_motors_before_all_else_and_goes_on_where_a_part_fails(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    seen: list[str] = []
    ended = threading.Event()

    async def story(p: Page) -> None:
        await p.runs()
        await p.do("play")
        hub = hubs[0]
        pool: Any = hub._threads
        for _ in range(pool._max_workers):  # as compilations that nothing interrupts
            pool.submit(ended.wait)

        async def store() -> None:
            while hub.engine.running:
                await asyncio.sleep(0.01)
            seen.append("rests")

        def fail() -> None:
            seen.append("fails")
            raise RuntimeError("no such thread")

        hub.project.store_edits, hub.experiment.end = store, fail

    hubs: list[Any] = []
    hub_class = app.Hub
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(app, "Hub", lambda *words: hubs.append(hub_class(*words)) or hubs[0])
            with studio(root, root / "node.json") as address:
                play(address, story)
    finally:
        ended.set()
    assert seen == ["rests", "fails"] and hubs[0].engine._closed
    assert "no such thread" in capsys.readouterr().err


def test_a_second_signal_skips_nothing_of_the_end() -> None:
    config = uvicorn.Config(lambda: None)
    server = serve.StudioServer(config, WorkingServer())  # type: ignore[arg-type]
    for _ in range(2):
        server.handle_exit(signal.SIGINT, None)
    assert server.should_exit and not server.force_exit


class WorkingServer:
    """A server that was ended by Ctrl-C while a thread works."""

    def run(self, sockets: list[Any]) -> None:
        pass

    def working(self) -> bool:
        return True

    def end(self) -> None:
        pass


def test_the_process_of_a_studio_does_not_wait_for_a_thread(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    statuses: list[int] = []
    monkeypatch.setattr(serve, "prepare", lambda *arguments: (WorkingServer(), None))
    monkeypatch.setattr(os, "_exit", statuses.append)
    serve.serve(Service(tmp_path), False, print)
    assert statuses == [0]
