"""Numbers that are positions or angles: their units, and the axes on which an element uses them."""

from __future__ import annotations

import dataclasses as dc
import math

from deodar.numerics import units
from deodar.numerics.axes import Axes, Axis


@dc.dataclass(frozen=True)
class PositionUnit:
    """A number that a model receives or sends as a position or an angle.

    Attributes:
        quantity: `length` or `angle`.
        size: metres or radians for an increase by 1.
        bounds: its smallest and largest value; None: unknown.
        source: id of the element that reads it; "": the element at whose output it is.
    """

    quantity: str
    size: float
    bounds: tuple[float, float] | None = None
    source: str = ""

    @classmethod
    def of(cls, axis: Axis) -> PositionUnit | None:
        """Return the unit of positions on an axis; None if the axis states no unit of length or angle."""
        unit = units.parse(axis.unit)
        return None if unit is None else cls(unit.quantity, unit.size)

    def scaled(self, factor: float) -> PositionUnit | None:
        """Return the position that is `factor` times this number; None for a factor of 0."""
        if not factor or not math.isfinite(factor):
            return None
        low, high = (None, None) if self.bounds is None else (factor * b for b in self.bounds)
        bounds = None if low is None or high is None else (min(low, high), max(low, high))
        return dc.replace(self, size=self.size / abs(factor), bounds=bounds)

    def unbounded(self) -> PositionUnit:
        """Return the unit without the bounds."""
        return dc.replace(self, bounds=None)

    def fits(self, other: PositionUnit) -> bool:
        """Return whether the sum of both numbers has their unit."""
        return self.quantity == other.quantity and math.isclose(self.size, other.size, rel_tol=1e-9)


PositionUnits = tuple[PositionUnit | None, ...]
"""The units at a port, one for each sample: None for a number that is no position; () if none is known."""


@dc.dataclass(frozen=True)
class PositionCode:
    """The use of the numbers at an input port as positions on axes, or as distances along them.

    Attributes:
        axes: the axes, one for each number.
        gains: axis units per unit of each number.
        offsets: position for a number of 0, in axis units; None: the numbers are distances.
        parameter: name of the parameter that holds the gains.
    """

    axes: Axes
    gains: tuple[float, ...]
    offsets: tuple[float, ...] | None = None
    parameter: str = "gain"
