"""What may happen in a trial: it is seen when the trial is looked at, and may end it."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from deodar.errors import ParameterError, did_you_mean

Seen = Mapping[str, np.ndarray]
"""What one look saw: ports by their paths, sensors of the world by their names."""

REDUCES = {"max": np.max, "min": np.min, "mean": np.mean, "sum": np.sum}
COMPARES = {"above": operator.gt, "below": operator.lt}


@dataclass(frozen=True)
class Crosses:
    """A port or a sensor lies beyond a value.

    Attributes:
        name: what rows call it.
        of: path of the port, or name of a sensor of the world.
        level: the value.
        side: `above` or `below` it.
        reduce: what is compared of an array: max, min, mean or sum.
        times: at so many looks, not necessarily one after another.
        ends: whether the trial ends then.
    """

    name: str
    of: str
    level: float = 0.0
    side: str = "above"
    reduce: str = "max"
    times: int = 1
    ends: bool = True

    def __post_init__(self) -> None:
        for word, known in ((self.side, COMPARES), (self.reduce, REDUCES)):
            if word not in known:
                raise ParameterError(f"{word!r} is not known", where=self.name, fix=did_you_mean(word, known))

    @property
    def needs(self) -> tuple[str, ...]:
        """What has to be looked at."""
        return (self.of,)

    def holds(self, now: Seen, first: Seen) -> bool:
        """Whether it is so at a look."""
        return bool(COMPARES[self.side](REDUCES[self.reduce](now[self.of]), self.level))


@dataclass(frozen=True)
class Within:
    """One place lies within a radius of another: a goal is reached.

    Attributes:
        name: what rows call it.
        radius: in the unit of the world.
        of: the sensor or port whose first two values are the place.
        goal: the sensor or port whose first two values are the goal.
        times: at so many looks, not necessarily one after another.
        ends: whether the trial ends then.
    """

    name: str
    radius: float
    of: str = "pose"
    goal: str = "goal"
    times: int = 1
    ends: bool = True

    @property
    def needs(self) -> tuple[str, ...]:
        """What has to be looked at."""
        return self.of, self.goal

    def holds(self, now: Seen, first: Seen) -> bool:
        """Whether it is so at a look."""
        return bool(np.linalg.norm(now[self.of][:2] - now[self.goal][:2]) <= self.radius)


@dataclass(frozen=True)
class Leaves:
    """A place lies farther than a radius from where it was at the first look: something has moved.

    Attributes:
        name: what rows call it.
        radius: in the unit of the world.
        of: the sensor or port whose first two values are the place.
        times: at so many looks, not necessarily one after another.
        ends: whether the trial ends then.
    """

    name: str
    radius: float
    of: str = "pose"
    times: int = 1
    ends: bool = False

    @property
    def needs(self) -> tuple[str, ...]:
        """What has to be looked at."""
        return (self.of,)

    def holds(self, now: Seen, first: Seen) -> bool:
        """Whether it is so at a look."""
        return bool(np.linalg.norm(now[self.of][:2] - first[self.of][:2]) > self.radius)


Event = Crosses | Within | Leaves
