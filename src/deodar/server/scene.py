"""The world from above, as messages: the scene, and the bodies with the new part of their path."""

from __future__ import annotations

from deodar.live.published import PublishedState
from deodar.live.track import Trail
from deodar.server.to_page import Bodies, BodyView, BoxView, MarkView, SceneView, WorldScene
from deodar.worlds import _scene
from deodar.worlds._base import World

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
    boxes = [
        BoxView(
            name=b.name,
            x=b.center[0],
            y=b.center[1],
            width=b.size[0],
            height=b.size[1],
            color=list(b.color),
            fixed=b.fixed,
        )
        for b in seen.boxes
    ]
    marks = [MarkView(name=m.name, x=m.center[0], y=m.center[1], fixed=m.fixed) for m in seen.marks]
    plan = SceneView(unit=seen.unit, border=list(seen.border), boxes=boxes, marks=marks)
    return WorldScene(scene=plan, note=note, camera=world is not None and CAMERA in world.sensors)


class SentBodies:
    """The bodies and the part of their path that one page has received."""

    def __init__(self) -> None:
        self._path: Trail | None = None
        self._taken = 0
        self._bodies: list[BodyView] = []

    def news(self, state: PublishedState) -> Bodies | None:
        """Return the bodies and the part of their path that the page does not have; None if nothing moved."""
        seen, path, count = state.scene, state.trail, state.passed
        bodies = [] if seen is None else [_body(b) for b in seen.bodies]
        fresh = path is not self._path or count < self._taken
        taken = 0 if fresh else self._taken
        if not fresh and count == taken and bodies == self._bodies:
            return None
        self._path, self._taken, self._bodies = path, count, bodies
        return Bodies(
            bodies=bodies,
            fresh=fresh,
            path=[[round(v, DIGITS) for v in place] for place in path.places[taken:count]],
        )


def _body(body: _scene.SceneBody) -> BodyView:
    return BodyView(
        name=body.name, x=body.center[0], y=body.center[1], heading=body.heading, radius=body.radius
    )
