"""Axes as data: the metric dimensions over which fields are defined, and their sampling."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Self

import numpy as np

from deodar.codec import composed
from deodar.declarations import Recompile
from deodar.errors import AxesError, Problem
from deodar.numerics import units
from deodar.parameters import FrozenArray, positional, require_known, set_normal, show
from deodar.summary import Summarised, Summary

MOST_SAMPLES = 1_000_000
"""Most samples on one axis; more are probably a typo (a guess; a field this long would run at 0.01 of real
time).
"""

FARTHEST = 1e30
"""Largest absolute bound; larger values overflow in single precision when they are squared or multiplied."""

FINEST = 1e-6
"""Smallest range relative to the bounds; smaller ranges are within the rounding of single precision."""

APART = 0.1
"""Overlap of two ranges, as a share of the longer one, below which one of them probably has another unit or
origin (a guess).
"""


@dc.dataclass(frozen=True, repr=False)
class Axis(Summarised):
    """A metric dimension with its sampling.

    Samples are at `lower + i * step`. On a periodic axis `step = (upper - lower) / samples` (upper is the
    same position as lower), on others `step = (upper - lower) / (samples - 1)` (upper is a sample).

    Args:
        name: name of the dimension, by which connections match axes.
        lower: first value, in `unit`.
        upper: last value, in `unit`; greater than lower.
        samples: number of samples; at least 2, or 1 on a periodic axis.
        periodic: whether upper and lower are the same position.
        unit: unit of the values, for labels and for matching.
    """

    name: str
    lower: float
    upper: float
    samples: Annotated[int, Recompile(lower=1, upper=MOST_SAMPLES)]
    periodic: bool = False
    unit: str = ""

    def __new__(cls, *args: Any, **values: Any) -> Self:
        require_known(cls, args, values)
        missing = [name for name in positional(cls)[len(args) : 4] if name not in values]
        if missing:
            raise AxesError(
                f"needs {', '.join(missing)}",
                where=f"axis {show(args[0] if args else values.get('name', ''))}",
                fix="For example Axis('x', 0, 100, samples=101)",
            )
        return super().__new__(cls)

    def __reduce__(self) -> tuple[type[Self], tuple[Any, ...]]:
        """Copy and pickle by the values, which are checked again on reading."""
        return type(self), dc.astuple(self)

    def __post_init__(self) -> None:
        where = f"axis {show(self.name)}"
        faults = {p.where: p.what for p in set_normal(self)}
        problems = [Problem(where, f"{name} {fault}") for name, fault in faults.items()]
        if self.name == "":
            problems.append(Problem("axis", "needs a name"))
        elif "name" not in faults:  # axes are matched by name
            object.__setattr__(self, "name", composed(self.name))
        if not {"samples", "periodic"} & faults.keys() and self.samples < 2 and not self.periodic:
            problems.append(Problem(where, f"samples is 1; expected 2 to {MOST_SAMPLES}"))
        if not {"lower", "upper"} & faults.keys():
            problems += self._bounds(where)
        if problems:
            raise AxesError(problems)

    def _bounds(self, where: str) -> Iterator[Problem]:
        farthest = max(abs(self.lower), abs(self.upper))
        if not self.lower < self.upper:
            yield Problem(where, f"lower {self.lower:g} is not below upper {self.upper:g}")
        elif farthest > FARTHEST or self.range < max(farthest, 1 / FARTHEST) * FINEST:
            problem = (
                f"{self.lower:g}..{self.upper:g} cannot be sampled: single precision does not distinguish"
                " its samples"
            )
            yield Problem(where, problem, "Choose another unit, or an origin nearer to the values")

    @property
    def range(self) -> float:
        """The range, upper minus lower; the period of a periodic axis."""
        return self.upper - self.lower

    @property
    def step(self) -> float:
        """The distance between neighbouring samples, equal to the size of a sample's cell."""
        return self.range / (self.samples if self.periodic else self.samples - 1)

    @property
    def points(self) -> np.ndarray:
        """The values at the samples, float64."""
        return self.lower + self.step * np.arange(self.samples)

    def fits(self, other: Axis) -> bool:
        """Return whether a connection may match both axes: equal bounds (to 1e-9 of the range), unit and
        periodicity.
        """
        tolerance = 1e-9 * max(self.range, other.range)
        return (
            abs(self.lower - other.lower) <= tolerance
            and abs(self.upper - other.upper) <= tolerance
            and self.periodic == other.periodic
            and self.unit == other.unit
        )

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return (
            f"{self.name} {self.lower:g}..{self.upper:g}{unit}, {self.samples}"
            f" samples{', periodic' if self.periodic else ''}"
        )

    def _summary(self) -> Summary:
        return Summary(f"Axis {self}")


