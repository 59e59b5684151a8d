"""The geoms of a scene as solids, for a view in three dimensions."""

from __future__ import annotations

from collections.abc import Container
from typing import Any

import numpy as np

from deodar.worlds._scene import Mesh, Solid, SolidShape
from deodar_robots.mujoco.cameras import VISIBLE
from deodar_robots.mujoco.scene_file import simulator


def shown(model: Any) -> list[int]:
    """Return the geoms that are drawn: of a visible group and a known shape, and not fully transparent."""
    known = _shapes()
    return [
        k
        for k in range(model.ngeom)
        if VISIBLE[model.geom_group[k]] and model.geom_rgba[k][3] > 0 and int(model.geom_type[k]) in known
    ]


def solids(model: Any, shades: np.ndarray, things: Container[str]) -> tuple[Solid, ...]:
    """Return the geoms that are drawn, in their order.

    Args:
        model: the compiled scene.
        shades: red, green and blue of each geom.
        things: names of the objects that can be moved by hand.
    """
    known = _shapes()
    out: list[Solid] = []
    for k in shown(model):
        body = int(model.geom_bodyid[k])
        name, shape = model.body(body).name, known[int(model.geom_type[k])]
        x, y, z = (float(v) for v in model.geom_size[k])
        red, green, blue = (float(v) for v in shades[k])
        thing = name if name in things else ""
        out.append(
            Solid(
                name,
                shape,
                (x, y, z),
                (red, green, blue, float(model.geom_rgba[k][3])),
                thing,
                # what is welded to the world cannot move
                not thing and int(model.body_weldid[body]) != 0,
                _mesh(model, int(model.geom_dataid[k])) if shape == "mesh" else None,
            )
        )
    return tuple(out)


def poses(data: Any, geoms: list[int]) -> bytes:
    """Return position and rotation matrix of geoms, 12 numbers of 32 bits each."""
    rows = np.concatenate([data.geom_xpos[geoms], data.geom_xmat[geoms]], axis=1)
    return rows.astype("<f4").tobytes()


def _mesh(model: Any, k: int) -> Mesh:
    first, count = int(model.mesh_vertadr[k]), int(model.mesh_vertnum[k])
    at, faces = int(model.mesh_faceadr[k]), int(model.mesh_facenum[k])
    return Mesh(
        np.asarray(model.mesh_vert[first : first + count], "<f4").tobytes(),
        np.asarray(model.mesh_face[at : at + faces], "<i4").tobytes(),
    )


def _shapes() -> dict[int, SolidShape]:
    kinds = simulator().mjtGeom
    return {
        int(kinds.mjGEOM_PLANE): "plane",
        int(kinds.mjGEOM_SPHERE): "sphere",
        int(kinds.mjGEOM_CAPSULE): "capsule",
        int(kinds.mjGEOM_ELLIPSOID): "ellipsoid",
        int(kinds.mjGEOM_CYLINDER): "cylinder",
        int(kinds.mjGEOM_BOX): "box",
        int(kinds.mjGEOM_MESH): "mesh",
    }
