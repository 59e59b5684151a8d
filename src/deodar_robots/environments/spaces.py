"""The spaces of a closed loop, and its observations as their elements."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from gymnasium import spaces

from deodar_robots.environments.loop import ClosedLoop


def action_space(loop: ClosedLoop) -> spaces.Box:
    """Return the space of actions: a number for each parameter."""
    low, high = np.array(list(loop.act.values()), np.float32).T
    return spaces.Box(low, high, dtype=np.float32)


def observation_space(loop: ClosedLoop) -> spaces.Box | spaces.Dict:
    """Return the space of observations: that of the port, or a dictionary by path if there are several."""
    boxes = {
        path: spaces.Box(-np.inf, np.inf, shape, np.dtype(loop.precision).type)
        for path, (*_, shape) in loop.see.items()
    }
    return next(iter(boxes.values())) if len(boxes) == 1 else spaces.Dict(dict(boxes))


def element(seen: Mapping[str, np.ndarray]) -> np.ndarray | dict[str, np.ndarray]:
    """Return observations by path as an element of the space."""
    return next(iter(seen.values())) if len(seen) == 1 else dict(seen)
