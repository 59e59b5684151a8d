"""Trials and the row of each."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.analysis.robot_paths import clearance, path_divergence, path_length, shortest_path
from deodar.architectures.follow_the_carrot import Ending, follow
from deodar.architectures.spa import CASE_3, DIRECTIONS, place, spa
from deodar.experiments.actions import Move
from deodar.experiments.events import Leaves, Within
from deodar.experiments.jobs import Job
from deodar.experiments.rows import Row
from deodar.experiments.trial import TrialPlan
from deodar.experiments.trials import Trials
from deodar.model.model import Model
from deodar.worlds.arena.arena import Arena
from deodar_papers.spa import cases
from deodar_papers.spa.cases import LIMIT, RADIUS, STAY, Condition
from deodar_papers.spa.pairs import pairs, reference
from deodar_papers.spa.route import covered, route, stillness

MOVED = 2.5
"""Distance from the start beyond which the robot has left it, cm."""

STRONG = 0.5
"""Output of an intention field from which on it counts as active."""

KEPT = 2
"""Number of steps between two positions of the path that a row stores."""

LASTS = 20
"""Smallest number of steps of an active intention that is listed."""

LOCATION_2 = (15, 57)
"""Row and column of the second location of figures 10 and 11: where the robot of that run is at t = 500.

Read from a run of deodar; the paper does not print it.
"""

POSE, TOUCHING = "pose.output", "touching.output"
"""Return the true pose, and whether the robot touches something, from the model's own sensors."""

STRONGEST = {name: f"{name}.strongest.output" for name in DIRECTIONS}
COST = {"z": 6.0, "large": 80.0}
"""Approximate duration of a run of the planner, s; all runs of a condition of the carrot take CARROT_COST."""

CARROT_COST = 10.0


def jobs(quick: bool) -> list[Job]:
    """Return one job for each run of the planner, and one for each condition of the carrot."""
    out: list[Job] = []
    for c in cases.conditions(quick).values():
        given = {"name": c.name, "quick": quick}
        if c.method == "carrot":
            out.append(Job(tuple(map(c.key, c.trials)), carrot, given, CARROT_COST))
        else:
            out += [Job((c.key(k),), planner, given | {"trial": k}, COST[c.maze]) for k in c.trials]
    return out


def carrot(name: str, quick: bool) -> Sequence[Row]:
    """Run a condition of following the carrot as one batch, and return its rows."""
    c = cases.conditions(quick)[name]
    arena, (starts, goals), on = cases.world(c), pairs(c.maze), reference(c.maze)
    paths = [shortest_path(on, starts[k, :2], goals[k]) for k in c.trials]
    ending = Ending(RADIUS, STAY, LIMIT)
    done = follow(arena, [p for p in paths if p is not None], c.trials, c.carrot, ending)
    out: list[Row] = []
    for i, k in enumerate(c.trials):
        end = int(done.steps[i]) + 1
        out.append(_row(c, k, done.pose[:end, i], done.touching[:end, i], goals[k], paths[i], arena))
    return out


def planner(name: str, quick: bool, trial: int) -> Sequence[Row]:
    """Run the planner once, and return the row."""
    c = cases.conditions(quick)[name]
    arena, model = _bench(name, quick)
    watch = [*STRONGEST.values(), POSE, TOUCHING]
    narrated = c.name.startswith(("free", "narrative"))
    motivated = {side: f"{side}.motivation.activation" for side in ("west", "east")} if narrated else {}
    events = [Within("done", RADIUS, POSE, "goal.output", STAY), Leaves("moved", MOVED, POSE)]
    moves = c.name.startswith("moved")
    if moves:  # exchanged outside the step
        actions = [Move(cases.MOVES, "goal", place(*cases.GOES))]
        plan = TrialPlan(LIMIT, watch, events, actions=actions)
        [course] = Trials(model, plan, arena, together=False).run([trial])
    else:
        [course] = Trials(model, TrialPlan(LIMIT, [*watch, *motivated.values()], events), arena).run([trial])
    start, goal = (
        (place(*CASE_3[0]), place(*CASE_3[1]))
        if not c.many_starts
        else (pairs(c.maze)[0][trial, :2], pairs(c.maze)[1][trial])
    )
    best = None if moves else shortest_path(reference(c.maze), start, goal)
    row = _row(
        c,
        trial,
        course.values[POSE],
        course.values[TOUCHING] > 0,
        place(*cases.GOES) if moves else goal,
        best,
        arena,
    )
    intentions = np.stack([course.values[path] for path in STRONGEST.values()], axis=1)
    moved = course.events["moved"]
    weak = np.flatnonzero(
        intentions[: int(moved if moved is not None else len(intentions))].max(axis=1) <= STRONG
    )
    both = (intentions[:, 0:2].min(axis=1) > STRONG) | (intentions[:, 2:4].min(axis=1) > STRONG)
    # first step of the intention that lasts until the robot has left; None if it never leaves
    row |= {
        "moved": moved,
        "plan": None if moved is None else int(weak[-1]) + 1 if len(weak) else 0,
        "opposed": round(float(both.mean()), 4),
    }
    row["behaviours"] = _order(intentions)
    # between leaving and arriving: before it rests because it plans, afterwards because it has arrived
    if c.obstacle:
        begin = max(row["onset"], int(moved) if moved is not None else LIMIT)
        row["still"] = stillness(course.values[POSE][begin : row["arrival"]])
    if narrated:
        west, east = (_at(model, path, course.values[path]) > 0 for path in motivated.values())
        row |= {
            "wave": _first(west),
            "west_ends": len(west) - (_first(west[::-1]) or 0),
            "east_begins": _first(east),
        }
    return [row]


