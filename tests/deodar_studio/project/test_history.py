"""The history of the open document without a run, a file or a page."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

import deodar as dd
from deodar.errors import DocumentError, ParameterError
from deodar.model.document import Document
from deodar_studio.messages.to_page import Changed, Edited
from deodar_studio.project.change_queue import ChangeQueue
from deodar_studio.project.conversions import Conversions
from deodar_studio.project.history import DocumentHistory


async def accepts(doc: Document) -> Any:
    return "live"


def history(
    adopt: Callable[[Document], Awaitable[Any]] = accepts, record: str | None = None
) -> DocumentHistory:
    """Return the history of a document with one node, saved as it is at the start."""
    model = dd.Model("m")
    model.add(dd.RateNode("u", tau=20.0), id="0000000a")
    saved = model.document
    made = DocumentHistory(
        ChangeQueue(), Conversions(lambda doc: ((), ())), adopt, lambda doc: doc is not saved, lambda: None
    )
    made.open(dd.Model(document=saved), record)
    return made


def tau(h: DocumentHistory) -> Any:
    assert h.model is not None
    return h.model.get("u.tau")


def test_changes_of_one_gesture_are_one_step_of_undo() -> None:
    async def scene() -> None:
        h = history()
        for value in (30.0, 40.0, 50.0):
            await h.set("0000000a", "tau", value, "drag")
        assert tau(h) == 50.0 and h.unsaved and h.version == 3
        await h.undo()
        assert tau(h) == 20.0 and not h.unsaved
        await h.redo()
        assert tau(h) == 50.0

    asyncio.run(scene())


def test_a_page_that_lags_receives_the_changes_that_it_lacks() -> None:
    async def scene() -> None:
        h = history()
        await h.set("0000000a", "tau", 30.0, None)
        await h.change(lambda doc: dd.Model(document=doc).document)
        await h.describe({"notes": "more"})
        single, edited = h.changes_since(0) or ()
        assert isinstance(single, Changed) and (single.version, single.value, single.undo) == (1, 30.0, 1)
        assert isinstance(edited, Edited) and edited.general is not None and edited.general.notes == "more"
        assert h.changes_since(1) == [edited]
        h.touch()
        assert h.changes_since(2) is None, "it needs the whole document"

    asyncio.run(scene())


def test_a_document_that_the_run_refuses_is_not_in_the_history() -> None:
    async def refuses(doc: Document) -> Any:
        raise ParameterError("too fast")

    async def scene() -> None:
        h = history(refuses)
        with pytest.raises(ParameterError, match="too fast"):
            await h.set("0000000a", "tau", 1.0, None)
        assert tau(h) == 20.0 and h.version == 0
        with pytest.raises(DocumentError, match="no such document parameter"):
            await h.set("", "gain", 1.0, None)

    asyncio.run(scene())


def test_the_document_of_a_record_is_arranged_and_not_changed() -> None:
    async def scene() -> None:
        h = history(record="runs/one")
        with pytest.raises(DocumentError, match="runs/one: is a record"):
            await h.undo()
        await h.arrange({"panels": {"p": 1}}, True)
        assert h.document().layout["panels"] == {"p": 1}
        assert not h.unsaved and h.version == 1

    asyncio.run(scene())


def test_the_document_of_a_run_keeps_name_notes_and_layout() -> None:
    h = history()
    running = dd.Model("other", document=h.document())
    running.set("u.tau", 60.0)
    running.describe(notes="of the run")
    h.follow(running.document)
    assert tau(h) == 60.0 and h.document().notes == "" and h.version == 1
    h.follow(running.document)
    assert h.version == 1, "nothing changed"
