"""Reported claims: sentences of the paper's results and discussion, each with its number, and the influence
of deodar's own settings on them.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from deodar.analysis import statistics
from deodar.analysis.claims import Claim, Origin
from deodar.analysis.robot_paths import speeds
from deodar.analysis.statistics import anova, difference_interval, equivalent, mean_interval, ratio_interval
from deodar.architectures.spa import place
from deodar.experiments.rows import Row
from deodar_papers.spa import cases
from deodar_papers.spa.condition_runs import METHODS, Runs, between, count, numbers
from deodar_papers.spa.route import NORTH, SOUTH, SWITCH
from deodar_papers.spa.sentence import ALIKE, PLACES, REFLECTION, START, Sentence
from deodar_papers.spa.targets import MAZE
from deodar_papers.spa.trials import KEPT, LASTS

Said = Callable[[Runs], Sequence[Claim]]
NOISES = ("low", "high")

FEWER = 0.02
"""Smallest fall of the share of unsuccessful runs that counts as reduced: 4 of 200 runs (a choice of
deodar).
"""

OCCASIONS = 300
"""Runs from which on "a few occasions" is decided: where one run in a hundred is stuck, 300 runs show none in
5 of 100 experiments (a choice of deodar).
"""


def claims(runs: Runs) -> list[Claim]:
    """Return all reported claims, by section."""
    said: tuple[Said, ...] = (
        _section_3,
        _section_5_1,
        _narrative,
        _case_3_early,
        _case_3_late,
        _section_6_2,
        _section_6_4,
        _section_7,
    )
    return [claim for part in said for claim in part(runs)]


def _planned(runs: Runs, maze: str = "", noises: Sequence[str] = NOISES) -> list[Row]:
    return [
        r for m in ([maze] if maze else MAZE) for noise in noises for r in runs.of(f"{m}/planner/{noise}")
    ]


def _success(r: Row) -> bool:
    return r["success"]


def _assumed(maze: str) -> str:
    return REFLECTION if maze == "large" else ""


def _section_3(runs: Runs) -> list[Claim]:
    opposed = numbers(_planned(runs), "opposed")
    value = float(opposed.mean()) if len(opposed) else None
    text = "opposing behaviours are mutually exclusive: share of time in which both of a pair intend to go"
    out = [Sentence("3.2", text).bounds(value, len(opposed), (0.0, 0.05), "<= 0.05", mean_interval(opposed))]
    for noise in NOISES:
        text = (
            "a goal may change at any time: runs in which it moves while the robot drives, and that reach"
            f" where it went, {noise} noise"
        )
        out.append(
            Sentence("3.2", text, assumes=START).share(
                runs.of(f"moved/planner/{noise}"), _success, 0.9, runs.quick
            )
        )
    return out


def _section_5_1(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for k, maze in enumerate(MAZE, 1):
        groups = [runs.divergences(f"{maze}/{method}/{noise}") for method, noise in METHODS]
        found = anova(groups) if all(len(g) > 1 for g in groups) else None
        n, assumes = min(map(len, groups)), _assumed(maze)
        text = (
            f"no significant difference in path length between the five conditions of environment {k}"
            " (one-way ANOVA, p)"
        )
        out.append(_refuted(Sentence("5.1", text, "printed", assumes), found and found[1], n))
        out.append(
            Sentence("5.1", f"F of that test in environment {k}; printed {0.97 if k == 1 else 0.98}").value(
                found and found[0], n
            )
        )
        text = (
            f"path lengths of the five conditions of environment {k} are equal: largest difference of two"
            " means of Lp / Lo"
        )
        out.append(_all_equal(Sentence("5.1", text, "ours", assumes), groups))
    rows = _planned(runs)
    # a run that does not arrive counts with the limit: otherwise the latest that arrive would look early
    arrivals = [r["arrival"] if r["success"] else cases.LIMIT for r in rows]
    text = (
        f"{cases.LIMIT} steps are well above the time necessary even for the longest paths: latest arrival,"
        f" {cases.LIMIT} where there is none"
    )
    out.append(
        Sentence("5.1", text, assumes=REFLECTION).bounds(
            max(arrivals, default=None), len(arrivals), (0, 2500), "<= 2500"
        )
    )
    best = {
        name: count(runs.of(name), _success)
        for name in cases.conditions(runs.quick)
        if name.startswith("z/tuning/")
    }
    if all(n for _, n in best.values()):
        # the gain must suit either contact: the smaller share counts
        tuned = dict.fromkeys(name.rpartition("-")[0] for name in best)
        pairs = {name: min(best[f"{name}-{contact}"][0] for contact in ("slide", "stick")) for name in tuned}
        mine = f"z/tuning/{cases.CARROT.speed:g}-{cases.CARROT.gain:g}"
        n, most = best[f"{mine}-slide"][1], max(pairs.values())
        text = (
            "following the carrot: no other speed and gain succeed more often in the Z-maze than"
            f" {mine.rpartition('/')[2]}"
        )
        out.append(
            Sentence("", text).bounds(pairs[mine] / n, n, (most / n - 1e-9, 1.0), f">= {most / n:.4g}")
        )
    return out


def _refuted(said: Sentence, p: float | None, n: int) -> Claim:
    """Return a claim that a test found no difference.

    A small p here refutes it; a large one shows nothing, so it stays open.
    """
    return said.judged(
        p, "> 0.05, which shows no equality", False if p is not None and p <= 0.05 else None, n
    )


def _all_equal(said: Sentence, groups: Sequence[np.ndarray]) -> Claim:
    """Return a claim that the means of groups are equal: the interval of the difference of every two lies
    inside the margin.
    """
    twos = [
        (float(a.mean() - b.mean()), difference_interval(a, b))
        for a, b in itertools.combinations(groups, 2)
        if min(len(a), len(b)) > 1
    ]
    decided = [equivalent(interval, -ALIKE, ALIKE) for _, interval in twos]
    complete = len(twos) == len(groups) * (len(groups) - 1) // 2
    holds = False if False in decided else True if complete and all(decided) else None
    value, interval = max(twos, key=lambda two: abs(two[0]), default=(None, None))
    return said.judged(
        value, f"intervals inside {-ALIKE:g} to {ALIKE:g}", holds, min(map(len, groups)), interval
    )


def _narrative(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    free = runs.of("free/planner/low")

    def seen(text: str, assumes: str = START, origin: Origin = "printed") -> Sentence:
        """Return a claim on a time or place that the paper reports of the run, from which the start (and the
        second location) was inferred.
        """
        return Sentence("5.2", text, origin, assumes, inferred=True)

    out.append(
        seen("the plan is complete at t = 210 (case 3 without an obstacle)").median(
            numbers(free, "plan"), 189, 231, "210 +- 10 %", runs.quick
        )
    )
    out.append(
        seen("the wave reaches the second location around t = 150", PLACES).median(
            numbers(free, "wave"), 135, 165, "150 +- 10 %"
        )
    )
    out.append(seen("the robot leaves after t = 210").median(numbers(free, "moved"), 210, 260, "210 to 260"))
    for noise in NOISES:
        rows = runs.of(f"free/planner/{noise}")
        text = f"without an obstacle it always takes the shortest, north route, {noise} noise"
        out.append(seen(text, origin="ours").share(rows, lambda r: r["route"] == NORTH, 0.95, runs.quick))
        text = (
            "the plan is to go north, west, south and east: runs whose intentions come in this order,"
            f" {noise} noise"
        )
        out.append(
            seen(text, origin="ours").share(
                rows, lambda r: _in_order(r, "north", "west", "south", "east"), 0.9, runs.quick
            )
        )
    narrated = runs.of("narrative/planner/low")
    text = (
        "planning again, motivation to go west at the second location decays between 350 and 550: it ends at"
    )
    out.append(seen(text, PLACES).median(numbers(narrated, "west_ends"), 350, 550, "350 to 550"))
    text = "motivation to go east is there from around t = 550 on"
    out.append(seen(text, PLACES).median(numbers(narrated, "east_begins"), 495, 605, "550 +- 10 %"))
    # the following results were not used to infer the start, but depend on it
    text = "a full obstacle at t = 336 makes it plan again and go south"
    out.append(
        Sentence("5.2", text, assumes=START).share(narrated, lambda r: r["route"] == SWITCH, 0.7, runs.quick)
    )
    text = "it then goes east, south, west and, finally, north"
    out.append(
        Sentence("5.2", text, assumes=START).share(
            narrated, lambda r: _in_order(r, "east", "south", "west", "north"), 0.7, runs.quick
        )
    )
    text = "that run is at its fourth location at t = 1250: arrival"
    out.append(
        Sentence("5.2", text, "printed", START).median(
            numbers(narrated, "arrival"), 1125, 1375, "1250 +- 10 %"
        )
    )
    text = "planning again takes from 350 to 550: time without motion"
    out.append(
        Sentence("5.2", text, "printed", START).median(numbers(narrated, "still"), 100, 300, "200 +- 50 %")
    )
    return out


def _in_order(row: Row, *names: str) -> bool:
    """Return whether these behaviours follow one another in a run; others may lie between them."""
    rest = iter(row["behaviours"])
    return all(name in rest for name in names)


def _passage(row: Row) -> float | None:
    """Return the mean speed beside the partial obstacle, on the north route, while it is present; in cm a
    step.

    Without an obstacle: at the same position.
    """
    path, (x, y) = np.asarray(row["path"]), place(*cases.OBSTACLES["partial"][1])
    times = KEPT * np.arange(len(path))
    present = (times >= row.get("onset", 0)) & (
        times <= row.get("onset", 0) + row.get("duration", cases.LIMIT)
    )
    beside = present & (np.abs(path[:, 0] - x) < cases.OBSTACLES["partial"][2][0] / 2) & (path[:, 1] > y)
    return float(speeds(path, times)[beside[1:]].mean()) if beside.sum() > LASTS else None


def _case_3_early(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for obstacle in ("full", "partial"):
        for noise in NOISES:
            early = between(runs.kept(obstacle, noise), (0, 150))
            text = (
                f"an obstacle during early planning sends it south, whatever its type: {obstacle}, {noise}"
                " noise, onset to 150"
            )
            out.append(
                Sentence("5.2", text, assumes=START).share(
                    early, lambda r: r["route"] == SOUTH, 0.8, runs.quick
                )
            )
    partial = between(runs.kept("partial", "low"), (0, 200), (0, 100))
    full = between(runs.kept("full", "low"), (0, 200), (0, 100))
    text = "a partial obstacle in the first 200 steps sends it south even if it is short (to 100 steps)"
    out.append(
        Sentence("5.2", text, assumes=START).share(partial, lambda r: r["route"] == SOUTH, 0.8, runs.quick)
    )
    text = "a short full obstacle has less effect than a short partial one: share of north, full less partial"
    north_full, north_partial = (count(rows, lambda r: r["route"] == NORTH) for rows in (full, partial))
    out.append(Sentence("5.2", text, assumes=START).more_often(north_full, north_partial))
    return out


def _case_3_late(runs: Runs) -> list[Claim]:
    out: list[Claim] = []

    def said(text: str, noise: str) -> Sentence:
        return Sentence("5.2", f"{text}, {noise} noise", assumes=START)

    for noise in NOISES:
        partial, full = runs.kept("partial", noise), runs.kept("full", noise)
        late = said("a partial obstacle during late planning or execution does not change the route", noise)
        out.append(late.share(between(partial, (200, 1000)), lambda r: r["route"] == NORTH, 0.9, runs.quick))
        first = said("after t = 200 it first takes the north route in almost all cases", noise)
        out.append(
            first.share(
                between([*partial, *full], (201, 1000)),
                lambda r: r["route"] in (NORTH, SWITCH),
                0.95,
                runs.quick,
            )
        )
        switch = said(
            "a full obstacle at 200 < t < 500 that lasts more than 200 steps makes it switch", noise
        )
        out.append(
            switch.share(
                between(full, (201, 499), (201, 1000)), lambda r: r["route"] == SWITCH, 0.7, runs.quick
            )
        )
        always = said("after t = 500 it always takes the north route", noise)
        out.append(
            always.share(
                between([*partial, *full], (501, 1000)), lambda r: r["route"] == NORTH, 0.95, runs.quick
            )
        )
        persists = said(
            "it persists more after t = 200: share of north for obstacles of 50 to 250 steps, later less"
            " earlier",
            noise,
        )
        after, before = (
            count(between(full, onset, (50, 250)), lambda r: r["route"] == NORTH)
            for onset in ((201, 450), (0, 150))
        )
        out.append(persists.more_often(after, before))
        stands = said(
            "switching takes a time of standing still: share of runs that stand for 50 steps, switch less"
            " south",
            noise,
        )
        switching, going = (
            count(between([*partial, *full], route=way), lambda r: r["still"] > 50) for way in (SWITCH, SOUTH)
        )
        out.append(stands.more_often(switching, going))
        for obstacle in cases.DRAW:
            text = (
                f"runs left out because the obstacle came down on the robot, {noise} noise, {obstacle}"
                " obstacle"
            )
            n = len(runs.of(f"{obstacle}/planner/{noise}"))
            out.append(
                Sentence("5.2", text, assumes=START).value(runs.left_out(obstacle, noise) if n else None, n)
            )
    return out


def _section_6_2(runs: Runs) -> list[Claim]:
    return [*_wave(runs), *_clearances(runs), *_velocities(runs), *_long_paths(runs)]


def _wave(runs: Runs) -> Iterator[Claim]:
    """Yield the speed at which activation spreads, and how long planning again takes."""
    rows = [r for r in _planned(runs) if r["plan"] is not None and r["shortest"] is not None]
    far, when = numbers(rows, "shortest"), numbers(rows, "plan")
    if len(far) > 2:
        slope, offset = np.polyfit(far, when, 1)
        rest = float(1 - np.var(when - slope * far - offset) / np.var(when))
        text = (
            "activation spreads with a constant speed: share of variance of planning time that is linear"
            " in Lo"
        )
        yield Sentence("6.2", text).bounds(rest, len(far), (0.9, 1.0), ">= 0.9")
        yield Sentence("6.2", "speed of the wave, cm a step").value(1 / slope, len(far))
    switched = [r for noise in NOISES for r in between(runs.kept("full", noise), route=SWITCH)]
    text = "planning again is shorter than planning: time without motion over the time of the first plan"
    still, first = numbers(switched, "still"), numbers(runs.of("free/planner/low"), "plan")
    yield _ratio(Sentence("6.2", text, assumes=START), still, first, False)


def _clearances(runs: Runs) -> Iterator[Claim]:
    """Yield how far paths keep from walls."""
    for maze in MAZE:
        found = [
            r["clearance"] - r["shortest_clearance"]
            for r in _planned(runs, maze)
            if r["success"] and r["shortest_clearance"] is not None
        ]
        text = (
            "paths keep away from walls: mean distance to the nearest one less that of the shortest path,"
            f" cm, {MAZE[maze]}"
        )
        value = float(np.mean(found)) if found else None
        said = Sentence("6.2", text, assumes=_assumed(maze))
        yield said.larger(value, mean_interval(found), len(found), 0.0, 0.5)
    south = [r for k in NOISES for o in ("full", "partial") for r in between(runs.kept(o, k), route=SOUTH)]
    north = [r for k in NOISES for r in between(runs.kept("partial", k), (200, 400), (200, 500), route=NORTH)]
    text = "the south route keeps farther from walls than the north one past a partial obstacle: ratio"
    said = Sentence("6.2", text, assumes=START)
    yield _ratio(said, numbers(south, "clearance"), numbers(north, "clearance"), True)


def _velocities(runs: Runs) -> Iterator[Claim]:
    """Yield how much a narrow passage reduces the velocity."""
    past = [r for k in NOISES for r in between(runs.kept("partial", k), route=NORTH)]
    without = [r for k in NOISES for r in runs.of(f"free/planner/{k}")]
    slow, free = (np.asarray([v for r in rows if (v := _passage(r)) is not None]) for rows in (past, without))
    text = "the narrow passage beside a partial obstacle reduces the velocity: ratio to that without one"
    yield _ratio(Sentence("6.2", text, assumes=START), slow, free, False)


def _long_paths(runs: Runs) -> Iterator[Claim]:
    """Yield the success over the longest paths less that over the shortest."""
    ordered = sorted(
        (r for r in _planned(runs, "large") if r["shortest"] is not None), key=lambda r: r["shortest"]
    )
    third = len(ordered) // 3
    longest, shortest = (count(part, _success) for part in (ordered[len(ordered) - third :], ordered[:third]))
    text = (
        "long paths do not suffer from low gradients: success over the longest third in the large maze less"
        " that over the shortest"
    )
    yield Sentence("6.2", text, assumes=REFLECTION, inferred=True).as_often(longest, shortest)


def _ratio(said: Sentence, above: np.ndarray, below: np.ndarray, more: bool) -> Claim:
    """Return a claim that the ratio of two medians is above (`more`) or below 1 by an amount that counts."""
    n = min(len(above), len(below))
    value, interval = (
        (float(np.median(above) / np.median(below)), ratio_interval(above, below)) if n else (None, None)
    )
    return (
        said.larger(value, interval, n, 1.0, ALIKE) if more else said.smaller(value, interval, n, 1.0, ALIKE)
    )


def _section_6_4(runs: Runs) -> list[Claim]:
    low, high = (count(_planned(runs, noises=[k]), lambda r: not r["success"]) for k in NOISES)
    text = "high noise reduces the number of unsuccessful runs: share at low less that at high noise"
    out = [Sentence("6.4", text, assumes=REFLECTION).more_often(low, high, FEWER)]
    failed = [r for r in _planned(runs) if not r["success"]]
    stuck, n = len(failed), len(_planned(runs))
    text = (
        "on a few occasions the robot is stuck: share of all runs; one run at least, and one in ten at most"
    )
    holds = 0 < stuck <= 0.1 * n if n >= OCCASIONS else None
    out.append(
        Sentence("6.4", text, assumes=REFLECTION).judged(
            stuck / n if n else None, "> 0, <= 0.1", holds, n, statistics.wilson(stuck, n)
        )
    )
    free = sum(not r["touches_at_end"] for r in failed)
    text = "what sticks is a local minimum, not a wall: share of these runs that touch nothing at the end"
    value = free / stuck if stuck else None
    out.append(
        Sentence("6.4", text, assumes=REFLECTION).bounds(
            value, stuck, (0.5, 1.0), ">= 0.5", statistics.wilson(free, stuck)
        )
    )
    for maze in MAZE:
        groups = [runs.divergences(f"{maze}/planner/{noise}") for noise in NOISES]
        found, n = anova(groups), min(map(len, groups))
        text = f"noise has no significant effect on paths in the {MAZE[maze]} (one-way ANOVA, p)"
        out.append(_refuted(Sentence("6.4", text, "printed", _assumed(maze)), found and found[1], n))
        before, after = runs.both(f"{maze}/planner/low", f"{maze}/planner/high")
        text = (
            f"noise has no effect on paths in the {MAZE[maze]}: mean of Lp / Lo at high less at low noise,"
            " pair by pair"
        )
        value = float((after - before).mean()) if len(before) else None
        out.append(
            Sentence("6.4", text, assumes=_assumed(maze)).equal(
                value, mean_interval(after - before), len(before), -ALIKE, ALIKE
            )
        )
    return out


def _section_7(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    # the same contact for both, and the same pairs of start and goal
    for planner, carrot, words in (
        ("planner", "carrot", "tuned, both slide along walls"),
        ("sticking-planner", "sticking-carrot", "tuned, both stick to walls"),
        ("sticking-planner", "weak-carrot", "weak gain, both stick to walls"),
    ):
        plans = [r for noise in NOISES for r in runs.of(f"large/{planner}/{noise}")]
        rows = [
            r
            for noise in ("none", "low", "high")
            for r in runs.like(f"large/{carrot}/{noise}", f"large/{planner}/low")
        ]
        text = (
            f"in the large maze the planner succeeds notably more often than following the carrot ({words}):"
            " difference"
        )
        out.append(
            Sentence("7", text, assumes=REFLECTION, inferred=True).more_often(
                count(plans, _success), count(rows, _success)
            )
        )
    for carrot, words in (
        ("carrot", "tuned, slides"),
        ("sticking-carrot", "tuned, sticks"),
        ("weak-carrot", "weak gain, sticks"),
    ):
        failed = [
            r
            for noise in ("none", "low", "high")
            for r in runs.of(f"large/{carrot}/{noise}")
            if not r["success"]
        ]
        text = (
            "the carrot fails by cutting corners: share of its failures that touch a wall at the end"
            f" ({words})"
        )
        out.append(Sentence("7", text).share(failed, lambda r: r["touches_at_end"], 0.8, runs.quick))
    for noise in NOISES:
        short = between(runs.kept("full", noise), (201, 1000), (0, 100))
        text = (
            "transient blockages do not result in planning again: full obstacles of up to 100 steps after t ="
            f" 200, {noise} noise"
        )
        out.append(
            Sentence("7", text, assumes=START).share(short, lambda r: r["route"] == NORTH, 0.9, runs.quick)
        )
    return out
