"""Pages that edit one document at once lose nothing."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import deodar as dd
from deodar_studio.project.change_queue import ChangeQueue
from tests.attacks import edits
from tests.deodar_studio.page import page, studio


def test_simultaneous_edits_of_two_pages_are_both_kept(tmp_path: Path) -> None:
    rounds = 20

    async def main(address: str) -> None:
        async with page(address) as a, page(address) as b:
            await a.runs()
            await b.runs()
            u, v = a.element("u"), a.element("v")
            for k in range(rounds):
                await asyncio.gather(
                    a.do("set", element=u, parameter="tau", value=30 + k),
                    b.do("set", element=v, parameter="tau", value=60 + k),
                )
            await a.do("save")
            assert a.document["undo"] == 0 or a.document["undo"] == 2 * rounds

    dd.save(edits.small(), tmp_path / "m.json")
    with studio(tmp_path, tmp_path / "m.json") as address:
        asyncio.run(main(address))
    model = dd.load(tmp_path / "m.json")
    assert (model.get("u.tau"), model.get("v.tau")) == (30 + rounds - 1, 60 + rounds - 1)


def test_simultaneous_edits_of_eight_pages_equal_the_same_edits_in_sequence(tmp_path: Path) -> None:
    outcome = edits.run(tmp_path, pages=8, edits=400, seed=1)
    assert outcome.differ == [] and outcome.errors == []
    assert outcome.accepted > 200 and outcome.versions > 150


def test_an_edit_that_is_meant_for_another_document_is_refused(tmp_path: Path) -> None:
    """Elements of two documents may have the same id, because it is a hash of the path."""

    async def main(address: str) -> None:
        async with page(address) as a, page(address) as b:
            await a.runs()
            session, u = a.said["opened"]["session"], a.element("u")
            await b.open("open_file", path="other.json")
            expected: list[dict[str, Any]] = [
                {"type": "set", "element": u, "parameter": "tau", "value": 77},
                {"type": "undo"},
            ]
            for edit in [*expected, {"type": "save", "path": "third"}]:
                refused = await a.ask(**edit, session=session)
                assert "another document" in refused["problems"][0]["what"]
            await b.do("set", element=u, parameter="tau", value=44, session=b.said["opened"]["session"])
            await b.do("save")

    for name in ("m", "other"):
        dd.save(edits.small(), tmp_path / f"{name}.json")
    with studio(tmp_path, tmp_path / "m.json") as address:
        asyncio.run(main(address))
    assert dd.load(tmp_path / "other.json").get("u.tau") == 44
    assert not (tmp_path / "third.json").exists()


def test_a_change_is_completed_although_its_page_disconnects() -> None:
    done: list[str] = []

    async def main() -> None:
        queue = ChangeQueue()
        middle = asyncio.Event()

        async def change(name: str) -> None:
            middle.set()
            await asyncio.sleep(0.02)
            done.append(name)

        first = asyncio.create_task(queue.run(lambda: change("first")))
        await middle.wait()
        first.cancel()
        await queue.run(lambda: change("second"))

    asyncio.run(main())
    assert done == ["first", "second"]
