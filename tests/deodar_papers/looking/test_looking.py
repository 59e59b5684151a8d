"""The experiment on looking: tests of a map, claims that can fail, and the demonstration."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar_papers import looking
from deodar_papers.looking import conditions, gazes, narrative, targets, trials
from tests.command_line import typed
from tests.deodar_robots.eye.test_looking import true_map

SAMPLES = (32, 25)


def test_the_true_map_passes_its_test_and_a_silent_one_does_not() -> None:
    right = gazes.summary(gazes.test("correcting", true_map(), 1, 40, dd.PanTilt(), SAMPLES))
    assert right["near"] == 40 and right["median"] < 3
    silent = gazes.summary(gazes.test("correcting", np.zeros_like(true_map()), 1, 40, dd.PanTilt(), SAMPLES))
    assert silent["near"] <= 6


def test_the_true_map_fails_with_another_gain() -> None:
    errors = gazes.test("paper", true_map(), 1, 40, dd.PanTilt(gain=0.1), SAMPLES)
    assert gazes.summary(errors)["near"] < 30


def test_a_run_learns_until_the_last_gaze_and_repeats(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gazes, "SLICE", 2000)
    model = gazes.observed("correcting", seed=3)
    runs = [gazes.learn(model, dd.Eye(), 3, (5, 20)) for _ in range(2)]
    for run in runs:
        assert len(run.ends) >= 20 and set(run.maps) == {5, 20} and len(run.arrivals) == len(run.ends)
        assert 0.6 < run.seconds / len(run.ends) < 4
        assert run.maps[20].shape == (25, 25, 32, 32)
    assert np.array_equal(runs[0].maps[20], runs[1].maps[20])
    assert np.array_equal(runs[0].arrivals, runs[1].arrivals)


def test_onsets_are_upward_crossings() -> None:
    assert gazes.onsets(np.array([-1, 1, 2, -1, 0, 0.1, -3])).tolist() == [1, 5]


def test_a_summary_counts_a_missing_gaze_as_a_miss() -> None:
    summary = gazes.summary(np.array([1.0, np.nan, 11.0, 30.0]))
    assert summary == {"tests": 4, "near": 2, "close": 1, "no gaze": 1, "median": 20.5}


def test_the_design_has_other_seeds_than_tuning() -> None:
    seeds = {job.arguments["seed"] for job in looking.jobs(False)}
    assert seeds == set(range(11, 31)), "tuning used 1 to 8"
    of = [job for job in looking.jobs(False) if job.arguments["condition"] == "correcting"]
    assert len(of) == 10 and len(of[0].keys) == 4 + 3 * 2


def rows(near: dict[str, int]) -> dict[str, dict]:
    """Return rows in which each condition has a number of near tests; others have 150 of 150."""
    out = {}
    for name, condition in conditions.tested(False).items():
        count = near.get(name, 150 if "no reward" not in name else 3)
        for seed in condition.seeds:
            errors = [4.0] * count + [50.0] * (150 - count)
            out[f"{name}/{seed}"] = {
                "key": f"{name}/{seed}",
                "condition": name,
                "seed": seed,
                "gazes": int(name.split("/")[1].split()[0]),
                "seconds": 900.0,
                **gazes.summary(np.asarray(errors)),
                "errors": errors,
            }
    return out


def test_claims_hold_for_good_runs_and_each_can_fail() -> None:
    good = targets.claims(rows({}), False)
    assert all(c.holds for c in good if c.kind == "required") and len(good) > 9
    wrong = {
        "correcting/1500 gazes": 140,
        "correcting, gain x0.8/500 gazes": 140,
        "correcting, gain x1.2/500 gazes": 140,
        "correcting, gain x1/500 gazes": 140,
        "paper/3000 gazes": 80,
        "no reward/3000 gazes": 16,
    }
    for name, count in wrong.items():
        failed = [c for c in targets.claims(rows({name: count}), False) if c.holds is False]
        assert len(failed) == 1, name
    bad = rows({})
    bad["correcting/1500 gazes/11"] = {**bad["correcting/1500 gazes/11"], "near": 134}
    assert [c.name for c in targets.claims(bad, False) if c.holds is False] == [
        "correcting, 1500 gazes: every seed within 12 pixels"
    ]
    far = rows({})
    for row in far.values():
        row["errors"] = [8.0] * 150
    assert [c.target for c in targets.claims(far, False) if c.holds is False] == ["<= 6"]


def test_the_tables_name_every_condition() -> None:
    text = targets.table(rows({}), False)
    assert len(text.splitlines()) == 2 + len(conditions.tested(False))
    numbers = targets.numbers(rows({}), False)
    assert numbers["share:paper/3000"] == "1.000" and numbers["gaze"] == "0.60 s"
    assert targets.numbers({}, False)["share:paper/3000"] == targets.NOT_RUN


def test_rows_of_a_run_have_the_keys_of_their_job(monkeypatch: pytest.MonkeyPatch) -> None:
    small = conditions.LearningRun("paper", (4, 8), (1,), {"reward": False})
    monkeypatch.setattr(trials, "conditions", lambda quick: {"small": small})
    monkeypatch.setattr(trials, "TESTS", 6)
    monkeypatch.setattr(gazes, "SLICE", 2000)
    [job] = trials.jobs(True)
    record = job.run()
    assert tuple(row["key"] for row in record) == job.keys
    json.dumps(record)
    assert len(record[0]["errors"]) == 6 and np.shape(record[-1]["map"]["pan"]) == (25, 32)
    assert np.shape(record[-1]["course"]["end"]) == (400, 6)


def test_the_demonstration_writes_a_figure_and_a_model_that_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(narrative, "TESTS", 40)
    monkeypatch.setattr(gazes, "SLICE", 3000)
    command = typed("demo looking --gazes 30 --mechanism paper")
    assert command.status == 0, command.err
    out = tmp_path / "demo-looking-001"
    claims = json.loads((out / "results.json").read_text())["claims"]
    assert [c["holds"] for c in claims] == [True, None]
    assert (out / "looking.png").stat().st_size > 50_000
    model = dd.load(out / "looking.deodar")
    weights = model["map"].start
    assert np.shape(weights) == (25, 25, 32, 32)
    session = dd.Session(model, world=dd.Eye())
    session.run(500)
    assert session.read("perceptual.output").max() > 0.5
    assert "after 30 gazes" in command.out.splitlines()[-1]


@pytest.mark.parametrize(("option", "says"), [("--mechanism papre", "One of"), ("--gazes 0", "1 or more")])
def test_wrong_options_of_the_demonstration_are_refused(
    option: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    command = typed(f"demo looking {option}")
    assert command.status != 0 and says in command.words
    assert not list(tmp_path.iterdir())


def test_the_claims_of_the_demonstration_can_fail() -> None:
    start = gazes.Learned({5: true_map()}, np.zeros(5, int), np.zeros(5), {}, 5.0)
    tests = [np.full(100, 4.0), np.full(100, 90.0)]
    looked = narrative.Looked("correcting", 0, (0, narrative.GAZES), tests, start)
    assert [c.holds for c in narrative.claims(looked)] == [False, False]
    assert narrative.sentence(looked).startswith("Gazes that end within 12 pixels of the target: 100 %")
