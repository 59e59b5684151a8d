"""The share of an object that a camera sees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from deodar_robots.mujoco.camera import FAR, VISIBLE
from deodar_robots.mujoco.scene_file import simulator

POINTS = 200
"""Points on the top of an object to which rays are cast."""

LIFT = 1e-4
"""Height of these points above the top, m, so that the rays end outside of the object."""


def visible(model: Any, data: Any, camera: str, body: str, radius: float, height: float) -> float:
    """Return the share of the top of a body that a camera sees, 0 to 1.

    The top is a disc around the vertical axis of the body; points cover it evenly, in a golden spiral.
    """
    k = np.arange(POINTS)
    away, turn = radius * np.sqrt((k + 0.5) / POINTS), k * math.pi * (3 - math.sqrt(5))
    own = np.stack([away * np.cos(turn), away * np.sin(turn), np.full(POINTS, height / 2 + LIFT)], axis=1)
    place = data.body(body)
    tops = own @ np.asarray(place.xmat).reshape(3, 3).T + place.xpos
    eye = np.asarray(data.camera(camera).xpos)
    rays, lengths = tops - eye, np.linalg.norm(tops - eye, axis=1)
    geom, distance = np.full(POINTS, -1, np.int32), np.empty(POINTS)
    simulator().mj_multiRay(
        model,
        data,
        eye.reshape(3, 1),
        (rays / lengths[:, None]).reshape(-1, 1),
        VISIBLE,
        1,
        -1,
        geom,
        distance,
        None,
        POINTS,
        FAR,
    )
    return float(np.mean((geom < 0) | (distance >= lengths - 1e-9)))
