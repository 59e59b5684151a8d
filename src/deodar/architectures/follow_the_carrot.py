"""Follow the carrot: a vehicle steers towards a point of its path that lies a little ahead.

A plain method that planners are compared with.

No fields: the path is given, and a step is a few lines. It moves the same vehicle in the same world as an
architecture does, through the same sensors (`place`, `heading`) and motors (`left`, `right`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deodar import renamed
from deodar.errors import ParameterError
from deodar.numerics.axes import Axis
from deodar.worlds.arena.arena import Arena

PLACE, POSE = (Axis("of", 0, 1, 2),), (Axis("of", 0, 2, 3),)


@dataclass(frozen=True)
class Carrot:
    """Parameters of the method.

    Attributes:
        speed: of both wheels together, motor steps/s.
        gain: difference of the wheels for an error of the heading, motor steps/s per rad.
        ahead: how far before the vehicle the point lies from which the nearest point of the path is taken, in
            the unit of the arena.
    """

    speed: float = 400.0
    gain: float = 400.0
    ahead: float = 1.0

    def __post_init__(self) -> None:
        if not (self.speed > 0 and self.gain > 0 and self.ahead >= 0):
            raise ParameterError(
                f"speed {self.speed:g} and gain {self.gain:g} are above 0, ahead {self.ahead:g} is 0 or above"
            )

    def wheels(self, place: np.ndarray, heading: np.ndarray, paths: np.ndarray) -> np.ndarray:
        """Speeds (copies, 2) of the left and the right wheel.

        The carrot is the point of the path nearest to the one that lies `ahead` before the vehicle::

            carrot = argmin over p of |p - look|,  look = place + ahead (cos heading, sin heading)
            turn = gain (angle of (carrot - place) - heading), the angle between -pi and pi
            left, right = speed -+ turn / 2

        Args:
            place: (copies, 2).
            heading: (copies,), rad.
            paths: (copies, points, 2); a shorter one is filled up with its last point.

        Reference:
            Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), appendix B, eq. 18; after Barton
            (2001). The paper gives the distance of 1 cm. It prints neither the speed nor the gain, nor how an
            angle becomes speeds of wheels.
        """
        look = place + self.ahead * np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        nearest = np.argmin(((paths - look[:, None]) ** 2).sum(axis=-1), axis=1)
        to = paths[np.arange(len(paths)), nearest] - place
        error = np.arctan2(to[:, 1], to[:, 0]) - heading
        turn = self.gain * (error - 2 * np.pi * np.round(error / (2 * np.pi)))
        # on the carrot there is no direction: straight on
        turn = np.where(np.linalg.norm(to, axis=1) > 1e-9, turn, 0.0)
        return np.stack([self.speed - turn / 2, self.speed + turn / 2], axis=-1)


@dataclass(frozen=True)
class Followed:
    """Courses of a batch.

    Attributes:
        pose: true x, y and heading, (steps + 1, copies, 3).
        touching: whether it touched something, (steps + 1, copies).
        steps: for each copy the step at which it ended.
    """

    pose: np.ndarray
    touching: np.ndarray
    steps: np.ndarray


@dataclass(frozen=True)
class Ending:
    """When a copy ends: once it was within `radius` of the arena's goal `times` times, or at the limit.

    Attributes:
        radius: of the goal, in the unit of the arena.
        times: steps that a copy has to be there, not necessarily one after another.
        limit: most steps, of the arena's period each.
    """

    radius: float = 7.0
    times: int = 40
    limit: int = 3000


@renamed.arguments("dd.architectures.follow")
def follow(
    arena: Arena,
    paths: Sequence[ArrayLike],
    trials: Sequence[int],
    carrot: Carrot | None = None,
    ending: Ending | None = None,
    seed: int = 0,
    between: Callable[[], None] = lambda: None,
) -> Followed:
    """Let a batch of vehicles follow a path each, from the starts that the arena has for their trials.

    The batch goes on until all copies have ended.

    Args:
        arena: where they drive.
        paths: for each trial rows of x and y, in the unit of the arena.
        trials: the trial of each copy; it keys its noise.
        carrot: the parameters.
        ending: when a copy ends; none: the defaults of `Ending`.
        seed: seed of all noise.
        between: called after each step.
    """
    carrot, ending = carrot or Carrot(), ending or Ending()
    points = [np.asarray(path, float) for path in paths]
    longest = max(map(len, points))
    filled = np.stack([np.concatenate([p, np.repeat(p[-1:], longest - len(p), axis=0)]) for p in points])
    arena.reset(seed, trials)
    goals = arena.sense("goal", PLACE, 0.0)
    there, ended = np.zeros(len(trials), int), np.full(len(trials), -1)
    pose, touching = [arena.sense("pose", POSE, 0.0)], [arena.sense("touching", (), 0.0)]
    for step in range(ending.limit + 1):
        there += np.linalg.norm(pose[-1][:, :2] - goals, axis=1) <= ending.radius
        ended = np.where((ended < 0) & ((there >= ending.times) | (step == ending.limit)), step, ended)
        if (ended >= 0).all():
            break
        wheels = carrot.wheels(arena.sense("place", PLACE, 0.0), arena.sense("heading", (), 0.0), filled)
        arena.act({"left": wheels[:, 0], "right": wheels[:, 1]}, 0.0)
        pose.append(arena.sense("pose", POSE, 0.0))
        touching.append(arena.sense("touching", (), 0.0))
        between()
    return Followed(np.stack(pose), np.stack(touching) > 0, ended)
