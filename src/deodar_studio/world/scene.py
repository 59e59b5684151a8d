"""The world as messages: the scene from above, its solids, and the bodies with the new part of their path."""

from __future__ import annotations

import base64

from deodar.worlds import _scene
from deodar.worlds._base import World
from deodar.worlds._motor_rule import MotorRule
from deodar.worlds._scene import Solid
from deodar_studio.live.published import PublishedState
from deodar_studio.live.track import Trail
from deodar_studio.messages.message import made_of
from deodar_studio.messages.to_page import (
    Bodies,
    BodyView,
    BoxView,
    MarkView,
    MotorLimits,
    PictureView,
    RobotLink,
    SceneView,
    SolidView,
    WorldScene,
    WorldSolids,
)

DIGITS = 6
"""Decimal digits of positions in messages: more than a screen shows."""


CAMERA = "camera"
"""Name of the sensor whose picture the panel of the world shows."""


def scene(seen: _scene.Scene | None, note: str = "", world: World | None = None) -> WorldScene:
    """Return the message with the boxes and marks of a scene, which change only when the user moves them.

    Args:
        seen: the scene; None: the world has no view from above.
        note: what a record does not contain of it.
        world: the running world; None: a record is open.
    """
    if seen is None:
        return WorldScene(scene=None, note=note)
    boxes = [made_of(BoxView, b, **_place(b), width=b.size[0], height=b.size[1]) for b in seen.boxes]
    plan = made_of(
        SceneView, seen, boxes=boxes, marks=[made_of(MarkView, m, **_place(m)) for m in seen.marks]
    )
    camera = world is not None and CAMERA in world.sensors
    picture = None if seen.picture is None else made_of(PictureView, seen.picture)
    return WorldScene(
        scene=plan,
        note=note,
        camera=camera,
        solid=bool(seen.solids),
        can_place=world is not None and world.can_place,
        picture=picture,
    )


def robot_link(world: World | None) -> RobotLink:
    """Return the message with the link of a running world, rounded to what a page shows."""
    link = None if world is None else world.link()
    if world is None or link is None:
        return RobotLink()
    return made_of(
        RobotLink,
        link,
        age=round(link.age, -1),
        round_trip=round(link.round_trip, 1),
        motors=motor_limits(world),
        can_narrow=world.can_narrow,
    )


def motor_limits(world: World) -> list[MotorLimits]:
    """Return what the motors of a world allow."""
    limits: list[MotorLimits] = []
    for motor, signal in world.motors.items():
        rule = world.rules.get(motor, MotorRule())
        lower, upper = rule.limits or (None, None)
        limits.append(MotorLimits(motor=motor, lower=lower, upper=upper, slew=rule.slew, unit=signal.unit))
    return limits


class SentBodies:
    """The bodies, the solids and the part of their path that one page has received.

    Args:
        solid: whether the page shows the solids.
    """

    def __init__(self, solid: bool = False) -> None:
        self._solid = solid
        self._path: Trail | None = None
        self._taken = 0
        self._bodies: list[BodyView] = []
        self._solids: tuple[Solid, ...] = ()
        self._poses = b""
        self._picture = b""

    def news(self, state: PublishedState) -> list[WorldSolids | Bodies]:
        """Return the solids, bodies and the part of their path that the page does not have."""
        seen, path, count = state.scene, state.trail, state.passed
        bodies = [] if seen is None else [made_of(BodyView, b, **_place(b)) for b in seen.bodies]
        out: list[WorldSolids | Bodies] = []
        shown, poses = (seen.solids, seen.poses) if seen is not None and self._solid else ((), b"")
        if shown != self._solids:
            self._solids = shown
            out.append(WorldSolids(solids=[_solid(s) for s in shown]))
        picture = b"" if seen is None or seen.picture is None else seen.picture.pixels
        fresh = path is not self._path or count < self._taken
        taken = 0 if fresh else self._taken
        same = bodies == self._bodies and poses == self._poses and picture == self._picture
        if same and not fresh and count == taken and not out:
            return []
        self._path, self._taken, self._bodies, self._poses = path, count, bodies, poses
        self._picture = picture
        moved = Bodies(
            bodies=bodies,
            fresh=fresh,
            path=[[round(v, DIGITS) for v in place] for place in path.places[taken:count]],
            poses=_text(poses),
            picture=_text(picture),
        )
        return [*out, moved]


def _solid(solid: Solid) -> SolidView:
    points, faces = (b"", b"") if solid.mesh is None else (solid.mesh.points, solid.mesh.faces)
    return made_of(SolidView, solid, points=_text(points), faces=_text(faces))


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode()


def _place(of: _scene.SceneBox | _scene.Mark | _scene.SceneBody) -> dict[str, float]:
    """Return where the middle of something lies."""
    return {"x": of.center[0], "y": of.center[1]}
