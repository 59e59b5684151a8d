"""The report of constructed rows: claims hold, fail, or are undecided with too few runs."""

from __future__ import annotations

import json

import pytest

from deodar.analysis.claims import failed, results
from deodar_papers import spa
from deodar_papers.spa import sentences, targets, unstated_settings
from deodar_papers.spa.condition_runs import SOURCE, Runs
from deodar_papers.spa.sentence import Sentence
from deodar_papers.spa.targets import claims
from tests.deodar_papers.spa.rows import all_rows


def required(change, quick=False):
    return {c.name: c for c in claims(Runs(all_rows(quick, change), quick))}


def only(judged, words):
    """Return the claims whose names contain all of these words."""
    out = [c for name, c in judged.items() if all(w in name for w in words)]
    assert out
    return out


def claims_after(change, quick=False):
    """Return all claims of the report, by name."""
    runs = Runs(all_rows(quick, change), quick)
    return {c.name: c for part in (targets, sentences, unstated_settings) for c in part.claims(runs)}


def test_all_required_claims_hold_for_rows_as_in_the_paper():
    judged = {name: c for name, c in required(lambda c, k: {}).items() if c.kind == "required"}
    assert len(judged) == 18
    assert {c.holds for c in judged.values()} == {True} and not failed(list(judged.values()))
    assert all(c.n >= 20 and c.source for c in judged.values())


def test_claims_with_inferred_settings_are_marked_and_not_required():
    inferred = {name: c for name, c in claims_after(lambda c, k: {}).items() if c.inferred}
    assert all(c.kind == "reported" and c.assumes for c in inferred.values())
    for words in (
        "the plan is complete",
        "the wave reaches the second location",
        "shortest, north route",
        "large maze, low noise: the planner reaches",
    ):
        assert any(words in name for name in inferred), words
    # every sentence infers events at the second location
    assert all(c.inferred for name, c in claims_after(lambda c, k: {}).items() if "second location" in name)
    assert all(c.assumes for name, c in claims_after(lambda c, k: {}).items() if name.startswith("case 3"))


def test_every_claim_states_the_origin_of_its_target():
    for c in claims_after(lambda c, k: {}).values():
        # the figures of the paper were not available
        assert c.origin in ("printed", "ours", "none"), c.name
        assert (c.origin == "none") == (c.target == "none"), c.name


@pytest.mark.parametrize(
    ("sentence", "source"),
    [
        (Sentence("5.2", "it arrives"), f"{SOURCE}, section 5.2"),
        (Sentence("5.2", "it arrives", source="figure 8"), "figure 8"),
        (Sentence("", "it arrives", source="figure 8"), "figure 8"),
        (Sentence("", "it arrives"), "no sentence of the paper"),
    ],
)
def test_the_source_of_a_claim_is_where_the_paper_has_its_sentence(sentence, source):
    claim = sentence.value(1.0, 3)
    assert (claim.source, claim.n, claim.value, claim.target) == (source, 3, 1.0, "none")


