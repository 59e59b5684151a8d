"""The run of the open document without its history, file or page."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager

import pytest

import deodar as dd
from deodar.errors import DocumentError, Problem
from deodar.model import edit
from deodar.model.document import Document
from deodar_studio.live.engine import Engine
from deodar_studio.project.change_queue import ChangeQueue
from deodar_studio.project.conversions import Conversions
from deodar_studio.project.run import DocumentRun
from deodar_studio.world.embodiment import Embodiment

WAIT = 60.0


class Scene:
    """A run and its engine."""

    def __init__(self, problems: Callable[[Document], Sequence[Problem]]) -> None:
        self.news, self.queue = asyncio.Event(), ChangeQueue()
        self.engine = Engine(lambda: None)
        self.run = DocumentRun(
            self.engine,
            Embodiment(),
            Conversions(lambda doc: (problems(doc), ())),
            self.queue,
            lambda times: None,
            self.news.set,
        )

    async def ready(self) -> None:
        async with asyncio.timeout(WAIT):
            while self.run.busy:
                self.news.clear()
                await self.news.wait()


@asynccontextmanager
async def scene(problems: Callable[[Document], Sequence[Problem]] = lambda doc: ()) -> AsyncIterator[Scene]:
    made = Scene(problems)
    try:
        yield made
    finally:
        await asyncio.to_thread(made.engine.close)


def model(tau: float = 20.0) -> dd.Model:
    network = dd.Model("m")
    network.add(dd.RateNode("u", tau=tau), id="0000000a")
    return network


def test_a_document_is_compiled_and_the_engine_continues_with_its_changes() -> None:
    async def act() -> None:
        async with scene() as s:
            opened = model()
            with pytest.raises(DocumentError, match="no document is open"):
                s.run.require()
            s.run.open(opened)
            assert s.run.busy == "compiling"
            await s.ready()
            assert s.engine.session is not None and not s.run.failures()
            changed = edit.put(opened.document, "0000000a", "tau", 40.0)
            assert await s.run.adopt(changed) == "live"
            assert s.engine.session.document == changed
            await s.run.close()
            assert s.engine.session is None and s.run.model is None

    asyncio.run(act())


def test_a_document_with_problems_runs_after_the_edit_that_removes_them() -> None:
    wrong = Problem("u", "is too slow")

    def problems(doc: Document) -> Sequence[Problem]:
        return [wrong] if dd.Model(document=doc).get("u.tau") > 100 else ()

    async def act() -> None:
        async with scene(problems) as s:
            opened = model(tau=200.0)
            s.run.open(opened)
            assert not s.run.busy and s.engine.session is None
            with pytest.raises(DocumentError, match="is too slow"):
                s.run.require()
            opened.set("u.tau", 30.0)
            assert await s.run.adopt(opened.document) == "recompile"
            await s.ready()
            assert s.engine.session is not None
            assert await s.run.adopt(edit.put(opened.document, "0000000a", "tau", 40.0)) == "live"

    asyncio.run(act())


def test_what_was_compiled_for_a_document_that_was_closed_is_not_loaded() -> None:
    async def act() -> None:
        async with scene() as s:
            s.run.open(model())
            await s.run.close()
            s.run.open(network := model(tau=50.0))
            await s.ready()
            assert s.engine.session is not None and s.engine.session.document == network.document

    asyncio.run(act())


def test_the_engine_returns_to_a_snapshot() -> None:
    async def act() -> None:
        async with scene() as s:
            s.run.open(opened := model())
            await s.ready()
            snapshot = await s.run.snapshot()
            await s.run.adopt(edit.put(opened.document, "0000000a", "tau", 40.0))
            assert await s.run.return_to_snapshot(snapshot) == opened.document

    asyncio.run(act())
