"""The reported claims: sentences of the paper's results and discussion, each with its number."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from deodar.analysis.claims import Claim
from deodar.analysis.statistics import Interval, anova, decided, mean_interval, median_interval, ratio_interval, rounded, share, wilson
from deodar.architectures.spa import place
from deodar.experiments.rows import Row
from deodar.papers.spa import cases
from deodar.papers.spa.route import NORTH, SOUTH, SWITCH
from deodar.papers.spa.runs import METHODS, SOURCE, Runs, between, count, numbers
from deodar.papers.spa.targets import MAZE
from deodar.papers.spa.trials import KEPT, LASTS

Said = Callable[[Runs], Sequence[Claim]]
NOISES = ("low", "high")


def claims(runs: Runs) -> list[Claim]:
    """All of them, by section."""
    said: tuple[Said, ...] = (_section_3, _section_5_1, _narrative, _case_3_early, _case_3_late, _section_6_2, _section_6_4, _section_7)
    return [claim for part in said for claim in part(runs)]


def _told(
    section: str, name: str, value: float | None, target: str, n: int, low: float = -np.inf, high: float = np.inf, interval: Interval | None = None
) -> Claim:
    """A claim about a number; without bounds it is only reported. Where there is an interval, that alone decides."""
    if (low, high) == (-np.inf, np.inf):
        holds = None
    elif interval is not None:
        holds = True if low <= interval[0] and interval[1] <= high else False if interval[1] < low or interval[0] > high else None
    else:
        holds = decided(value, None, n, low, high)
    shown = None if value is None else round(float(value), 4)
    return Claim(f"{section}: {name}", shown, target, holds, "reported", f"{SOURCE}, section {section}", n, rounded(interval))


def _share(section: str, name: str, rows: Sequence[Row], true: Callable[[Row], bool], least: float, runs: Runs) -> Claim:
    hits, n = count(rows, true)
    return share(f"{section}: {name}", hits, n, least, "reported", f"{SOURCE}, section {section}", runs.quick)


def _median(section: str, name: str, values: np.ndarray, target: str, low: float, high: float) -> Claim:
    value = float(np.median(values)) if len(values) else None
    return _told(section, name, value, target, len(values), low, high, median_interval(values))


def _difference(a: tuple[int, int], b: tuple[int, int]) -> tuple[float | None, Interval | None, int]:
    """Difference of two shares with Newcombe's 95 % interval (1998, Stat. Med. 17, 873-890, method 10)."""
    first, second = wilson(*a), wilson(*b)
    if first is None or second is None:
        return None, None, 0
    p, q = a[0] / a[1], b[0] / b[1]
    below = np.hypot(p - first[0], second[1] - q)
    above = np.hypot(first[1] - p, q - second[0])
    return p - q, (float(p - q - below), float(p - q + above)), min(a[1], b[1])


def _planned(runs: Runs, maze: str = "", noises: Sequence[str] = NOISES) -> list[Row]:
    return [r for m in ([maze] if maze else MAZE) for noise in noises for r in runs.of(f"{m}/planner/{noise}")]


def _section_3(runs: Runs) -> list[Claim]:
    rows = _planned(runs)
    opposed = numbers(rows, "opposed")
    value = float(opposed.mean()) if len(opposed) else None
    text = "opposing behaviours are mutually exclusive: share of time in which both of a pair intend to go"
    return [_told("3.2", text, value, "<= 0.05", len(opposed), 0.0, 0.05, mean_interval(opposed))]