FAILS = [
    # the change of the rows, and the beginning of the name of the claim that it makes false
    ("opposed", lambda c, k: {"opposed": 0.2}, "3.2: opposing"),
    (
        "lost goal",
        lambda c, k: {"success": False} if c.name.startswith("moved") else {},
        "3.2: a goal may change at any time",
    ),
    (
        "long for one",
        lambda c, k: {"divergence": 1.3 + 0.001 * (k % 5)} if c.name == "z/planner/low" else {},
        "5.1: no significant difference",
    ),
    (
        "long for one",
        lambda c, k: {"divergence": 1.3 + 0.001 * (k % 5)} if c.name == "z/planner/low" else {},
        "5.1: path lengths of the five",
    ),
    (
        "one is late",
        lambda c, k: {"success": k != 5} if c.name == "large/planner/low" else {},
        "5.1: 3000 steps",
    ),
    (
        "better carrot",
        lambda c, k: {"success": k % 2 > 0} if c.name == "z/tuning/400-400-slide" else {},
        "following the carrot: no other",
    ),
    (
        "slow wave",
        lambda c, k: {"wave": 200, "moved": 300, "west_ends": 600, "east_begins": 700},
        "5.2: the wave",
    ),
    (
        "slow wave",
        lambda c, k: {"wave": 200, "moved": 300, "west_ends": 600, "east_begins": 700},
        "5.2: the robot leaves",
    ),
    (
        "slow wave",
        lambda c, k: {"wave": 200, "moved": 300, "west_ends": 600, "east_begins": 700},
        "5.2: planning again, motivation",
    ),
    (
        "slow wave",
        lambda c, k: {"wave": 200, "moved": 300, "west_ends": 600, "east_begins": 700},
        "5.2: motivation to go east",
    ),
    (
        "south",
        lambda c, k: {"route": "south", "behaviours": ["south"]} if not c.many_starts else {},
        "5.2: without an obstacle",
    ),
    (
        "south",
        lambda c, k: {"route": "south", "behaviours": ["south"]} if not c.many_starts else {},
        "5.2: the plan is to go north",
    ),
    (
        "south",
        lambda c, k: {"route": "south", "behaviours": ["south"]} if not c.many_starts else {},
        "5.2: it then goes east",
    ),
    (
        "south",
        lambda c, k: {"route": "south", "behaviours": ["south"]} if not c.many_starts else {},
        "5.2: a full obstacle at t = 336",
    ),
    (
        "south",
        lambda c, k: {"route": "south"} if not c.many_starts else {},
        "5.2: a partial obstacle during late",
    ),
    ("south", lambda c, k: {"route": "south"} if not c.many_starts else {}, "5.2: after t = 200"),
    ("south", lambda c, k: {"route": "south"} if not c.many_starts else {}, "5.2: after t = 500"),
    ("south", lambda c, k: {"route": "south"} if not c.many_starts else {}, "5.2: a full obstacle at 200"),
    ("south", lambda c, k: {"route": "south"} if not c.many_starts else {}, "5.2: it persists more"),
    ("south", lambda c, k: {"route": "south"} if not c.many_starts else {}, "7: transient blockages"),
    ("north", lambda c, k: {"route": "north"} if not c.many_starts else {}, "5.2: an obstacle during early"),
    (
        "north",
        lambda c, k: {"route": "north"} if not c.many_starts else {},
        "5.2: a partial obstacle in the first",
    ),
    (
        "opposite",
        lambda c, k: {"route": "south" if c.obstacle == "full" else "north"} if c.obstacle else {},
        "5.2: a short full obstacle",
    ),
    (
        "late",
        lambda c, k: {"arrival": 1500, "still": 400} if c.obstacle else {},
        "5.2: that run is at its fourth",
    ),
    ("late", lambda c, k: {"arrival": 1500, "still": 400} if c.obstacle else {}, "5.2: planning again takes"),
    (
        "late",
        lambda c, k: {"arrival": 1500, "still": 400} if c.obstacle else {},
        "6.2: planning again is shorter",
    ),
    ("all rest", lambda c, k: {"still": 100} if c.obstacle else {}, "5.2: switching takes a time"),
    (
        "any time",
        lambda c, k: {"plan": 100 + 37 * (k % 7)} if c.many_starts and c.method == "planner" else {},
        "6.2: activation spreads",
    ),
    ("near walls", lambda c, k: {"clearance": 5.1}, "6.2: paths keep away"),
    ("near walls", lambda c, k: {"clearance": 5.1}, "6.2: the south route keeps farther"),
    ("all alike", lambda c, k: {}, "6.2: the narrow passage"),
    (
        "short only",
        lambda c, k: {"success": k % 3 < 2} if c.name.startswith("large/planner") else {},
        "6.2: long paths",
    ),
    ("none fails", lambda c, k: {}, "6.4: high noise reduces"),
    ("none fails", lambda c, k: {}, "6.4: on a few occasions"),
    (
        "half fail",
        lambda c, k: {"success": k % 2 > 0} if c.method == "planner" else {},
        "6.4: on a few occasions",
    ),
    (
        "at a wall",
        lambda c, k: {"success": k % 9 > 0, "touches_at_end": True} if c.method == "planner" else {},
        "6.4: what sticks",
    ),
    (
        "noise",
        lambda c, k: {"divergence": 1.3 + 0.001 * (k % 5)} if c.name.endswith("planner/high") else {},
        "6.4: noise has no significant",
    ),
    (
        "noise",
        lambda c, k: {"divergence": 1.3 + 0.001 * (k % 5)} if c.name.endswith("planner/high") else {},
        "6.4: noise has no effect",
    ),
    ("all reach it", lambda c, k: {}, "7: in the large maze"),
    (
        "in the open",
        lambda c, k: {"success": k % 9 > 0, "touches_at_end": False} if c.method == "carrot" else {},
        "7: the carrot fails",
    ),
    (
        "sticks",
        lambda c, k: {"success": k % 2 > 0} if c.terms else {},
        "Z-maze, low noise: where contact sticks, the planner",
    ),
    (
        "sticks",
        lambda c, k: {"success": k % 2 > 0} if c.terms else {},
        "large maze, low noise: where walls reflect 1.0, the planner",
    ),
    (
        "sticks",
        lambda c, k: {"divergence": 1.4 + 0.001 * (k % 5)} if c.terms else {},
        "Z-maze, high noise: where the factor on the place input is 1.0, paths",
    ),
]


