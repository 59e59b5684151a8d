"""Where the bodies of a world went, for somebody who looks at it from above."""

from __future__ import annotations

import math

from deodar.session.session import Session
from deodar.worlds._base import World
from deodar.worlds._scene import Scene

FINE = 1 / 500
"""A body's way is kept in pieces of this share of the arena's longer side; a guess: about a pixel of what is
drawn.
"""

MOST = 4000
"""Places that are kept; where there are more, every second one goes."""

Positions = tuple[float, ...]
"""x and y of each body, one after the other."""


class Trail:
    """Places that bodies came by. It only grows; what begins anew, or is thinned, is another `Trail`."""

    def __init__(self, places: list[Positions] | None = None, fine: float = 0.0) -> None:
        self.places: list[Positions] = places or []
        self.fine = fine


class Track:
    """The scene of a session's world, and the way of its bodies since the run began.

    The engine alone lets it follow.

    Attributes:
        scene: what was seen last; None: there is nothing to see from above.
        way: where the bodies have been.
    """

    def __init__(self) -> None:
        self.scene: Scene | None = None
        self.way = Trail()
        self._of: tuple[Session, World | None] | None = None
        self._time = 0.0

    def follow(self, session: Session | None) -> None:
        """Take in where everything is now."""
        scene = None if session is None else session.scene()
        if session is None or scene is None:
            self.scene, self.way, self._of = None, Trail(), None
            return
        left, low, right, high = scene.border
        now: Positions = tuple(v for body in scene.bodies for v in body.center)
        known = self._of is not None and self._of[0] is session and self._of[1] is session.world
        if (
            not known
            or session.time < self._time
            or (self.way.places and len(self.way.places[-1]) != len(now))
        ):
            self.way = Trail(fine=FINE * max(right - left, high - low))
        self._of, self._time = (session, session.world), session.time
        last = self.way.places[-1] if self.way.places else None
        if last is None or any(
            math.hypot(now[k] - last[k], now[k + 1] - last[k + 1]) >= self.way.fine
            for k in range(0, len(now), 2)
        ):
            if len(self.way.places) >= MOST:
                self.way = Trail(self.way.places[::2], 2 * self.way.fine)
            self.way.places.append(now)
        self.scene = scene
