"""A field is tuned to a regime in a worker process, and its values are applied as one change."""

from __future__ import annotations

from math import nan
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar.analysis.regimes import regimes
from deodar_studio.field_analysis.field_tuning import sentence
from tests.deodar_studio.page import Page, play, studio

WANTED = [{"detects": {"at": 4, "within": 0.5}}, "selects"]
NAMES = ["resting_level", "kernel.0.amplitude", "global_inhibition"]


def tuning(p: Page) -> dict[str, Any]:
    return p.said["tuning"]


async def ended(p: Page) -> dict[str, Any]:
    """Wait until the tuning has ended."""
    await p.until(lambda: tuning(p)["element"] and not tuning(p)["tuning"])
    return tuning(p)


def test_a_field_is_tuned_and_its_values_are_one_change(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        u = p.element("u")
        await p.do("play")
        await p.do("tune_field", element=u, parameters=NAMES, requirements=WANTED)
        await p.until(lambda: tuning(p)["candidates"] > 0 and tuning(p)["tuning"])
        end = await ended(p)
        assert p.clock["running"] and not end["problems"] and not end["applied"]
        assert [r["text"] for r in end["requirements"]] == ["detects(at=4, within=0.5)", "selects()"]
        assert all(r["margin"] >= 0 for r in end["requirements"]) and end["tolerated"] > 0
        first, second = (r["sentence"] for r in end["requirements"])
        assert first.startswith("The detection threshold is ") and first.endswith("; you asked for 4 ± 0.5.")
        assert second == "As you asked, two equal inputs end in one peak."
        assert [v["path"] for v in end["values"]] == [f"u.{name}" for name in NAMES]

        before = p.document["undo"]
        await p.do("apply_tuning")
        await p.until(lambda: tuning(p)["applied"])
        assert p.document["undo"] == before + 1, "one change"
        await p.do("save", path="tuned.json")
        model = dd.load(root / "tuned.json")
        assert [model.get(v["path"]) for v in end["values"]] == [v["value"] for v in end["values"]]
        judge = regimes(model, "u")
        assert judge.detection is not None and abs(judge.detection - 4) < 0.5
        assert judge.selection is not None and judge.selection.selects

        await p.do("undo")
        await p.until(lambda: not tuning(p)["applied"])
        await p.do("save", path="undone.json", replace=True)
        assert dd.load(root / "undone.json").get("u.resting_level") == end["values"][0]["before"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)


def test_a_tuning_is_stopped_and_what_it_refuses_is_said(root: Path) -> None:
    async def scene(p: Page) -> None:
        answer = await p.ask("tune_field", element="none", parameters=NAMES, requirements=["selects"])
        assert "no document is open" in answer["problems"][0]["what"]
        await p.open("open_file", path="selection.json")
        answer = await p.ask("apply_tuning")
        assert "nothing was tuned" in answer["problems"][0]["what"]
        u = p.element("u")
        await p.do("tune_field", element=u, parameters=NAMES, requirements=["selects"])
        await p.do("stop_tuning")
        await p.until(lambda: tuning(p)["element"] == "")
        for parameters, requirements, what in (
            (NAMES, ["select"], "there is no 'select' here"),
            (NAMES, [], "expected a list"),
            (["resting_levl"], ["selects"], "resting_levl"),
            (["tau"], ["selects"], "tau"),
            (NAMES, [{"detects": {"at": 3, "within": 0}}], "within"),
        ):
            await p.do("tune_field", element=u, parameters=parameters, requirements=requirements)
            problems = (await ended(p))["problems"]
            assert problems and what in f"{problems[0]['where']} {problems[0]['what']}", problems
            await p.do("stop_tuning")
            await p.until(lambda: tuning(p)["element"] == "")

    with studio(root) as address:
        play(address, scene)


@pytest.mark.parametrize(
    ("requirement", "measured", "met", "expected"),
    [
        (dd.detects(3, 0.2), 3.4, False, "The detection threshold is 3.4; you asked for 3 ± 0.2."),
        (
            dd.detects(3, 0.2),
            None,
            False,
            "The detection threshold is not within 3 ± 0.2, which you asked for.",
        ),
        (dd.detects(3, 0.2), None, True, "The detection threshold is 3 ± 0.2, as you asked."),
        (dd.peak_width(10, 1), 9.96, True, "The width of the peak is 9.96; you asked for 10 ± 1."),
        (dd.detects(3, 1e-3), 3.0024, False, "The detection threshold is 3.0024; you asked for 3 ± 0.001."),
        (
            dd.peak_width(10, 1),
            nan,
            False,
            "The width of the peak could not be measured; you asked for 10 ± 1.",
        ),
        (dd.rests(), None, True, "As you asked, the field has no peak without input."),
        (
            dd.relaxes_within(500),
            812.0,
            False,
            "You asked that a peak vanishes within 500 s after its input; that is not so.",
        ),
        (dd.forgets(), None, False, "You asked that a peak vanishes after its input; that is not so."),
        (dd.multi_peak(), None, True, "As you asked, two equal inputs each have a peak."),
    ],
)
def test_a_requirement_is_reported_in_words(
    requirement: dd.Requirement, measured: float | None, met: bool, expected: str
) -> None:
    assert sentence(requirement, measured, met, "s") == expected