@pytest.mark.parametrize(
    ("change", "name"), [case[1:] for case in FAILS], ids=[f"{what}: {name[:40]}" for what, _, name in FAILS]
)
def test_each_sentence_fails_for_rows_that_contradict_it(change, name):
    judged = [c for c in claims_after(change).values() if c.name.startswith(name)]
    assert judged and any(c.holds is False for c in judged), [
        (c.name, c.value, c.interval, c.holds) for c in judged
    ]


def test_a_wider_way_south_confirms_that_it_keeps_farther_from_walls():
    def ways(c, k):
        south = c.obstacle == "partial" and k % 2 > 0
        return {"route": "south", "clearance": 9.0} if south else {"route": "north", "clearance": 6.0}

    runs = Runs(all_rows(False, lambda c, k: ways(c, k) if c.obstacle else {}), False)
    (claim,) = (c for c in sentences.claims(runs) if c.name.startswith("6.2: the south route keeps farther"))
    assert (claim.value, claim.holds) == (1.5, True)


def test_every_sentence_with_a_target_has_a_contradicting_case():
    names = tuple(name for _, _, name in FAILS)
    undecided = [
        c.name
        for c in claims_after(lambda c, k: {}).values()
        if c.kind == "reported" and c.origin != "none" and not c.name.startswith(names)
    ]
    alike = ("Z-maze", "large maze")  # the same claim for another maze, level of noise or setting
    assert [
        name
        for name in undecided
        if not name.startswith(alike) and not name.startswith("5.1: ") and "plan is complete" not in name
    ] == []


def test_rows_as_in_the_paper_contradict_only_sentences_on_failures_and_walls():
    """In the constructed rows no run fails, and all clearances and velocities are equal."""
    judged = claims_after(lambda c, k: {})
    refuted = {name for name, c in judged.items() if c.holds is False}
    assert {name.partition(",")[0][:24] for name in refuted} == {
        "5.2: it then goes east",
        "6.2: the south route kee",
        "6.2: the narrow passage ",
        "6.4: high noise reduces ",
        "6.4: on a few occasions ",
        "7: in the large maze the",
    }
    (latest,) = only(judged, ["5.1: 3000 steps"])
    assert (latest.value, latest.holds) == (660, True)
    (speed,) = only(judged, ["speed of the wave, cm a step"])
    # Lo is 100, 120 or 140 cm, and the plan is complete at step 150, 210 or 270
    assert (speed.value, speed.n, speed.holds) == (pytest.approx(1 / 3, abs=1e-4), 392, None)
    (late,) = only(
        claims_after(lambda c, k: {"success": k != 5} if c.name == "large/planner/low" else {}),
        ["3000 steps"],
    )
    assert (late.value, late.holds) == (3000, False)


ALL = (0, 1000)
COUNTED = {
    # words of a claim: obstacles, and the onsets and durations that it states, both ends included
    "full obstacle, low noise: an obstacle before t = 130": (["full"], (0, 129), (101, 1000)),
    "full obstacle, high noise: an obstacle at t = 200 to 450": (["full"], (200, 450), (200, 500)),
    "full obstacle, low noise: an obstacle after t = 500": (["full"], (501, 1000), ALL),
    "partial obstacle, high noise: an obstacle before t = 130": (["partial"], (0, 129), ALL),
    "partial obstacle, low noise: an obstacle at t = 200 to 450": (["partial"], (200, 450), ALL),
    "whatever its type: full, low noise, onset to 150": (["full"], (0, 150), ALL),
    "whatever its type: partial, high noise, onset to 150": (["partial"], (0, 150), ALL),
    "a partial obstacle in the first 200 steps": (["partial"], (0, 200), (0, 100)),
    "during late planning or execution does not change the route, low": (["partial"], (200, 1000), ALL),
    "after t = 200 it first takes the north route in almost all cases, low": (
        ["partial", "full"],
        (201, 1000),
        ALL,
    ),
    "a full obstacle at 200 < t < 500 that lasts more than 200 steps": (["full"], (201, 499), (201, 1000)),
    "after t = 500 it always takes the north route, high": (["partial", "full"], (501, 1000), ALL),
    "full obstacles of up to 100 steps after t = 200, high": (["full"], (201, 1000), (0, 100)),
}
ONSETS = [130, 129, 150, 151, 199, 200, 201, 202, 450, 451, 498, 499, 500, 501, 502]
DURATIONS = [99, 100, 101, 102, 199, 200, 201, 202, 500, 501]


