"""The regime of a field, measured in a worker process while the run continues."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import deodar as dd
from deodar.analysis.regimes import regimes
from tests.deodar_studio.page import Page, play, studio


def regime(p: Page) -> dict[str, Any]:
    return p.said["regime"]


async def found(p: Page) -> dict[str, Any]:
    """Wait until the measurement has ended."""
    await p.until(lambda: regime(p)["element"] and not regime(p)["measuring"])
    return regime(p)


def test_a_field_is_measured_while_it_runs_and_a_change_makes_the_regime_stale(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        assert regime(p)["element"] == "" and not regime(p)["words"]
        await p.do("play")
        await p.do("measure_regime", element=u)
        await p.until(lambda: regime(p)["measuring"])
        assert regime(p)["element"] == u
        one = await found(p)
        assert p.clock["running"] and not one["problems"] and not one["stale"]

        script = regimes(dd.load(root / "selection.json"), "u")
        assert one["words"] == list(script.words)
        rows = {row["name"]: row["text"] for row in one["rows"]}
        assert rows["detection threshold"].startswith(f"{script.detection:.4g} ± ")
        assert one["curve"]["input"] == script.ramp.values.tolist()
        assert max(one["curve"]["up"]) > one["curve"]["threshold"] > one["curve"]["up"][0]

        await p.do("set", element=p.element("left"), parameter="amplitude", value=1.0)
        assert not regime(p)["stale"], "the field is measured without the model's inputs"
        await p.do("set", element=u, parameter="resting_level", value=-9.0)
        await p.until(lambda: regime(p)["stale"])
        assert regime(p)["words"] == one["words"]
        await p.do("measure_regime", element=u)
        two = await found(p)
        assert not two["stale"] and two["rows"] != one["rows"]

    shutil.copy(root / "selection.json", root / "again.json")
    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_measurement_is_stopped_and_ends_with_its_document(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("measure_regime", element=u)
        await p.until(lambda: regime(p)["measuring"])
        await p.do("stop_regime")
        await p.until(lambda: regime(p)["element"] == "")
        # the next one waits for no result of the one that was stopped
        await p.do("measure_regime", element=u)
        await p.open("open_file", path="selection.json")
        await p.until(lambda: regime(p)["element"] == "")
        await p.do("measure_regime", element=p.element("u"))
        assert (await found(p))["words"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_what_cannot_be_measured_is_an_error_with_a_reason(root: Path) -> None:
    async def scene(p: Page) -> None:
        answer = await p.ask("measure_regime", element="none")
        assert "no document is open" in answer["problems"][0]["what"]
        await p.open("open_file", path="selection.json")
        answer = await p.ask("measure_regime", element="none")
        assert "no such element" in answer["problems"][0]["what"]
        await p.do("measure_regime", element=p.element("left"))
        (problem,) = (await found(p))["problems"]
        assert "is not a Field" in problem["what"] and problem["where"] == "left"

    with studio(root) as address:
        play(address, scene)
