"""Rows of real runs: one condition of the carrot, and the first steps of a run of the planner."""

from __future__ import annotations

import dataclasses as dc
import json
import lzma

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.robot_paths import path_length
from deodar_papers.spa import cases, trials
from deodar_papers.spa.condition_runs import Runs
from tests.house.source import ROOT


@pytest.fixture
def four(monkeypatch):
    """Return the design with the first four runs of each condition."""
    short = {name: dc.replace(c, trials=c.trials[:4]) for name, c in cases.conditions(True).items()}
    monkeypatch.setattr(cases, "conditions", lambda quick: short)


def test_following_the_carrot_reaches_the_goals(four):
    rows = trials.carrot("z/carrot/low", True)
    assert [r["key"] for r in rows] == [
        "z/carrot/low/000",
        "z/carrot/low/002",
        "z/carrot/low/003",
        "z/carrot/low/004",
    ]
    for r in rows:
        assert r["success"] and 0.95 < r["divergence"] < 3 and r["steps"] >= r["arrival"] + trials.STAY - 1
        assert r["length"] == pytest.approx(path_length(r["path"]), rel=0.03) and r["clearance"] >= 3.69
    assert json.loads(json.dumps(rows, allow_nan=False)) == rows
    assert Runs({r["key"]: r for r in rows}, True).divergences("z/carrot/low").shape == (4,)
    assert trials.carrot("z/carrot/low", True) == rows


def test_a_run_of_the_planner_gives_a_row(monkeypatch):
    monkeypatch.setattr(trials, "LIMIT", 4)
    [row] = trials.planner("full/planner/low", True, 2)
    assert row["key"] == "full/planner/low/002" and row["steps"] == 4 and not row["success"]
    assert row["plan"] is None and row["moved"] is None and row["opposed"] == 0 and row["route"] == "none"
    assert (row["onset"], row["duration"]) == tuple(cases.windows("full")[2]) and not row["on_robot"]
    assert row["shortest"] == pytest.approx(104.1, abs=0.1)
    assert json.loads(json.dumps(row, allow_nan=False)) == row
    assert trials.planner("full/planner/low", True, 2) == [row]


def test_behaviours_are_listed_in_the_order_of_their_intentions():
    zeros = np.zeros((300, 4))
    zeros[10:100, 0] = zeros[80:200, 2] = zeros[200:210, 3] = zeros[220:260, 1] = zeros[270:300, 0] = 1.0
    assert trials._order(zeros) == ["north", "west", "south", "north"]


def test_jobs_cover_the_design():
    jobs = trials.jobs(True)
    keys = {key for job in jobs for key in job.keys}
    assert keys == {c.key(k) for c in cases.conditions(True).values() for k in c.trials}
    assert {job.function for job in jobs} == {trials.carrot, trials.planner}


def test_the_second_location_is_where_the_stored_run_is_at_step_500():
    """Figures 10 and 11 of the paper; positions of a stored run, samples of the fields 1 cm apart."""
    with lzma.open(ROOT / "evidence" / "spa" / "runs.jsonl.xz", "rt") as rows:
        row = next(r for r in map(json.loads, rows) if r.get("condition") == "narrative/planner/low")
    assert row["trial"] == 0
    model = dd.Model("field")
    axes = [dd.Axis("x", -104, -5, samples=100), dd.Axis("y", 5, 104, samples=100)]
    model.add(dd.Field("motivation", axes))
    grids = np.meshgrid(*(axis.points for axis in axes), indexing="ij")
    for grid, robot in zip(grids, row["path"][500 // trials.KEPT], strict=True):
        assert trials._at(model, "motivation.activation", grid[None]) == pytest.approx(robot, abs=1.0)
