"""Messages on real time and on costs, over a real socket."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.deodar_studio.conftest import EXAMPLES
from tests.deodar_studio.page import Page, play, studio


def test_the_clock_states_the_lag_of_the_run(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        assert p.clock["overruns"] == p.clock["lag"] == p.clock["lost"] == 0 and p.clock["longest"] is None
        await p.do("speed", factor=1e6)  # more than any machine can do
        await p.do("play")
        await p.until(lambda: p.clock["overruns"] >= 1 and p.clock["lost"] > 0)
        assert p.clock["lag"] > 0 and p.clock["worst"] >= 100 and p.clock["dt"] == 1, (
            "late, and with the steps that were planned"
        )
        await p.do("pause")
        await p.until(lambda: not p.clock["running"] and p.clock["overruns"] == 0)

    with studio(root) as address:
        play(address, scene)


def test_a_step_that_may_grow_grows_and_returns_to_dt_after_a_pause(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.open("open_file", path="selection.json")
        refused = await p.ask("lengthen", longest=100.0)
        assert (
            "longer than the time constant" in refused["problems"][0]["what"] and p.clock["longest"] is None
        )
        await p.do("lengthen", longest=4.0)
        await p.do("speed", factor=1e6)
        await p.do("play")
        await p.until(lambda: p.clock["dt"] == 4 and p.clock["lengthened"] > 0)
        answer = await p.do("set", element=p.element("u"), parameter="tau", value=3.0)
        assert answer["cost"] == "live", "no edit is refused because a step was lengthened"
        await p.until(lambda: p.clock["dt"] == 3)
        await p.do("pause")
        await p.until(lambda: not p.clock["running"] and p.clock["dt"] == 1 and p.clock["longest"] == 4)
        assert p.document["dt"] is None, "the document's own step is untouched"

    with studio(root) as address:
        play(address, scene)


def test_costs_are_measured_during_the_run(root: Path) -> None:
    shutil.copy(EXAMPLES / "projection.json", root)

    async def scene(p: Page) -> None:
        await p.open("open_file", path="projection.json")
        assert p.said["costs"]["elements"] == [] and not p.said["costs"]["measuring"]
        await p.do("play")
        await p.do("measure_costs")
        # a page that is late sees the end of the measurement alone
        await p.until(lambda: p.said["costs"]["measuring"] or p.said["costs"]["step"] > 0)
        tick = p.clock["tick"]
        await p.until(lambda: p.said["costs"]["step"] > 0 and not p.said["costs"]["measuring"])
        await p.until(lambda: p.clock["tick"] > tick)
        assert p.clock["running"] and not p.clock["failure"]
        rows = p.said["costs"]["elements"]
        assert {e["id"] for e in p.document["elements"]} <= {row["element"] for row in rows}
        assert rows[0]["us"] == max(row["us"] for row in rows) > 0 and not p.said["costs"]["problems"]
        await p.open("open_file", path="selection.json", discard=True)
        await p.until(lambda: p.said["costs"]["elements"] == [])

    with studio(root) as address:
        play(address, scene)


def test_measuring_costs_without_a_document_is_an_error(root: Path) -> None:
    async def scene(p: Page) -> None:
        for request in ({"type": "measure_costs"}, {"type": "lengthen", "longest": 2.0}):
            answer = await p.ask(**request)
            assert "no document is open" in answer["problems"][0]["what"]

    with studio(root) as address:
        play(address, scene)
