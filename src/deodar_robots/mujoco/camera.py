"""The picture of a camera of a scene by rays: no display, no graphics library, the same on every machine."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar_robots.mujoco.scene_file import simulator

CHANNELS = 3
AMBIENT = 0.4
"""Share of its colour that a surface shows where no light falls on it; the rest is diffuse reflection."""

VISIBLE = np.array([1, 1, 1, 0, 0, 0], np.uint8)
"""Groups of geoms that a camera sees: those that MuJoCo's own viewer shows."""

BACKGROUND = 0.1
"""Grey of rays that meet nothing."""

FAR = 1e10


def require_picture(sensor: str, axes: Axes) -> None:
    """Raise WorldError unless the axes are columns, rows and three channels."""
    if len(axes) != 3 or axes[2].samples != CHANNELS:
        raise WorldError(
            f"a picture has columns, rows and three channels, not {len(axes)} axes", where=sensor
        )


@functools.lru_cache(maxsize=16)
def directions(columns: int, rows: int, opening: float) -> np.ndarray:
    """Return the unit vector of the ray through each pixel, in the frame of a camera that looks along -z.

    The vertical opening angle (degrees) covers all rows; pixels are squares, so the columns decide the
    horizontal one. Shape (columns * rows, 3): the first column from above, then the next.
    """
    half = math.tan(math.radians(opening) / 2)
    across = (np.arange(columns) + 0.5 - columns / 2) * 2 * half / rows
    down = (np.arange(rows) + 0.5 - rows / 2) * 2 * half / rows
    x, y = np.meshgrid(across, down, indexing="ij")
    rays = np.stack([x, -y, -np.ones_like(x)], axis=-1).reshape(-1, 3)
    return rays / np.linalg.norm(rays, axis=1, keepdims=True)


def shades(model: Any) -> np.ndarray:
    """Return red, green and blue of each geom: its own colour, or that of its material.

    A geom has the colour of its material unless it states one; textures are not shown.
    """
    own = np.array(model.geom_rgba[:, :3], float)
    plain = np.all(np.asarray(model.geom_rgba) == 0.5, axis=1) | np.all(
        np.isclose(model.geom_rgba, [0.5, 0.5, 0.5, 1.0]), axis=1
    )
    material = np.asarray(model.geom_matid)
    use = plain & (material >= 0)
    if use.any():
        own[use] = np.asarray(model.mat_rgba)[material[use], :3]
    return own


def sun(model: Any) -> np.ndarray:
    """Return the direction from which light falls: that of the first light, else from above."""
    if model.nlight == 0:
        return np.array([0.0, 0.0, 1.0])
    found = -np.asarray(model.light_dir[0], float)
    return found / np.linalg.norm(found)


def picture(
    model: Any, data: Any, camera: str, size: tuple[int, int], colors: np.ndarray, light: float
) -> np.ndarray:
    """Return the colours that a camera sees, (columns, rows, 3), from 0 to 1.

    A surface of colour c with the normal n shows light * c * (a + (1 - a) * max(0, n . l)), with the share a
    of ambient light and the direction l of the light. `light` changes value, not hue or saturation.
    """
    index = model.camera(camera).id
    frame = np.asarray(data.cam_xmat[index]).reshape(3, 3)
    rays = directions(*size, float(model.cam_fovy[index])) @ frame.T
    count = len(rays)
    geom, distance, normal = np.full(count, -1, np.int32), np.empty(count), np.zeros(3 * count)
    simulator().mj_multiRay(
        model,
        data,
        np.asarray(data.cam_xpos[index]).reshape(3, 1),
        rays.reshape(-1, 1),
        VISIBLE,
        1,
        -1,
        geom,
        distance,
        normal,
        count,
        FAR,
    )
    lit = AMBIENT + (1 - AMBIENT) * np.clip(normal.reshape(-1, 3) @ sun(model), 0.0, None)
    seen = np.where((geom >= 0)[:, None], colors[geom] * lit[:, None], BACKGROUND) * light
    return np.clip(seen, 0.0, 1.0).reshape(*size, CHANNELS).astype(np.float32)