def test_a_claim_counts_the_runs_whose_obstacle_has_the_onset_and_duration_that_it_states():
    windows = {k: (ONSETS[k % 15], DURATIONS[k // 15 % 10]) for k in range(240)}
    judged = claims_after(
        lambda c, k: (
            dict(zip(("onset", "duration"), windows[k], strict=True))
            if c.obstacle in ("full", "partial")
            else {}
        )
    )
    for words, (obstacles, onset, duration) in COUNTED.items():
        # the obstacle of run 3 comes down on the robot
        inside = [
            k
            for k, (begins, lasts) in windows.items()
            if k != 3 and onset[0] <= begins <= onset[1] and duration[0] <= lasts <= duration[1]
        ]
        for claim in only(judged, [words]):
            assert claim.n == len(inside) * len(obstacles) > 0, words


def test_a_large_p_leaves_equality_undecided():
    rows = claims_after(lambda c, k: {})
    for c in rows.values():
        if "ANOVA, p)" in c.name:
            assert c.holds is None and (c.value is None or c.value > 0.05), c.name
    assert (
        rows[
            "6.4: noise has no effect on paths in the Z-maze: mean of Lp / Lo at high less at low noise, pair"
            " by pair"
        ].holds
        is True
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda c, k: {"success": k % 5 > 0} if c.name == "z/planner/high" else {},
            ["Z-maze, high noise", "reaches the goal"],
        ),
        (
            lambda c, k: {"divergence": 1.3} if c.name == "z/planner/low" else {},
            ["Z-maze, low noise", "mean Lp / Lo"],
        ),
        (
            lambda c, k: {"divergence": 1.18 + 0.001 * (k % 5)} if c.name == "z/planner/high" else {},
            ["Z-maze: the medians"],
        ),
        (
            lambda c, k: {"route": "north"} if c.name == "full/planner/low" else {},
            ["full obstacle, low noise", "before t = 130"],
        ),
        (
            lambda c, k: {"route": "south"} if c.name == "partial/planner/high" else {},
            ["partial obstacle, high noise", "t = 200 to 450"],
        ),
        (
            lambda c, k: {"route": "switch"} if c.name == "full/planner/high" else {},
            ["full obstacle, high noise", "after t = 500"],
        ),
    ],
)
def test_a_required_claim_fails_for_rows_that_contradict_it(change, words):
    judged = required(change)
    for claim in only(judged, words):
        assert claim.holds is False
    assert 1 <= len(failed(list(judged.values()))) <= 3


def test_few_runs_leave_claims_undecided():
    judged = required(lambda c, k: {"success": k % 12 > 0} if c.name == "z/planner/high" else {}, quick=True)
    assert not failed(list(judged.values()))
    assert {c.holds for c in only(judged, ["case 3, full", "before t = 130"])} <= {None, True}
    wrong = required(lambda c, k: {"success": k % 2 > 0} if c.name == "z/planner/high" else {}, quick=True)
    assert [c.name for c in failed(list(wrong.values()))] == [
        "Z-maze, high noise: the planner reaches the goal"
    ]


def test_runs_with_an_obstacle_on_the_robot_are_left_out_and_counted():
    runs = Runs(all_rows(False), False)
    assert len(runs.kept("full", "low")) == 239 and runs.left_out("full", "low") == 1
    assert "| full/planner/low | 239 | 1 |" in spa.report(all_rows(False), False).tables["conditions"]


def test_every_sentence_has_a_number_and_all_figures_are_drawn():
    report = spa.report(all_rows(False), False)
    reported = [c for c in report.claims if c.kind == "reported"]
    assert len(reported) > 60 and all(
        c.source.startswith(("Billing", "no sentence of the paper")) for c in reported
    )
    silent = [c.name for c in reported if c.value is None]
    # these have no number if nothing failed and all values are equal
    assert all(
        "failures" in name or "what sticks" in name or "ANOVA" in name or "F of" in name for name in silent
    ), silent
    assert set(report.figures) == {
        f"figure-{n}"
        for n in ("7-success", "8-divergence", "9-paths", "13-routes", "14-velocity", "15-partial", "16-full")
    }
    assert json.loads(results(report.claims, {"quick": False}))["settings"] == {"quick": False}


def test_a_report_of_some_runs_contains_their_claims():
    rows = {k: r for k, r in all_rows(True).items() if k.startswith("z/")}
    report = spa.report(rows, True)
    assert set(report.figures) == {"figure-7-success", "figure-8-divergence"}
    assert all(
        line.startswith(("| z/", "| cond", "|---")) for line in report.tables["conditions"].splitlines()
    )
