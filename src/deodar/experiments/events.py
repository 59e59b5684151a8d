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

from deodar.experiments.observable import REDUCES, Observable
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
        name: name of the event in rows.
        of: path of the port, or name of a sensor of the world; the path of a field alone means its
            activation.
        level: the value.
        side: `above` or `below` it.
        reduce: reduction of an array to the compared number: max, min, mean or sum.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial.
    """

    name: Annotated[str, Recompile(meaning="name in the rows")]
    of: Annotated[str, Recompile(meaning="path of the port, or name of a sensor of the world", names="port")]
    level: Annotated[float, Recompile(meaning="the value")] = 0.0
    side: Annotated[str, Recompile(choices=tuple(COMPARES), meaning="side of the value")] = "above"
    reduce: Annotated[
        str, Recompile(choices=tuple(REDUCES), meaning="number that an array is reduced to")
    ] = "max"
    times: Annotated[int, Recompile(lower=1, meaning="number of samples at which it holds")] = 1
    ends: Annotated[bool, Recompile(meaning="whether the trial ends then")] = True

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
        name: name of the event in rows.
        at: the document time; the first sampling time at it or later counts.
        ends: whether the event ends the trial.
    """

    name: Annotated[str, Recompile(meaning="name in the rows")]
    at: Annotated[float, Recompile("time", role="moment", lower=0.0, meaning="the document time")]
    ends: Annotated[bool, Recompile(meaning="whether the trial ends then")] = True

    def holds(self, samples: Samples) -> np.ndarray:
        return (samples.times >= self.at - 1e-9 * max(1.0, abs(self.at)))[None]


@EVENTS.register
@dataclass(frozen=True)
class Appears(Event):
    """A peak appears in a field: its activation is above a threshold anywhere, or near a position.

    Attributes:
        name: name of the event in rows.
        field: path of the field, or of one of its ports; a field alone means its activation.
        threshold: threshold of the activation.
        near: a position, in axis units, one number or one per axis; none: anywhere.
        radius: distance from that position, along every axis.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial.
    """

    name: Annotated[str, Recompile(meaning="name in the rows")]
    field: Annotated[str, Recompile(meaning="path of the field", names="element")]
    threshold: Annotated[float, Recompile("activation", meaning="of the activation")] = 0.0
    near: Annotated[PerAxis | None, Recompile("axis", meaning="a place; none: anywhere")] = None
    radius: Annotated[
        float, Recompile("axis", lower=0.0, meaning="radius around that place, along every axis")
    ] = 0.0
    times: Annotated[int, Recompile(lower=1, meaning="number of samples at which it holds")] = 1
    ends: Annotated[bool, Recompile(meaning="whether the trial ends then")] = True

    @property
    def views(self) -> tuple[Observable, ...]:
        near = (
            ()
            if self.near is None
            else tuple(map(float, self.near))
            if isinstance(self.near, Sequence)
            else (float(self.near),)
        )
        return (Observable(self.field, "max", near, self.radius, "activation"),)

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

    Attributes:
        name: name of the event in rows.
        field: path of the field, or of one of its ports; a field alone means its activation.
        threshold: threshold of the activation.
        near: a position, in axis units, one number or one per axis; none: anywhere.
        radius: distance from that position, along every axis.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial.
    """

    turns: ClassVar[bool] = True

    def holds(self, samples: Samples) -> np.ndarray:
        return ~super().holds(samples)


@EVENTS.register
@dataclass(frozen=True)
class Within(Event):
    """One position is within a radius of another, for example of a goal.

    Attributes:
        name: name of the event in rows.
        radius: the distance, in the unit of the world.
        of: the sensor or port whose first two values are the position.
        goal: the sensor or port whose first two values are the goal.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial.
    """

    name: Annotated[str, Recompile(meaning="name in the rows")]
    radius: Annotated[float, Recompile(lower=0.0, meaning="in the unit of the world")]
    of: Annotated[
        str, Recompile(meaning="sensor or port whose first two values are the place", names="port")
    ] = "pose"
    goal: Annotated[
        str, Recompile(meaning="sensor or port whose first two values are the goal", names="port")
    ] = "goal"
    times: Annotated[int, Recompile(lower=1, meaning="number of samples at which it holds")] = 1
    ends: Annotated[bool, Recompile(meaning="whether the trial ends then")] = True

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
        name: name of the event in rows.
        radius: the distance, in the unit of the world.
        of: the sensor or port whose first two values are the position.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial.
    """

    name: Annotated[str, Recompile(meaning="name in the rows")]
    radius: Annotated[float, Recompile(lower=0.0, meaning="in the unit of the world")]
    of: Annotated[
        str, Recompile(meaning="sensor or port whose first two values are the place", names="port")
    ] = "pose"
    times: Annotated[int, Recompile(lower=1, meaning="number of samples at which it holds")] = 1
    ends: Annotated[bool, Recompile(meaning="whether the trial ends then")] = False

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
        name: name of the event in rows.
        of: their names.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial.
    """

    name: Annotated[str, Recompile(meaning="name in the rows")]
    of: Annotated[Sequence[str], Recompile(meaning="names of other events", names="event")]
    times: Annotated[int, Recompile(lower=1, meaning="number of samples at which it holds")] = 1
    ends: Annotated[bool, Recompile(meaning="whether the trial ends then")] = True

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
    """At least one of some events holds.

    Attributes:
        name: name of the event in rows.
        of: their names.
        times: number of samples at which it holds, not necessarily consecutive.
        ends: whether the event ends the trial.
    """

    def holds(self, samples: Samples) -> np.ndarray:
        return np.logical_or.reduce([samples.holds[name] for name in self.of])
