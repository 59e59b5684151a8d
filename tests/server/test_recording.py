"""A page records the run, over a real socket."""

from __future__ import annotations

from pathlib import Path

import deodar as dd
from deodar.recording.record import about
from tests.server.page import Page, play, studio


def test_a_page_records_the_run_and_stops_it(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        assert p.clock["recording"] is None
        await p.do("start_record", ports=[{"element": p.element("u"), "port": "output"}], every=2)
        await p.do("step", n=10)
        await p.until(lambda: p.clock["tick"] == 10)
        assert p.clock["recording"] == {"path": "selection-001", "ended": ""}
        again = await p.ask("start_record")
        assert "recorded already" in again["problems"][0]["what"]
        await p.do("stop_record")
        await p.until(lambda: p.clock["recording"]["ended"] == "closed")
        found = dd.open_record(root / "selection-001")
        assert list(found.data_vars) == ["u.output"] and found["time"].values.tolist() == [0, 2, 4, 6, 8, 10]
        await p.do("start_record")
        await p.do("step", n=3)
        await p.until(lambda: p.clock["tick"] == 13)
        await p.do("reset")
        await p.until(lambda: "reset" in p.clock["recording"]["ended"])
        found = dd.open_record(root / "selection-002")
        assert list(found.data_vars) == ["u.activation"] and not about(found)["complete"]

    with studio(root) as address:
        play(address, scene)


def test_a_record_is_complete_when_the_document_is_closed(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        await p.do("start_record", ports=[])
        await p.do("step", n=5)
        await p.until(lambda: p.clock["tick"] == 5)
        await p.do("close")
        await p.until(lambda: p.clock["recording"] is None)
        found = dd.open_record(root / "selection-001")
        assert found.sizes["time"] == 6 and about(found)["complete"]

    with studio(root) as address:
        play(address, scene)
