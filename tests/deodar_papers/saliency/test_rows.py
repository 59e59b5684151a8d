"""Rows of the saliency paper, one for each cue; claims and figure are computed from them alone."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
import xarray

from deodar.experiments.rows import Row
from deodar_papers import papers
from deodar_papers.saliency import targets, trials
from deodar_papers.saliency.scenes import CueScene, Outcome, SceneResult

PAPER = papers.PAPERS["saliency"]


def ideal(scene: CueScene) -> SceneResult:
    """Return the result that the marks require: a peak in the middle of the region of a present colour,
    else none.
    """
    outcomes: list[Outcome] = []
    for cue in scene.cues:
        corners = [p for outline in cue.outlines[:1] for p in outline]
        places = tuple(p for p in [inside(cue.holds, scene)] if corners)
        at = places[0] if places else (40.0, 40.0)
        outcomes.append(Outcome(cue, places, places, places, at, 0.5 if places else None, 0.0))
    return SceneResult(scene, -1.0, tuple(outcomes), record=xarray.Dataset())


def inside(holds: Callable[[tuple[float, float]], bool], scene: CueScene) -> tuple[float, float]:
    """Return a pixel in a region."""
    width, height = scene.picture.size
    found = ((float(x), float(y)) for x in range(0, width, 5) for y in range(0, height, 5) if holds((x, y)))
    return next(found, (0.0, 0.0))


@pytest.fixture
def rows(monkeypatch: pytest.MonkeyPatch) -> dict[str, Row]:
    """Return the rows of three photographs, read from a file."""
    monkeypatch.setattr(trials, "run_scene", ideal)
    quick_rows = [row for job in PAPER.jobs(True) for row in job.run()]
    return {row["key"]: row for row in json.loads(json.dumps(quick_rows))}


def test_claims_of_rows_are_those_of_the_runs(rows: dict[str, Row]) -> None:
    direct = [claim for scene in trials.scenes(True) for claim in targets.claims(ideal(scene))]
    report = PAPER.report(rows, True)
    assert report.claims == direct and all(c.holds for c in direct)
    assert list(report.figures) == ["overview"]


def test_a_photograph_without_all_of_its_rows_is_undecided(rows: dict[str, Row]) -> None:
    first = next(iter(rows))
    report = PAPER.report({key: row for key, row in rows.items() if key != first}, True)
    name = rows[first]["condition"]
    assert {c.holds for c in report.claims if c.name.startswith(name)} == {None}
    assert {c.holds for c in report.claims if not c.name.startswith(name)} == {True}


def test_required_claims_of_the_untuned_photographs_are_undecided_until_all_have_run(
    monkeypatch: pytest.MonkeyPatch, rows: dict[str, Row]
) -> None:
    monkeypatch.setattr(trials, "run_scene", ideal)
    whole = {row["key"]: row for job in PAPER.jobs(False) for row in job.run()}
    required = [c for c in PAPER.report(whole, False).claims if c.kind == "required"]
    assert [(c.value, c.holds) for c in required] == [(12, True), (12, True)]
    undecided = [c for c in PAPER.report(rows, False).claims if c.kind == "required"]
    assert [(c.value, c.holds) for c in undecided] == [(None, None), (None, None)]
