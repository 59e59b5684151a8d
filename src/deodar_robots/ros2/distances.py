"""Distances: the message types LaserScan and Range."""

from __future__ import annotations

from typing import Any

import numpy as np

from deodar.worlds._base import Signal
from deodar_robots.ros2.message_types import Unreadable
from deodar_robots.ros2.reading import Reading, finite


class ScanReading(Reading):
    """The ranges (m) or intensities of a sensor_msgs/LaserScan, from `angle_min` on, counter-clockwise.

    A beam without an echo (infinite) has the distance `range_max`, one with an echo that is too near (minus
    infinity) `range_min`. Any other distance outside of both is not defined.
    """

    settings = ("shape", "fields", "undefined")

    def declared(self) -> Signal:
        shape = self.shape_of(1, "[360]")
        self.field = self.choice(("ranges", "intensities"))
        unit = "m" if self.field == "ranges" else ""
        return Signal(f"{self.field} of {self.entry.topic} by angle", shape, unit, self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        values = getattr(message, self.field)
        if values.shape != self.signal.shape:
            raise Unreadable(
                f"it has {len(values)} {self.field}, not {self.entry.shape[0]}",  # type: ignore[index]
                f'State their number: "shape": [{len(values)}]',
            )
        if self.field == "intensities":
            return finite(values, self.field)
        return defined(values, message.range_min, message.range_max, self.entry.undefined)


class RangeReading(Reading):
    """The distance (m) of a sensor_msgs/Range; infinite distances as in a LaserScan."""

    settings = ("undefined",)

    def declared(self) -> Signal:
        return Signal(f"distance of {self.entry.topic}", (), "m", self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        given = np.asarray(message.range, np.float32)
        return defined(given, message.min_range, message.max_range, self.entry.undefined)


def defined(values: np.ndarray, nearest: float, farthest: float, undefined: float | None) -> np.ndarray:
    """Return distances without infinite ones.

    Args:
        values: distances, m.
        nearest: smallest distance that the sensor measures, m.
        farthest: largest one, m.
        undefined: number in place of what is not defined; None: there has to be none.

    Raises:
        Unreadable: a distance is not defined, or the limits are not in order.
    """
    low, high = np.float32(nearest), np.float32(farthest)
    if not 0 <= low <= high < np.inf:
        raise Unreadable(f"its distances are between {low:g} and {high:g} m")
    found = np.array(values, np.float32)
    found[values == np.inf], found[values == -np.inf] = high, low
    strange = ~((found >= low) & (found <= high))
    if strange.any():
        if undefined is None:
            what = f"{int(strange.sum())} of its distances are undefined, or outside of {low:g} to {high:g} m"
            raise Unreadable(what, f'State a distance in their place: "undefined": {high:g}')
        found[strange] = undefined
    return found
