"""Starts and goals of cases 1 and 2, in cm of the arena."""

from __future__ import annotations

import functools
from importlib import resources

import numpy as np

from deodar.analysis.robot_paths import Grid, arena_grid
from deodar.architectures.spa import maze, place

HEADINGS = {"z": 0.0, "large": 4.983}
"""Heading of the robot at the start, rad.

The published lists state headings too, but the published simulation did not apply them: all its runs began
with the heading of the world file, which is used here.
"""

DRAW = 2015
"""Seed of the pairs of the large maze, which are not published."""

COUNT = 100
LEAST_CLEARANCE = 4.0
"""Distance of starts, goals and reference paths from all walls, cm (section 4)."""


@functools.lru_cache(maxsize=2)
def reference(name: str) -> Grid:
    """Return the grid of the reference paths of a maze: cells of 1 cm, a clearance of 4 cm, without timed
    obstacles.
    """
    arena = maze(name, "none")
    boxes = np.asarray([t.box for t in arena.objects.permanent()]) / arena.scale
    return arena_grid(boxes, [v / arena.scale for v in arena.layout.border], 1.0, LEAST_CLEARANCE)


@functools.lru_cache(maxsize=2)
def pairs(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return starts (100, 3) with heading, and goals (100, 2), of a maze: z or large."""
    starts, goals = _published() if name == "z" else _drawn(name)
    return np.concatenate([starts, np.full((len(starts), 1), HEADINGS[name])], axis=1), goals


def same(name: str) -> list[int]:
    """Return the pairs whose start is their goal: four of the published ones. They are omitted."""
    starts, goals = pairs(name)
    return [k for k in range(len(starts)) if np.array_equal(starts[k, :2], goals[k])]


def _published() -> tuple[np.ndarray, np.ndarray]:
    """Return the published lists, which came with the simulator under the BSD licence in this folder.

    The columns of a start are row, unused, column of the published fields; those of a goal are row and
    column.
    """
    folder = resources.files("deodar_papers.spa") / "pairs"
    lists = [
        np.loadtxt((folder / f"{what}_positions_z.tsv").read_text().splitlines())
        for what in ("start", "goal")
    ]
    cells = lists[0][:, [0, 2]], lists[1][:, :2]
    starts, goals = (np.asarray([place(*cell) for cell in c]) for c in cells)
    return starts, goals


def _drawn(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Draw pairs by the rule of section 4: cells of 1 cm with 4 cm to all walls, drawn uniformly, kept if one
    can be reached from the other.
    """
    on = reference(name)
    cells, regions, draw = np.argwhere(on.free), on.regions(), np.random.default_rng(DRAW)
    starts: list[tuple[float, float]] = []
    goals: list[tuple[float, float]] = []
    while len(starts) < COUNT:
        a, b = (tuple(cells[k].tolist()) for k in draw.integers(len(cells), size=2))
        if a != b and regions[a] == regions[b]:
            starts.append(on.place(a))
            goals.append(on.place(b))
    return np.asarray(starts), np.asarray(goals)
