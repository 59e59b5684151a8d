"""Events of a trial: each is evaluated when the trial is sampled, and may end it.

Events receive arrays whose first two axes are the copies and the sampling times, so that a thousand trials
are evaluated at once.
"""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, ClassVar

import numpy as np

from deodar.experiments.observable import REDUCES, Observable, position
from deodar.family import Family
from deodar.parameters import Part, PerAxis, Recompile

COMPARES = {"above": operator.gt, "below": operator.lt}


@dataclass
class Samples:
    """Samples of some copies.

    Attributes:
        times: document time of each sampling time.
        seen: the sampled values, (copies, sampling times, ...).
        first: the values at the first sampling time of the trials, (copies, 1, ...).
        holds: which events hold at which sampling time, (copies, sampling times), as far as evaluated.
    """

    times: np.ndarray
    seen: Mapping[Observable, np.ndarray]
    first: Mapping[Observable, np.ndarray]
    holds: dict[str, np.ndarray] = field(default_factory=dict[str, np.ndarray])


class Event(Part):
    """Base of events of a trial.

    Attributes:
        name: name of the event in rows.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial; its name is then the outcome.
    """

    name: str
    times: int = 1
    ends: bool = True

    turns: ClassVar[bool] = False
    """Edge-triggered: fires on a false-to-true transition."""

    @property
    def views(self) -> tuple[Observable, ...]:
        """The values to sample, or their reductions."""
        return ()

    @property
    def others(self) -> tuple[str, ...]:
        """Names of the other events that the event is made of."""
        return ()

    def holds(self, samples: Samples) -> np.ndarray:
        """Return whether the event holds at each sampling time, (copies, sampling times)."""
        raise NotImplementedError


EVENTS = Family(Event)
"""The kinds of events; each is registered where it is declared."""


@EVENTS.register
@dataclass(frozen=True)
class Crosses(Event):
    """A port or a sensor is above or below a value.

    Attributes:
        of: path of the port, or name of a sensor of the world; the path of a field alone means its
            activation.
        level: the value.
        side: `above` or `below` it.
        reduce: reduction of an array to the compared number: max, min, mean or sum.
    """

    name: str
    of: Annotated[str, Recompile(names="port")]
    level: float = 0.0
    side: Annotated[str, Recompile(choices=tuple(COMPARES))] = "above"
    reduce: Annotated[str, Recompile(choices=tuple(REDUCES))] = "max"
    times: Annotated[int, Recompile(lower=1)] = 1
    ends: bool = True

    @property
    def views(self) -> tuple[Observable, ...]:
        return (Observable(self.of, self.reduce),)

    def holds(self, samples: Samples) -> np.ndarray:
        return COMPARES[self.side](samples.seen[self.views[0]], self.level)


@EVENTS.register
@dataclass(frozen=True)
class Reached(Event):
    """A time is reached.

    Attributes:
        at: the document time; the first sampling time at it or later counts.
    """

    name: str
    at: Annotated[float, Recompile("time", role="moment", lower=0.0)]
    ends: bool = True

    def holds(self, samples: Samples) -> np.ndarray:
        return (samples.times >= self.at - 1e-9 * max(1.0, abs(self.at)))[None]


@EVENTS.register
@dataclass(frozen=True)
class Appears(Event):
    """A peak appears in a field: its activation is above a threshold anywhere, or near a position.

    Attributes:
        field: path of the field, or of one of its ports; a field alone means its activation.
        threshold: threshold of the activation.
        near: a position, in axis units, one number or one per axis; none: anywhere.
        radius: distance from that position, along every axis.
    """

    name: str
    field: Annotated[str, Recompile(names="element")]
    threshold: Annotated[float, Recompile("activation")] = 0.0
    near: Annotated[PerAxis | None, Recompile("axis")] = None
    radius: Annotated[float, Recompile("axis", lower=0.0)] = 0.0
    times: Annotated[int, Recompile(lower=1)] = 1
    ends: bool = True

    @property
    def views(self) -> tuple[Observable, ...]:
        return (Observable(self.field, "max", position(self.near), self.radius, "activation"),)

    def validate(self) -> Iterator[tuple[str, str]]:
        if self.near is not None and self.radius == 0.0:
            yield "radius", "is 0, and a place alone contains no sample; state a radius"

    def holds(self, samples: Samples) -> np.ndarray:
        return samples.seen[self.views[0]] > self.threshold


@EVENTS.register
@dataclass(frozen=True)
class Vanishes(Appears):
    """A peak of a field vanishes: its activation falls below the threshold everywhere, or everywhere near a
    position.
    """

    turns: ClassVar[bool] = True

    def holds(self, samples: Samples) -> np.ndarray:
        return ~super().holds(samples)


@EVENTS.register
@dataclass(frozen=True)
class Within(Event):
    """One position is within a radius of another, for example of a goal.

    Attributes:
        radius: the distance, in the unit of the world.
        of: the sensor or port whose first two values are the position.
        goal: the sensor or port whose first two values are the goal.
    """

    name: str
    radius: Annotated[float, Recompile(lower=0.0)]
    of: Annotated[str, Recompile(names="port")] = "pose"
    goal: Annotated[str, Recompile(names="port")] = "goal"
    times: Annotated[int, Recompile(lower=1)] = 1
    ends: bool = True

    @property
    def views(self) -> tuple[Observable, ...]:
        return Observable(self.of), Observable(self.goal)

    def holds(self, samples: Samples) -> np.ndarray:
        of, goal = (samples.seen[view][..., :2] for view in self.views)
        return np.linalg.norm(of - goal, axis=-1) <= self.radius


@EVENTS.register
@dataclass(frozen=True)
class Leaves(Event):
    """A position is farther than a radius from its value at the first sampling time: something has moved.

    Attributes:
        radius: the distance, in the unit of the world.
        of: the sensor or port whose first two values are the position.
    """

    name: str
    radius: Annotated[float, Recompile(lower=0.0)]
    of: Annotated[str, Recompile(names="port")] = "pose"
    times: Annotated[int, Recompile(lower=1)] = 1
    ends: bool = False

    @property
    def views(self) -> tuple[Observable, ...]:
        return (Observable(self.of),)

    def holds(self, samples: Samples) -> np.ndarray:
        view = self.views[0]
        return (
            np.linalg.norm(samples.seen[view][..., :2] - samples.first[view][..., :2], axis=-1) > self.radius
        )


@EVENTS.register
@dataclass(frozen=True)
class All(Event):
    """All of some events hold at the same sampling time.

    Attributes:
        of: their names.
    """

    name: str
    of: Annotated[Sequence[str], Recompile(names="event")]
    times: Annotated[int, Recompile(lower=1)] = 1
    ends: bool = True

    @property
    def others(self) -> tuple[str, ...]:
        return tuple(self.of)

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.of:
            yield "of", "names no events"

    def holds(self, samples: Samples) -> np.ndarray:
        return np.logical_and.reduce([samples.holds[name] for name in self.of])


@EVENTS.register
@dataclass(frozen=True)
class AnyOf(All):
    """At least one of some events holds."""

    def holds(self, samples: Samples) -> np.ndarray:
        return np.logical_or.reduce([samples.holds[name] for name in self.of])
