"""The paths of the bodies of a world, seen from above."""

from __future__ import annotations

import math

from deodar.session.session import Session
from deodar.worlds._base import World
from deodar.worlds._scene import Scene

FINE = 1 / 500
"""Least distance between two stored positions, as a share of the arena's longer side.

A guess: about a pixel of the drawing.
"""

MOST = 4000
"""Largest number of stored positions; if it is reached, every second one is removed."""

Positions = tuple[float, ...]
"""x and y of each body, in sequence."""


class Trail:
    """Positions that bodies passed. A `Trail` only grows; a restarted or thinned path is a new `Trail`."""

    def __init__(self, places: list[Positions] | None = None, fine: float = 0.0) -> None:
        self.places: list[Positions] = places or []
        self.fine = fine


class Track:
    """The scene of a session's world, and the path of its bodies since the start of the run.

    Only the engine calls `follow`.

    Attributes:
        scene: the last scene; None: the world has no view from above.
        trail: path of the bodies.
    """

    def __init__(self) -> None:
        self.scene: Scene | None = None
        self.trail = Trail()
        self._of: tuple[Session, World | None] | None = None
        self._time = 0.0

    def back(self, session: Session, trail: Trail, passed: int) -> None:
        """Continue with the first `passed` positions of a path, at an earlier time of the session."""
        self.trail = Trail(trail.places[:passed], trail.fine)
        self._of, self._time = (session, session.world), session.time

    def follow(self, session: Session | None) -> None:
        """Store the present scene, and add the positions of the bodies to the path."""
        scene = None if session is None else session.scene()
        if session is None or scene is None:
            self.scene, self.trail, self._of = None, Trail(), None
            return
        left, low, right, high = scene.border
        positions: Positions = tuple(v for body in scene.bodies for v in body.center)
        is_same_run = self._of is not None and self._of[0] is session and self._of[1] is session.world
        if (
            not is_same_run
            or session.time < self._time
            or (self.trail.places and len(self.trail.places[-1]) != len(positions))
        ):
            self.trail = Trail(fine=FINE * max(right - left, high - low))
        self._of, self._time = (session, session.world), session.time
        last = self.trail.places[-1] if self.trail.places else None
        if last is None or any(
            math.hypot(positions[k] - last[k], positions[k + 1] - last[k + 1]) >= self.trail.fine
            for k in range(0, len(positions), 2)
        ):
            if len(self.trail.places) >= MOST:
                self.trail = Trail(self.trail.places[::2], 2 * self.trail.fine)
            self.trail.places.append(positions)
        self.scene = scene