def _section_5_1(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for k, maze in enumerate(MAZE, 1):
        groups = [runs.divergences(f"{maze}/{method}/{noise}") for method, noise in METHODS]
        found = anova(groups) if all(len(g) > 1 for g in groups) else None
        text = f"no significant difference in path length between the five conditions of environment {k} (one-way ANOVA, p)"
        smallest = min(map(len, groups))
        out.append(_told("5.1", text, None if found is None else found[1], "> 0.05", smallest, 0.05, 1.0))
        out.append(_told("5.1", f"F of that test in environment {k}; printed {0.97 if k == 1 else 0.98}", found and found[0], "reported", smallest))
    arrivals = numbers([r for r in _planned(runs) if r["success"]], "arrival")
    most = float(arrivals.max()) if len(arrivals) else None
    text = "3000 steps are well above the time necessary even for the longest paths: latest arrival"
    out.append(_told("5.1", text, most, "<= 2500", len(arrivals), 0, 2500))
    best = {name: count(runs.of(name), lambda r: r["success"]) for name in cases.conditions(runs.quick) if name.startswith("z/tuning/")}
    if all(n for _, n in best.values()):
        # the gain must do with either contact: the smaller of both counts
        pairs = {name.rpartition("-")[0]: min(best[name][0], best[f"{name.rpartition('-')[0]}-stick"][0]) for name in best}
        mine = f"z/tuning/{cases.CARROT.speed:g}-{cases.CARROT.gain:g}"
        n = best[f"{mine}-slide"][1]
        text = f"no other speed and gain of following the carrot succeed more often in the Z-maze than {mine.rpartition('/')[2]}"
        out.append(_told("B", text, pairs[mine] / n, f">= {max(pairs.values()) / n:.4g}", n, max(pairs.values()) / n - 1e-9, 1.0))
    return out


def _narrative(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    free = runs.of("free/planner/low")
    out.append(_median("5.2", "the wave reaches the second location around t = 150", numbers(free, "wave"), "135 to 165", 135, 165))
    out.append(_median("5.2", "the robot leaves after t = 210", numbers(free, "moved"), "210 to 260", 210, 260))
    for noise in NOISES:
        text = f"without an obstacle it always takes the shortest, north route, {noise} noise"
        out.append(_share("5.2", text, runs.of(f"free/planner/{noise}"), lambda r: r["route"] == NORTH, 0.95, runs))
        text = f"the plan is to go north, west, south and east: runs whose intentions come in this order, {noise} noise"
        out.append(_share("5.2", text, runs.of(f"free/planner/{noise}"), lambda r: _in_order(r, "north", "west", "south", "east"), 0.9, runs))
    told = runs.of("narrative/planner/low")
    out.append(_share("5.2", "a full obstacle at t = 336 makes it plan anew and go south", told, lambda r: r["route"] == SWITCH, 0.7, runs))
    text = "planning anew, motivation to go west at the second location dies away between 350 and 550: it ends at"
    out.append(_median("5.2", text, numbers(told, "west_ends"), "350 to 550", 350, 550))
    out.append(_median("5.2", "motivation to go east is there from around t = 550 on", numbers(told, "east_begins"), "495 to 605", 495, 605))
    text = "it then goes east, south, west and, finally, north"
    out.append(_share("5.2", text, told, lambda r: _in_order(r, "east", "south", "west", "north"), 0.7, runs))
    out.append(_median("5.2", "that run is at its fourth location at t = 1250: arrival", numbers(told, "arrival"), "1125 to 1375", 1125, 1375))
    out.append(_median("5.2", "planning anew takes from 350 to 550: time of standing still", numbers(told, "still"), "100 to 300", 100, 300))
    return out


def _in_order(row: Row, *names: str) -> bool:
    """Whether these behaviours come one after another in a run, others between them allowed."""
    rest = iter(row["behaviours"])
    return all(name in rest for name in names)


def _passage(row: Row) -> float | None:
    """Mean speed beside the partial obstacle, on the north route, while it is there; in cm a step. Without one: in the same place."""
    path, (x, y) = np.asarray(row["path"]), place(*cases.OBSTACLES["partial"][1])
    times = KEPT * np.arange(len(path))
    present = (times >= row.get("onset", 0)) & (times <= row.get("onset", 0) + row.get("duration", cases.LIMIT))
    beside = present & (np.abs(path[:, 0] - x) < cases.OBSTACLES["partial"][2][0] / 2) & (path[:, 1] > y)
    step = np.linalg.norm(np.diff(path, axis=0), axis=1) / KEPT
    return float(step[beside[1:]].mean()) if beside.sum() > LASTS else None


def _case_3_early(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for obstacle in ("full", "partial"):
        for noise in NOISES:
            early = between(runs.kept(obstacle, noise), (0, 150))
            text = f"an obstacle during early planning sends it south, whatever its type: {obstacle}, {noise} noise, onset to 150"
            out.append(_share("5.2", text, early, lambda r: r["route"] == SOUTH, 0.8, runs))
    partial = between(runs.kept("partial", "low"), (0, 200), (0, 100))
    full = between(runs.kept("full", "low"), (0, 200), (0, 100))
    text = "a partial obstacle in the first 200 steps sends it south even if it is short (to 100 steps)"
    out.append(_share("5.2", text, partial, lambda r: r["route"] == SOUTH, 0.8, runs))
    value, interval, n = _difference(count(full, lambda r: r["route"] == NORTH), count(partial, lambda r: r["route"] == NORTH))
    text = "a short full obstacle has less effect than a short partial one: share of north, full less partial"
    out.append(_told("5.2", text, value, "> 0", n, 1e-9, 1.0, interval))
    return out


def _case_3_late(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for noise in NOISES:
        partial, full = runs.kept("partial", noise), runs.kept("full", noise)
        text = f"a partial obstacle during late planning or execution does not change the route, {noise} noise"
        out.append(_share("5.2", text, between(partial, (200, 1000)), lambda r: r["route"] == NORTH, 0.9, runs))
        both = between([*partial, *full], (201, 1000))
        text = f"after t = 200 it first takes the north route in almost all cases, {noise} noise"
        out.append(_share("5.2", text, both, lambda r: r["route"] in (NORTH, SWITCH), 0.95, runs))
        text = f"a full obstacle at 200 < t < 500 that lasts more than 200 steps makes it switch, {noise} noise"
        out.append(_share("5.2", text, between(full, (201, 499), (201, 1000)), lambda r: r["route"] == SWITCH, 0.7, runs))
        text = f"after t = 500 it always takes the north route, {noise} noise"
        out.append(_share("5.2", text, between([*partial, *full], (501, 1000)), lambda r: r["route"] == NORTH, 0.95, runs))
        late, early = (between(full, onset, (50, 250)) for onset in ((201, 450), (0, 150)))
        value, interval, n = _difference(count(late, lambda r: r["route"] == NORTH), count(early, lambda r: r["route"] == NORTH))
        text = f"it persists more after t = 200: share of north for obstacles of 50 to 250 steps, later less earlier, {noise} noise"
        out.append(_told("5.2", text, value, "> 0", n, 1e-9, 1.0, interval))
        value, interval, n = _difference(*(count(between([*partial, *full], route=w), lambda r: r["still"] > 50) for w in (SWITCH, SOUTH)))
        text = f"switching takes a time of standing still: share of runs that stand for 50 steps, switch less south, {noise} noise"
        out.append(_told("5.2", text, value, "> 0", n, 1e-9, 1.0, interval))
        for obstacle in cases.DRAW:
            text = f"runs left out because the obstacle came down on the robot, {noise} noise, {obstacle} obstacle"
            out.append(_told("5.2", text, runs.left_out(obstacle, noise), "reported", len(runs.of(f"{obstacle}/planner/{noise}"))))
    return out


def _section_6_2(runs: Runs) -> list[Claim]:
    rows = [r for r in _planned(runs) if r["plan"] is not None and r["shortest"] is not None]
    far, when = numbers(rows, "shortest"), numbers(rows, "plan")
    out: list[Claim] = []
    if len(far) > 2:
        slope, offset = np.polyfit(far, when, 1)
        rest = float(1 - np.var(when - slope * far - offset) / np.var(when))
        out.append(_told("6.2", "activation spreads with a constant speed: share of variance of planning time that is linear in Lo", rest, ">= 0.9",
                         len(far), 0.9, 1.0))  # fmt: skip
        out.append(_told("6.2", "speed of the wave, cm a step", 1 / slope, "reported", len(far)))
    switched = [r for noise in NOISES for r in between(runs.kept("full", noise), route=SWITCH)]
    plan = numbers(runs.of("free/planner/low"), "plan")
    still, n = numbers(switched, "still"), min(len(switched), len(plan))
    value = float(np.median(still) / np.median(plan)) if n else None
    interval = ratio_interval(still, plan) if n else None
    out.append(
        _told("6.2", "planning anew is shorter than planning: standing still over the time of the first plan", value, "< 1", n, 0, 1, interval)
    )
    for maze in MAZE:
        found = [r["clearance"] - r["shortest_clearance"] for r in _planned(runs, maze) if r["success"] and r["shortest_clearance"] is not None]
        value = float(np.mean(found)) if found else None
        text = f"paths keep away from walls: mean distance to the nearest one less that of the shortest path, cm, {MAZE[maze]}"
        out.append(_told("6.2", text, value, "> 0", len(found), 1e-9, np.inf, mean_interval(found)))
    south = numbers([r for k in NOISES for o in ("full", "partial") for r in between(runs.kept(o, k), route=SOUTH)], "clearance")
    north = numbers([r for k in NOISES for r in between(runs.kept("partial", k), (200, 400), (200, 500), route=NORTH)], "clearance")
    n = min(len(south), len(north))
    value, interval = (float(np.median(south) / np.median(north)), ratio_interval(south, north)) if n else (None, None)
    out.append(
        _told(
            "6.2", "the south route keeps farther from walls than the north one past a partial obstacle: ratio", value, "> 1", n, 1, np.inf, interval
        )
    )
    slow = [v for k in NOISES for r in between(runs.kept("partial", k), route=NORTH) if (v := _passage(r)) is not None]
    free = [v for k in NOISES for r in runs.of(f"free/planner/{k}") if (v := _passage(r)) is not None]
    n = min(len(slow), len(free))
    value, interval = (float(np.median(slow) / np.median(free)), ratio_interval(slow, free)) if n else (None, None)
    out.append(
        _told("6.2", "the narrow passage beside a partial obstacle reduces the velocity: ratio to that without one", value, "< 1", n, 0, 1, interval)
    )
    longest = sorted((r for r in _planned(runs, "large") if r["shortest"] is not None), key=lambda r: r["shortest"])
    text = "long paths do not suffer from low gradients: success over the longest third in the large maze"
    out.append(_share("6.2", text, longest[2 * len(longest) // 3 :], lambda r: r["success"], 0.85, runs))
    return out


def _section_6_4(runs: Runs) -> list[Claim]:
    low, high = (count(_planned(runs, noises=[k]), lambda r: not r["success"]) for k in NOISES)
    value, interval, n = _difference(low, high)
    out = [
        _told("6.4", "high noise reduces the number of unsuccessful runs: share at low less that at high noise", value, "> 0", n, 1e-9, 1.0, interval)
    ]
    failed = [r for r in _planned(runs) if not r["success"]]
    hits, _ = count(_planned(runs), lambda r: not r["success"])
    everything = len(_planned(runs))
    interval = wilson(hits, everything)
    value = hits / everything if everything else None
    out.append(_told("6.4", "on a few occasions the robot is stuck: share of all runs", value, "0 to 0.1", everything, 0, 0.1, interval))
    stuck = sum(not r["touches_at_end"] for r in failed)
    text = "what sticks is a local minimum, not a wall: share of these runs that touch nothing at the end"
    out.append(_told("6.4", text, stuck / len(failed) if failed else None, ">= 0.5", len(failed), 0.5, 1.0, wilson(stuck, len(failed))))
    for maze in MAZE:
        groups = [runs.divergences(f"{maze}/planner/{noise}") for noise in NOISES]
        found, n = anova(groups), min(map(len, groups))
        out.append(
            _told("6.4", f"noise has no significant effect on paths in the {MAZE[maze]} (one-way ANOVA, p)", found and found[1], "> 0.05", n, 0.05, 1)
        )
    return out


def _section_7(runs: Runs) -> list[Claim]:
    out: list[Claim] = []
    for method, words in (("carrot", "well tuned, sliding"), ("weak-carrot", "weak gain, sticking")):
        planner = count(_planned(runs, "large"), lambda r: r["success"])
        rows = [r for noise in ("none", "low", "high") for r in runs.of(f"large/{method}/{noise}")]
        value, interval, n = _difference(planner, count(rows, lambda r: r["success"]))
        text = f"in the large maze the planner succeeds notably more often than following the carrot ({words}): difference"
        out.append(_told("7", text, value, ">= 0.1", n, 0.1, 1.0, interval))
        failed = [r for r in rows if not r["success"]]
        text = f"the carrot fails by cutting corners: share of its failures that touch a wall at the end ({words})"
        out.append(_share("7", text, failed, lambda r: r["touches_at_end"], 0.8, runs))
    for noise in NOISES:
        text = f"a goal may change at any time: runs in which it moves while the robot drives, and that reach where it went, {noise} noise"
        out.append(_share("3.2", text, runs.of(f"moved/planner/{noise}"), lambda r: r["success"], 0.9, runs))
        short = between(runs.kept("full", noise), (201, 1000), (0, 100))
        text = f"transient blockages do not result in planning anew: full obstacles of up to 100 steps after t = 200, {noise} noise"
        out.append(_share("7", text, short, lambda r: r["route"] == NORTH, 0.9, runs))
    return out
