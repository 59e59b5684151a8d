"""One scene and special cases of the design, run: rows are complete and repeat."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar_papers import pointing
from deodar_papers.pointing import photographs, sensitivity, targets, trials
from deodar_papers.pointing.scenes import TUNING, scene
from deodar_papers.pointing.table import Table


def test_the_design_has_the_printed_counts_and_other_seeds_than_tuning():
    quick, whole = pointing.jobs(True), pointing.jobs(False)
    count = lambda jobs, name: sum(job.keys[0].startswith(f"{name}/") for job in jobs)  # noqa: E731
    assert (count(quick, "scene"), count(whole, "scene")) == (20, 200)
    assert all((count(quick, case), count(whole, case)) == (10, 50) for case in trials.CASES)
    changed = sensitivity.changes()
    seeds = [
        job.arguments["seed"]
        for job in whole
        if "seed" in job.arguments and job.arguments.get("condition") not in changed
    ]
    assert min(seeds) > TUNING + 9000
    assert sum(job.arguments.get("condition") in changed for job in whole) == 3 * len(changed)
    keys = [key for job in whole for key in job.keys]
    assert len(set(keys)) == len(keys)


def test_a_scene_is_silent_or_selects_and_reaches_in_order():
    rows = trials.whole_scene("scene", 0, TUNING + 1)
    assert [r["key"] for r in rows[:2]] == ["scene/0 camera", "scene/0 red"]
    assert all(r["peaks"] == 0 for r in rows[:5])
    pairs = {r["key"].partition(" ")[2]: r for r in rows[5:]}
    assert set(pairs) == {"red left", "red right", "green left", "green right"}
    matched = [r for r in pairs.values() if r["matches"] == 1]
    assert len(matched) >= 2 and all(targets.cycled(r) and targets.inside(r) for r in matched)
    none = [r for r in pairs.values() if r["matches"] == 0 and not r["hidden"]]
    assert none and all(targets.silent(r) for r in none)


@pytest.mark.parametrize("case", trials.CASES)
def test_a_special_case_goes_as_it_has_to_and_repeats(case: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(trials, "TEST", TUNING)
    [row] = trials.special(case, 1)
    assert targets.judged(row), row
    if case == "same":  # two cycles without a reset, with the random numbers of scene and noise
        assert trials.special(case, 1) == [row]


def test_the_same_architecture_points_with_another_arm():
    at = Table(scene(TUNING + 1), 1, robot="four")
    assert len(at.world.sense("joint_angles", (), 0.0)[0]) == 4
    [row] = [r for r in trials.whole_scene("robot four", 0, TUNING + 1) if r["key"].endswith("red left")]
    assert targets.cycled(row) and targets.inside(row)


def test_every_live_parameter_is_changed_in_both_directions():
    changed = sensitivity.changes()
    nominal = dd.Session(dd.architectures.pointing(), world=dd.MuJoCo("table"))
    values = {"satisfaction.tau": 160.0, "tool place.sigma": 0.016, "red.tau": 40.0}
    paths = {
        path: value for name, one in changed.items() if name.endswith("-20 %") for path, value in one.items()
    }
    for path, value in values.items():
        assert paths[path] == pytest.approx(value)
    assert len(changed["cue.tau +20 %"]) == 4 and "say red.amplitude" not in paths
    for path, value in paths.items():
        nominal.set(path, value)


def test_a_photograph_has_a_peak_inside_the_object_for_its_colour_and_side_alone():
    assert [scene.name for scene, _, _ in photographs.chosen()] == ["coffee", "astronaut", "fig"]
    pairs = photographs.watch("coffee", "right", 5)
    assert [r["match"] for r in pairs] == [False, True, False, False]
    assert [r["inside"] for r in pairs] == [False, True, False, False]
    assert all((r["highest"] > 0) == r["match"] for r in pairs)