Axes = tuple[Axis, ...]


def shape(axes: Sequence[Axis]) -> tuple[int, ...]:
    """Return the array shape of a field over the axes; () for a node."""
    return tuple(a.samples for a in axes)


def cell(axes: Sequence[Axis]) -> float:
    """Return the volume of a sample's cell: the product of the grid steps; 1 for a node."""
    return math.prod(a.step for a in axes)


def describe(axes: Sequence[Axis]) -> str:
    """Return the axes in one line, for messages: `[x 0..100, 101 samples]`."""
    return "[" + "; ".join(str(a) for a in axes) + "]"


def one_axis(axes: Axes) -> Iterator[tuple[str, str]]:
    """Yield the problem, and what to type, if a source does not have exactly one axis."""
    if not axes:
        yield "the source has no axis, so it has no positions", "Connect a field over an axis"
    elif len(axes) > 1:
        names = " or ".join(axis.name for axis in axes)
        yield (
            f"the source has {len(axes)} axes, so the axis of the input must be stated",
            f"Set its axis: {names}",
        )


def wrong_shape(
    name: str, value: Any, needed: tuple[int, ...], owner: str = "its axes have"
) -> Iterator[tuple[str, str]]:
    """Yield the problem, and what to type, if an array does not have the needed shape.

    Args:
        name: name of the parameter.
        value: its value; without an array there is no problem.
        needed: the number of samples along each dimension.
        owner: whose samples these are, with the verb.
    """
    if isinstance(value, FrozenArray) and value.shape != needed:
        yield (
            f"{name} has shape {list(value.shape)}, {owner} {list(needed)} samples",
            f"Give {name} the shape {list(needed)}",
        )


def barely_overlap(
    axis: Axis, bounds: tuple[float, float], what: str, unit: str = ""
) -> Iterator[tuple[str, str]]:
    """Yield the problem, and what to type, if an axis and a range have little in common.

    Args:
        axis: the axis.
        bounds: lower and upper bound of the range, in the unit of the axis.
        what: what has the range, in the plural.
        unit: unit in which the range is given because the axis states none; "" if it states one.
    """
    if _overlap(axis, bounds) >= APART:
        return
    stated, unit_of_range = f" {axis.unit}" if axis.unit else "", units.parse(unit)
    fitting = [
        u.symbol
        for u in units.UNITS
        if unit_of_range is not None
        and u.quantity == unit_of_range.quantity
        and _overlap(axis, (bounds[0] * unit_of_range.size / u.size, bounds[1] * unit_of_range.size / u.size))
        >= APART
    ]
    yield (
        f"{what} run from {bounds[0]:.4g} to {bounds[1]:.4g} {unit or axis.unit}".rstrip()
        + f", and the axis {axis.name!r} from {axis.lower:g} to {axis.upper:g}{stated}: they barely overlap",
        f"Write unit={fitting[0]!r} for the axis if its values are in {fitting[0]}"
        if fitting
        else "Choose a world that covers the axis, or change the bounds of the axis",
    )


def _overlap(axis: Axis, bounds: tuple[float, float]) -> float:
    """Return the length that an axis and a range have in common, as a share of the longer one."""
    common = min(axis.upper, bounds[1]) - max(axis.lower, bounds[0])
    return max(common, 0.0) / max(axis.range, bounds[1] - bounds[0])
