"""The contract of a world: a plant with named sensors, at its own rate. Models name sensors; worlds provide them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from deodar.errors import WorldError, did_you_mean
from deodar.numerics.axes import Axes


class World:
    """A world on the host: it is sensed between chunks of steps.

    Class attributes:
        sensors: name of each sensor and what it reads, in words.

    Attributes:
        period: document time between two readings; None: the world never changes, one reading serves a whole run.
    """

    sensors: ClassVar[Mapping[str, str]] = {}
    period: float | None = None

    def reset(self, seed: int) -> None:
        """Put the world back to its start."""

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        """What a sensor reads at a time, sampled over the axes: an array of their shape, finite."""
        raise NotImplementedError

    def describe(self) -> dict[str, Any]:
        """What a record keeps of the world, as plain data."""
        return {"world": type(self).__name__}

    @classmethod
    def open(cls, argument: str) -> World:
        """The world that the command line names: `--world picture:coffee.jpg` gives `coffee.jpg`."""
        raise WorldError(f"the world {cls.__name__} cannot be opened from the command line")

    def require(self, sensor: str) -> None:
        """Refuse a sensor that this world does not have."""
        if sensor not in self.sensors:
            raise WorldError(f"the world {type(self).__name__} has no sensor {sensor!r}", fix=did_you_mean(sensor, self.sensors))
