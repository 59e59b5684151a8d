"""The history of the open document without a run, a file or a page."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

import deodar as dd
from deodar.errors import DocumentError, ModelError, ParameterError
from deodar.model import edit
from deodar.model.document import Document
from deodar_studio.messages.to_page import KeyedDifference
from deodar_studio.project.change_queue import ChangeQueue
from deodar_studio.project.conversions import Conversions
from deodar_studio.project.history import DocumentHistory
from deodar_studio.views import view


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


def test_a_drag_that_ends_where_it_began_is_no_step_of_undo() -> None:
    async def scene() -> None:
        h = history()
        await h.describe({"notes": "before"})
        for moved in (30.0, 20.0):
            await h.set("0000000a", "tau", moved, "drag")
        assert h.model is not None and h.model.history.depth == 1
        await h.set("0000000a", "tau", 40.0, "drag")  # the same drag continues
        assert tau(h) == 40.0 and h.model.history.depth == 2
        await h.undo()
        assert tau(h) == 20.0 and h.document().notes == "before"
        await h.undo()
        assert h.document().notes == "" and not h.unsaved

    asyncio.run(scene())


def test_a_page_that_lags_receives_the_changes_that_it_lacks() -> None:
    async def scene() -> None:
        h = history()
        await h.set("0000000a", "tau", 30.0, None)
        await h.change(lambda doc: dd.Model(document=doc).document)
        await h.describe({"notes": "more"})
        lacking = h.changes_since(0)
        assert lacking is not None
        single, edited = lacking
        assert single.version == 1
        assert single.difference.inside["elements"].inside["0"].inside["values"] == KeyedDifference(
            changed={"tau": 30.0}
        )
        assert single.difference.changed == {"unsaved": True, "undo": 1, "redo": 0}
        assert edited.difference.changed == {"notes": "more", "unsaved": True, "undo": 2, "redo": 0}
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


def test_axes_that_were_added_since_stay_when_the_run_returns_to_a_moment() -> None:
    async def scene() -> None:
        h = history()
        x, y, z = (dd.Axis(name, 0, 10, samples=11) for name in "xyz")
        await h.change(lambda doc: edit.add_axis(doc, x))
        await h.change(lambda doc: edit.add_axis(doc, z))
        then = h.document()
        await h.change(lambda doc: edit.add_axis(doc, y))
        await h.change(lambda doc: edit.add(doc, dd.Field("v", [x]))[0])
        await h.change(lambda doc: edit.remove_axis(doc, z))
        h.follow(then)
        assert h.document().spare_axes == (y, x) and len(h.document().entries) == 1
        await h.undo()
        assert h.document().spare_axes == (y,)

    asyncio.run(scene())


def looped() -> dd.Model:
    """Return a loop of two gains, in which no connection can read the step before."""
    model = dd.Model("loop")
    a, b = model.add(dd.Gain(name="a")), model.add(dd.Gain(name="b"))
    model.connect(a, b)
    model.connect(b, a)
    return model


def mismatched() -> dd.Model:
    """Return two fields over axes of other names."""
    model = dd.Model("mismatched")
    source = model.add(dd.Field("u", [dd.Axis("x", 0, 10, 11)]))
    model.connect(source, model.add(dd.Field("v", [dd.Axis("z", 0, 10, 11)])))
    return model


@pytest.mark.parametrize(
    ("make", "repair"), [(looped, "Remove the connection"), (mismatched, "Rename the axis by a coupling")]
)
def test_the_repair_that_is_listed_solves_its_problem(make: Callable[[], dd.Model], repair: str) -> None:
    async def scene() -> None:
        h = history()
        h.open(make())
        conversions = Conversions(lambda doc: ((), ()))
        listed = view.problems(conversions.of(h.document()).problems, h.document())
        assert {p.repair for p in listed} == {repair}
        problem = listed[0]
        await h.repair(problem.where, problem.what)
        assert problem.what not in [p.what for p in conversions.problems(h.document())]
        with pytest.raises(ModelError, match="the document has changed"):
            await h.repair("u", "is solved")

    asyncio.run(scene())
