"""Follow the carrot: a vehicle steers towards a point of its path at a fixed distance ahead.

The method is a baseline for planners. It has no fields, and its path is an argument. It drives the same
vehicle in the same world as an architecture, through the same sensors (`place`, `heading`) and motors
(`left`, `right`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deodar.errors import ParameterError
from deodar.numerics.axes import Axis
from deodar.summary import Summarised, Summary, counted
from deodar.worlds.arena.arena import Arena

PLACE, POSE = (Axis("of", 0, 1, 2),), (Axis("of", 0, 2, 3),)


@dataclass(frozen=True)
class Carrot:
    """Parameters of the method.

    Attributes:
        speed: mean speed of both wheels, motor steps/s.
        gain: difference of the wheel speeds per error of the heading, motor steps/s per rad.
        ahead: distance ahead of the vehicle of the point `look` in `wheels`, in the unit of the arena.
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
        """Return the speeds (copies, 2) of the left and the right wheel.

        The carrot is the point of the path nearest to the point at a distance `ahead` in front of the
        vehicle::

            carrot = argmin over p of |p - look|,  look = place + ahead (cos heading, sin heading)
            turn = gain (angle of (carrot - place) - heading), the angle between -pi and pi
            left, right = speed -+ turn / 2

        Args:
            place: (copies, 2).
            heading: (copies,), rad.
            paths: (copies, points, 2); shorter paths repeat their last point.

        Reference:
            Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), appendix B, eq. 18; after Barton
            (2001). The paper states the distance, 1 cm. It states neither the speed and the gain nor the
            conversion of an angle to wheel speeds.
        """
        look = place + self.ahead * np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        nearest = np.argmin(((paths - look[:, None]) ** 2).sum(axis=-1), axis=1)
        to = paths[np.arange(len(paths)), nearest] - place
        error = np.arctan2(to[:, 1], to[:, 0]) - heading
        turn = self.gain * (error - 2 * np.pi * np.round(error / (2 * np.pi)))
        # at the carrot its direction is undefined: drive straight on
        turn = np.where(np.linalg.norm(to, axis=1) > 1e-9, turn, 0.0)
        return np.stack([self.speed - turn / 2, self.speed + turn / 2], axis=-1)


@dataclass(frozen=True, repr=False)
class Followed(Summarised):
    """The paths that a batch of vehicles drove.

    Attributes:
        pose: true x, y and heading, (steps + 1, copies, 3).
        touching: whether the vehicle touched an obstacle or wall, (steps + 1, copies).
        steps: for each copy the step at which it ended.
    """

    pose: np.ndarray
    touching: np.ndarray
    steps: np.ndarray

    def _summary(self) -> Summary:
        collisions = int(self.touching.any(0).sum())
        return Summary(f"{counted(len(self.steps), 'path')}, {collisions} with a collision")


@dataclass(frozen=True)
class Ending:
    """The condition at which a copy ends: `times` steps within `radius` of the arena's goal, or the limit.

    Attributes:
        radius: radius around the goal, in the unit of the arena.
        times: number of steps within the radius, not necessarily consecutive.
        limit: largest number of steps, each one period of the arena.
    """

    radius: float = 7.0
    times: int = 40
    limit: int = 3000


def follow(
    arena: Arena,
    paths: Sequence[ArrayLike],
    trials: Sequence[int],
    carrot: Carrot | None = None,
    ending: Ending | None = None,
    seed: int = 0,
    between: Callable[[], None] = lambda: None,
) -> Followed:
    """Drive a batch of vehicles, each along its path, from the arena's starts of their trials.

    The batch runs until all copies have ended.

    Args:
        arena: the arena.
        paths: for each trial rows of x and y, in the unit of the arena.
        trials: trial number of each copy; it selects the noise of the copy.
        carrot: the parameters.
        ending: when a copy ends; none: the defaults of `Ending`.
        seed: seed of all noise.
        between: called after each step.

    Raises:
        ParameterError: the radius of the ending or the distance of the carrot is longer than the arena.
    """
    carrot, ending = carrot or Carrot(), ending or Ending()
    left, low, right, high = (v / arena.scale for v in arena.layout.border)
    for what, length in (("ending.radius", ending.radius), ("carrot.ahead", carrot.ahead)):
        if length >= math.hypot(right - left, high - low):
            raise ParameterError(
                f"is {length:g} {arena.unit}, longer than the arena, {right - left:g} x {high - low:g}"
                f" {arena.unit}",
                where=what,
                fix="Choose an arena in cm, for which the defaults are meant: unit='cm'",
            )
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
