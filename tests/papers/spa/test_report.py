"""The report of rows made by hand: claims hold where they should, fail where they should, and are open where too few runs cannot tell."""

from __future__ import annotations

import json

import pytest

from deodar.analysis.claims import failed, results
from deodar.papers import spa
from deodar.papers.spa.runs import Runs
from deodar.papers.spa.targets import claims
from tests.papers.spa.rows import all_rows


def required(change, quick=False):
    return {c.name: c for c in claims(Runs(all_rows(quick, change), quick))}


def only(found, words):
    """The claims whose names hold all of these words."""
    out = [c for name, c in found.items() if all(w in name for w in words)]
    assert out
    return out


def test_all_required_claims_hold_where_all_goes_as_told():
    found = required(lambda c, k: {})
    assert len(found) == 21
    assert {c.holds for c in found.values()} == {True} and not failed(list(found.values()))
    assert all(c.n >= 20 and c.source for c in found.values())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c, k: {"success": k % 5 > 0} if c.name == "large/planner/high" else {}, ["large maze, high noise", "reaches the goal"]),
        (lambda c, k: {"divergence": 1.3} if c.name == "z/planner/low" else {}, ["Z-maze, low noise", "mean Lp / Lo"]),
        (lambda c, k: {"divergence": 1.18 + 0.001 * (k % 5)} if c.name == "z/planner/high" else {}, ["Z-maze: the medians"]),
        (lambda c, k: {"plan": 250} if c.name == "free/planner/low" else {}, ["plan is complete"]),
        (lambda c, k: {"route": "north"} if c.name == "full/planner/low" else {}, ["full obstacle, low noise", "before t = 130"]),
        (lambda c, k: {"route": "south"} if c.name == "partial/planner/high" else {}, ["partial obstacle, high noise", "t = 200 to 450"]),
        (lambda c, k: {"route": "switch"} if c.name == "full/planner/high" else {}, ["full obstacle, high noise", "after t = 500"]),
    ],
)
def test_what_goes_wrong_is_said(change, words):
    found = required(change)
    for claim in only(found, words):
        assert claim.holds is False
    assert 1 <= len(failed(list(found.values()))) <= 3


def test_few_runs_leave_open_what_they_cannot_tell():
    found = required(lambda c, k: {"success": k % 10 > 0} if c.name == "large/planner/high" else {}, quick=True)
    assert not failed(list(found.values()))
    assert {c.holds for c in only(found, ["case 3, full", "before t = 130"])} <= {None, True}
    wrong = required(lambda c, k: {"success": k % 2 > 0} if c.name == "large/planner/high" else {}, quick=True)
    assert [c.name for c in failed(list(wrong.values()))] == ["large maze, high noise: the planner reaches the goal"]


def test_runs_whose_obstacle_came_down_on_the_robot_are_left_out_and_counted():
    runs = Runs(all_rows(False), False)
    assert len(runs.kept("full", "low")) == 239 and runs.left_out("full", "low") == 1
    assert "| full/planner/low | 239 | 1 |" in spa.report(all_rows(False), False).tables["conditions"]


def test_every_sentence_has_a_number_and_all_figures_are_drawn():
    report = spa.report(all_rows(False), False)
    said = [c for c in report.claims if c.kind == "reported"]
    assert len(said) > 40 and all(c.source.startswith("Billing") for c in said)
    silent = [c.name for c in said if c.value is None]
    # nothing failed, all values of a kind are alike: these have no number
    assert all("failures" in name or "sticks" in name or "ANOVA" in name or "F of" in name for name in silent), silent
    assert set(report.figures) == {
        f"figure-{n}" for n in ("7-success", "8-divergence", "9-paths", "13-routes", "14-velocity", "15-partial", "16-full")
    }
    assert json.loads(results(report.claims, {"quick": False}))["settings"] == {"quick": False}


def test_a_part_of_the_runs_gives_a_part_of_the_report():
    rows = {k: r for k, r in all_rows(True).items() if k.startswith("z/")}
    report = spa.report(rows, True)
    assert set(report.figures) == {"figure-7-success", "figure-8-divergence"}
    assert all(line.startswith(("| z/", "| cond", "|---")) for line in report.tables["conditions"].splitlines())