# the next run of the same condition finds the compiled programs that a model keeps
@functools.lru_cache(maxsize=1)
def _bench(name: str, quick: bool) -> tuple[Arena, Model]:
    c = cases.conditions(quick)[name]
    arena = cases.world(c)
    return arena, spa(arena, c.noise, c.factor)


def _row(
    c: Condition,
    trial: int,
    pose: np.ndarray,
    touching: np.ndarray,
    goal: Any,
    best: np.ndarray | None,
    arena: Arena,
) -> Row:
    """Return the entries that all rows have. Lengths in cm, times in steps."""
    line, aim = np.asarray(pose, float)[:, :2], np.asarray(goal, float)
    near = np.linalg.norm(line - aim, axis=1) <= RADIUS
    boxes, border = _walls(arena)
    row: Row = {
        "key": c.key(trial),
        "condition": c.name,
        "trial": trial,
        "success": bool(near[-1]),
        "steps": len(line) - 1,
        "arrival": _first(near),
        "length": round(path_length(line), 3),
        "shortest": None if best is None else round(path_length(best), 3),
        "divergence": None if best is None else _rounded(path_divergence(line, best, aim, RADIUS)),
        "touching": int(touching.sum()),
        "touches_at_end": bool(touching[-50:].any()),
        "clearance": round(float(clearance(line, boxes, border).mean()), 3),
        "shortest_clearance": (
            None if best is None else round(float(clearance(best, boxes, border).mean()), 3)
        ),
        "goal": aim.round(2).tolist(),
        "path": line[::KEPT].round(2).tolist(),
    }
    if not c.many_starts:
        row["route"] = route(line)
    if c.obstacle:
        onset, duration = (int(v) for v in cases.windows(c.obstacle)[trial])
        row |= {
            "onset": onset,
            "duration": duration,
            "on_robot": covered(line[onset : onset + duration + 1], c.obstacle),
        }
    return row


def _walls(arena: Arena) -> tuple[np.ndarray, list[float]]:
    return np.asarray([t.box for t in arena.objects.permanent()]) / arena.scale, [
        v / arena.scale for v in arena.layout.border
    ]


def _order(intentions: np.ndarray) -> list[str]:
    """Return the behaviours in the order in which their intentions rose, with repetitions; short ones are
    omitted.
    """
    found: list[tuple[int, str]] = []
    for name, there in zip(STRONGEST, (intentions > STRONG).T, strict=True):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]]).astype(int)))
        found += [
            (int(begin), name)
            for begin, end in zip(edges[::2], edges[1::2], strict=True)
            if end - begin >= LASTS
        ]
    return [name for _, name in sorted(found)]


def _at(model: Model, path: str, values: np.ndarray) -> np.ndarray:
    """Return a field over time at the second location."""
    axes = model[path.rpartition(".")[0]].element.axes  # type: ignore[attr-defined]
    at = [int(np.argmin(np.abs(axis.points - v))) for axis, v in zip(axes, place(*LOCATION_2), strict=True)]
    return values[:, at[0], at[1]]


def _first(mask: np.ndarray) -> int | None:
    found = np.flatnonzero(mask)
    return int(found[0]) if len(found) else None


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 5)
