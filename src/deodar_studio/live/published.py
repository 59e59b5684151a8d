"""What the engine publishes: the state of a run at one moment, and the cost of its elements."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

import numpy as np

from deodar.errors import Problem
from deodar.session.cost import StepCost
from deodar.session.port_reader import PortKey
from deodar.worlds._scene import Scene
from deodar_studio.live.track import Trail


@dc.dataclass(frozen=True)
class PublishedState:
    """Published state at one moment.

    Attributes:
        number: differs between states.
        time, tick: the moment, in document time and in steps.
        arrays: values of the watched ports.
        scene: the world from above; None: it has no such view.
        trail: path of the bodies.
        passed: number of positions of `trail` up to this moment.
    """

    number: int
    time: float
    tick: int
    arrays: Mapping[PortKey, np.ndarray]
    scene: Scene | None = None
    trail: Trail = dc.field(default_factory=Trail)
    passed: int = 0


@dc.dataclass(frozen=True, eq=False)
class CostReport:
    """Cost of elements: whether a measurement runs, the last result, and why a measurement failed."""

    measuring: bool = False
    costs: StepCost | None = None
    problems: tuple[Problem, ...] = ()
