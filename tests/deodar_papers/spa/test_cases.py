"""The design: the published numbers of runs, pairs with a path, and the published positions and times of
obstacles.
"""

from __future__ import annotations

import numpy as np
import pytest

from deodar.analysis.robot_paths import clearance, path_length, shortest_path
from deodar.architectures.spa import place
from deodar.worlds.arena.arena import Arena
from deodar_papers.spa import cases, pairs, trials


def runs(name, quick=False):
    return len(cases.conditions(quick)[name].trials)


def test_cases_1_and_2_have_five_conditions_of_a_hundred_runs_each():
    for maze, n in (("z", 96), ("large", 100)):
        assert [
            runs(f"{maze}/{m}")
            for m in ("planner/low", "planner/high", "carrot/none", "carrot/low", "carrot/high")
        ] == [n] * 5
    assert cases.conditions(False)["z/planner/low"].left_out == (1, 34, 42, 44)
    assert cases.conditions(False)["large/planner/low"].left_out == ()


def test_case_3_has_240_runs_for_each_obstacle_and_noise():
    assert [runs(f"{o}/planner/{n}") for o in ("full", "partial") for n in ("low", "high")] == [240] * 4
    for what in cases.DRAW:
        drawn = cases.windows(what)
        assert drawn.shape == (240, 2) and (drawn > [30, 2]).all() and (drawn < [700, 500]).all()
        assert drawn[:, 0].min() < 40 and drawn[:, 0].max() > 680 and drawn[:, 1].max() > 490
    assert not np.array_equal(cases.windows("full"), cases.windows("partial"))


def test_quick_takes_the_first_trials_of_each_condition():
    long, short = cases.conditions(False), cases.conditions(True)
    assert list(long) == list(short)
    for name, c in short.items():
        assert c.trials == long[name].trials[: len(c.trials)] and len(c.trials) <= 20


@pytest.mark.parametrize("quick", [True, False])
def test_the_conditions_with_the_shortest_runs_come_first(quick):
    designs = list(cases.conditions(quick).values())
    short = [c.method == "carrot" or c.name.startswith(("free", "narrative", "moved")) for c in designs]
    first = short.index(False)
    assert first > 15 and not any(short[first:])
    assert {c.name.partition("/")[0] for c in designs[:first]} == {"z", "large", "free", "narrative", "moved"}


@pytest.mark.parametrize("maze", ["z", "large"])
def test_pairs_keep_their_distance_and_can_be_reached(maze):
    starts, goals = pairs.pairs(maze)
    on = pairs.reference(maze)
    assert (
        starts.shape == (100, 3) and goals.shape == (100, 2) and (starts[:, 2] == pairs.HEADINGS[maze]).all()
    )
    for k in range(0, 100, 9):
        path = shortest_path(on, starts[k, :2], goals[k])
        # the published pairs come within 1 cm of the rule
        assert (
            path is not None
            and np.linalg.norm(path[0] - starts[k, :2]) < 1.5
            and np.linalg.norm(path[-1] - goals[k]) < 1.5
        )
    if maze == "large":
        arena = cases.world(cases.conditions(True)["large/carrot/none"])
        boxes = np.asarray([t.box for t in arena.objects.permanent()]) / arena.scale
        border = [v / arena.scale for v in arena.layout.border]
        assert clearance(np.concatenate([starts[:, :2], goals]), boxes, border).min() >= 4 - 1e-5


def test_the_published_pairs_are_those_of_the_lists():
    starts, goals = pairs.pairs("z")
    np.testing.assert_allclose(starts[0, :2], place(80, 40))
    np.testing.assert_allclose(goals[0], place(30, 70))
    assert np.array_equal(starts[34, :2], goals[34])


def test_the_reference_of_case_3_is_the_north_route():
    path = shortest_path(pairs.reference("z"), place(50, 60), place(40, 40))
    assert path_length(path) == pytest.approx(102.7, abs=2) and place(0, 0)[1] - path[:, 1].max() < 30


def test_every_condition_has_a_world_for_all_its_trials():
    for c in cases.conditions(True).values():
        arena = cases.world(c)
        assert isinstance(arena, Arena) and arena.unit == "cm"
        assert arena.own(c.trials)["start"].shape == (len(c.trials), 3)


@pytest.mark.parametrize(
    ("what", "rows", "columns"), [("full", (5, 25), (35, 45)), ("partial", (15, 30), (25, 55))]
)
def test_obstacles_are_at_the_positions_of_the_paper(what, rows, columns):
    c = cases.conditions(True)[f"{what}/planner/low"]
    arena = cases.world(c)
    slot = next(s for s in arena.objects.slots if s and s.name == cases.OBSTACLES[what][0])
    item, times = slot.item(7), slot.windows
    low, high = place(rows[1], columns[0]), place(rows[0], columns[1])
    np.testing.assert_allclose(np.asarray(item.box) * 100, [*low, *high])
    onset, duration = cases.windows(what)[7]
    assert tuple(times[7]) == (onset, onset + duration)


def test_the_design_contains_the_planner_with_other_settings():
    designs_with_terms = {
        name: c for name, c in cases.conditions(False).items() if c.terms and c.method == "planner"
    }
    kinds = [
        "sticking-planner/low",
        "sticking-planner/high",
        "factor-1.0-planner/high",
        "reflection-0.8-planner/low",
        "reflection-1.0-planner/low",
    ]
    assert list(designs_with_terms) == [f"{maze}/{kind}" for maze in ("z", "large") for kind in kinds]
    assert [len(c.trials) for c in designs_with_terms.values()] == [96] * 5 + [40] * 5
    assert cases.design(False)["planners"] == {name: c.terms for name, c in designs_with_terms.items()}
    assert designs_with_terms["z/sticking-planner/low"].terms == {"contact": "stick"} and designs_with_terms[
        "large/reflection-1.0-planner/low"
    ].terms == {"reflection": 1.0}
    assert designs_with_terms["z/factor-1.0-planner/high"].terms == {"factor": 1.0}


def test_settings_of_a_condition_change_the_world_and_the_model():
    designs = cases.conditions(False)
    assert cases.world(designs["large/reflection-0.8-planner/low"]).physics.reflection == 0.8
    assert cases.world(designs["z/planner/low"]).physics.reflection == 0.6
    assert cases.world(designs["z/sticking-planner/high"]).physics.contact == "stick"
    strengths = {}
    for name in ("z/factor-1.0-planner/high", "z/planner/high", "z/planner/low"):
        model = trials._bench(name, False)[1]
        strengths[name] = model["own place"].element.amplitude
    assert strengths == {
        "z/factor-1.0-planner/high": 8.0,
        "z/planner/high": pytest.approx(9.6),
        "z/planner/low": 8.0,
    }
