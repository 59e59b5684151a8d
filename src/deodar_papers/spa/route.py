"""Route of a run of case 3, whether the obstacle hit the robot, and how long the robot did not move."""

from __future__ import annotations

import numpy as np

from deodar.analysis.robot_paths import points, speeds
from deodar.architectures.spa import place

NORTH, SOUTH, SWITCH, NONE = "north", "south", "switch", "none"
NORTH_OF, SOUTH_OF = 30.0, 50.0
"""Rows of the published fields beyond which a path is on the north or on the south route (the authors'
scripts).
"""

SLOW = 0.05
"""Speed in cm a step below which the robot counts as at rest; without obstacles it drives 0.2 to 0.4."""

OVER = 10
"""Number of steps over which its speed is computed."""

ON_ROBOT: dict[str, tuple[tuple[tuple[float, float], ...], float]] = {
    "full": (((10, 40), (15, 40), (20, 40)), 4.0),
    "partial": (tuple((20, float(c)) for c in range(30, 51)), 8.0),
}
"""For each obstacle rows and columns, and the distance from them in cm within which it came down on the robot
(the authors' rule).
"""


def route(path: np.ndarray) -> str:
    """Return the route: `north`, `south`, `switch` (first north, then south), or `none`."""
    line = points(path)
    rows = place(0, 0)[1] - line[:, 1]
    north, south = np.flatnonzero(rows < NORTH_OF), np.flatnonzero(rows > SOUTH_OF)
    if len(north):
        return SWITCH if len(south) and south[-1] > north[0] else NORTH
    return SOUTH if len(south) else NONE


def covered(path: np.ndarray, obstacle: str) -> bool:
    """Return whether the robot was inside the obstacle, on the part of its path that it drove while the
    obstacle was present.

    Such runs are excluded and counted, as in the paper.
    """
    line = np.asarray(path, float)
    if not len(line):
        return False
    cells, reach = ON_ROBOT["full" if obstacle == "narrative" else obstacle]
    middles = np.asarray([place(*cell) for cell in cells])
    return bool((np.linalg.norm(line[:, None, :2] - middles[None], axis=-1) < reach).any())


def stillness(path: np.ndarray) -> int:
    """Return the longest uninterrupted time in which the robot did not move, in steps; 0 for a path that is
    too short.
    """
    if len(path) <= OVER:
        return 0
    slow = speeds(path, np.arange(len(path)), OVER) < SLOW
    edges = np.flatnonzero(np.diff(np.concatenate([[False], slow, [False]]).astype(int)))
    runs = edges[1::2] - edges[::2]
    return int(runs.max()) + OVER if len(runs) else 0
