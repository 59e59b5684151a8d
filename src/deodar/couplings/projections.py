"""Couplings between signals over different axes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.codec import composed
from deodar.declarations import needed
from deodar.element import Arrays, Coupling, PortAxes, PortBounds, Setting
from deodar.errors import Fix
from deodar.numerics import resampling
from deodar.numerics.axes import Axes, Axis, shape
from deodar.numerics.convolution import along
from deodar.numerics.intervals import ZERO, hull, times
from deodar.parameters import Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Project(Coupling):
    r"""A projection from one set of dimensions to another; axes match by name, after renaming.

    `reduce` selects a sum, mean, max or min over z in place of the integral. If the sampling of an axis
    differs, the input is interpolated.

    Equation:
        \text{axes missing at the source:}\quad y(x, z) = \mathrm{input}(x)
        \text{axes missing here:}\quad y(x) = \int \mathrm{input}(x, z)\, dz

    Parameters:
        axes: dimensions of the output; in its order.
        reduce: contraction over axes that the output does not have; `integral`, `sum`, `mean`, `max` or
            `min`.
        rename: names of the source's axes and their names in the output; for example `{"pan": "x"}`.
        interpolation: `linear` or `nearest`, for axes whose sampling differs.

    Ports:
        input: any axes.
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 5-8.
    """

    axes: Sequence[Axis] = ()
    reduce: Annotated[str, Recompile(choices=resampling.REDUCTIONS)] = "integral"
    rename: Mapping[str, str] = ()  # type: ignore[assignment]
    interpolation: Annotated[str, Recompile(choices=resampling.INTERPOLATIONS)] = "linear"

    @property
    def linear(self) -> bool:  # type: ignore[override]
        """Whether the output is linear in the input: an integral, a sum or a mean."""
        return self.reduce in ("integral", "sum", "mean")

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        source, here = self._source(ins["input"]), {a.name: a for a in self.axes}
        for old in dict(self._renames()):
            if old not in [a.name for a in ins["input"]]:
                yield f"renames the axis {old!r}, which the source does not have"
        if len(set(source)) < len(source):
            yield f"two axes of the source would be called {sorted(source)} here"
        for name, axis in zip(source, ins["input"], strict=True):
            if name in here and not self._same(here[name], axis, name):
                yield (
                    f"axis {name!r} is {axis} at the source and {here[name]} here; bounds, unit or"
                    " periodicity differ"
                )

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        here, there = [a.name for a in self.axes], self._source(ins["input"])
        if here and there and not set(here) & set(there) and self.reduce in ("integral", "sum", "mean"):
            yield (
                (
                    f"shares no axis with its source: it keeps the {self.reduce} over {', '.join(there)}"
                    f" alone, and is uniform along {', '.join(here)}"
                ),
                Fix(
                    "Rename the axis that is meant (rename={...}), or use Weights; for one number for all"
                    " places write Project([])",
                    page="Rename the axis that is meant, or use Weights; for one number for all places use a"
                    " Project without axes",
                ),
            )

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        here = {a.name for a in self.axes}
        gone = [
            a for name, a in zip(self._source(ins["input"]), ins["input"], strict=True) if name not in here
        ]
        size = (
            math.prod(a.step * a.samples for a in gone)
            if self.reduce == "integral"
            else math.prod(a.samples for a in gone)
        )
        return {
            "output": (
                times((size, size), inputs["input"])
                if self.reduce in ("integral", "sum")
                else inputs["input"]
            )
        }

    def prepare(self, at: Setting) -> Arrays:
        here = {a.name: a for a in self.axes}
        out: Arrays = {}
        for name, axis in zip(self._source(at.ins["input"]), at.ins["input"], strict=True):
            if name in here and here[name].samples != axis.samples:
                out[name] = resampling.weights(axis, here[name].points, self.interpolation, at.dtype)
        return out

    def output(self, at: Setting) -> Arrays:
        y, keep = at.inputs["input"], self._source(at.ins["input"])
        names = [a.name for a in self.axes]
        for d in reversed(range(len(keep))):
            if keep[d] not in names:
                y = resampling.reduce(y, d, at.ins["input"][d], self.reduce)
                del keep[d]
        for d, name in enumerate(keep):
            if name in at.constants:
                y = along(at.constants[name], y, d)
        y = jnp.transpose(y, [keep.index(name) for name in names if name in keep])
        y = y.reshape([a.samples if a.name in keep else 1 for a in self.axes])
        return {"output": jnp.broadcast_to(y, shape(self.axes))}

    def _renames(self) -> tuple[tuple[str, str], ...]:
        return tuple((composed(a), composed(b)) for a, b in dict(self.rename).items())

    def _source(self, axes: Axes) -> list[str]:
        names = dict(self._renames())
        return [names.get(a.name, a.name) for a in axes]

    def _same(self, here: Axis, there: Axis, name: str) -> bool:
        # a renamed axis keeps its bounds but may have another unit, such as image column and pan angle
        renamed = name in dict(self._renames()).values()
        return here.fits(
            Axis(here.name, there.lower, there.upper, there.samples, there.periodic, here.unit)
            if renamed
            else there
        )

    @classmethod
    def example(cls) -> Project:
        return cls([Axis("x", 0, 20, samples=21)], name="example")


@register
@dataclass(frozen=True)
class Resample(Coupling):
    r"""The input on another grid of the same dimensions, which may cover another range.

    Values between samples are interpolated; values beyond the ends of an axis that is not periodic are 0.

    Equation:
        y(x) = \mathrm{input}(x)

    Parameters:
        axes: axes of the same names in the same order, with the new grid.
        interpolation: `linear` or `nearest`.

    Ports:
        input: axes of the same names in the same order.
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 3.3.
    """

    axes: Sequence[Axis] = ()
    interpolation: Annotated[str, Recompile(choices=resampling.INTERPOLATIONS)] = "linear"

    linear: ClassVar[bool] = True

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        there, here = [a.name for a in ins["input"]], [a.name for a in self.axes]
        if there != here:
            yield f"the source has the axes {there}, here are {here}; write Project to change dimensions"
            return
        for a, b in zip(ins["input"], self.axes, strict=True):
            if a.periodic and not (b.periodic and a.fits(b)):
                yield f"the periodic axis {a.name!r} has other bounds here: {a} at the source, {b} here"

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        for a, b in zip(ins["input"], self.axes, strict=True):
            if a.unit != b.unit:
                yield (
                    (
                        f"the axis {a.name!r} is in {a.unit!r} at the source and in {b.unit!r} here, and"
                        " values are not converted"
                    ),
                    "Give both axes one unit",
                )
            if not a.periodic and (b.lower > a.upper or b.upper < a.lower):
                what = (
                    f"its axis {b.name!r} ({b.lower:g}..{b.upper:g}) and the source's"
                    f" ({a.lower:g}..{a.upper:g}) do not overlap, so its output is 0"
                )
                yield what, "Give both axes bounds that overlap"

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": hull(ZERO, inputs["input"])}

    def prepare(self, at: Setting) -> list[Array]:
        pairs = zip(at.ins["input"], self.axes, strict=True)
        return [resampling.weights(a, b.points, self.interpolation, at.dtype) for a, b in pairs]

    def output(self, at: Setting) -> Arrays:
        y = at.inputs["input"]
        for d, weights in enumerate(at.constants):
            y = along(weights, y, d)
        return {"output": y}

    @classmethod
    def example(cls) -> Resample:
        return cls([Axis("x", 0, 20, samples=31)], name="example")


@register
@dataclass(frozen=True)
class DiagonalSum(Coupling):
    r"""The read-out of a transformation field along its diagonals: a peak at (x, y) arrives at x + y.

    Sample indices start at the lower ends of the axes; the grid step of the second axis multiplies the sum.

    Equation:
        z_k = \Delta y \sum_{i + j = k} \mathrm{input}(x_i, y_j)

    Parameters:
        axes: the axis of the sum; as many samples as both axes of the input have together, less one.

    Ports:
        input: two axes of equal step.
        output: over `axes`.

    Reference:
        Schneegans & Schöner (2012), A neural mechanism for coordinate transformation predicts pre-saccadic
        remapping, Biol. Cybern. 106, 89-109 (the projection along the diagonals of the transformation field).
    """

    axes: Sequence[Axis] = needed("[x]")

    linear: ClassVar[bool] = True

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        given = shape(ins["input"])
        if len(given) != 2:
            yield f"needs an input of two axes, not of {len(given)}", "Put a Project before it"
        elif shape(self.axes) != (sum(given) - 1,):
            yield (
                (
                    f"its axes have {list(shape(self.axes))} samples; the diagonals of {list(given)} samples"
                    f" are {sum(given) - 1}"
                ),
                "Give one axis of these",
            )

    def output(self, at: Setting) -> Arrays:
        x = at.inputs["input"]
        n, m = x.shape
        # rows of n + m samples, reshaped to rows of n + m - 1: this shifts each row by one sample more
        skewed = jnp.pad(x, ((0, 0), (0, n))).reshape(-1)[: n * (n + m - 1)].reshape(n, n + m - 1)
        return {"output": at.ins["input"][1].step * jnp.sum(skewed, axis=0)}

    @classmethod
    def example(cls) -> DiagonalSum:
        return cls([Axis("sum", 0, 28, samples=29)], name="example")


@register
@dataclass(frozen=True)
class DiagonalExpansion(Coupling):
    r"""The diagonal input of a transformation field: z is copied to all pairs (x, y) with x + y = z.

    Sample indices start at the lower ends of the axes.

    Equation:
        y(x_i, y_j) = \mathrm{input}(z_{i + j})

    Parameters:
        axes: the two axes of the output; together they have one sample more than the input.

    Ports:
        input: one axis.
        output: over `axes`.

    Reference:
        Schneegans & Schöner (2012), A neural mechanism for coordinate transformation predicts pre-saccadic
        remapping, Biol. Cybern. 106, 89-109 (the diagonal input of the transformation field).
    """

    axes: Sequence[Axis] = needed("[x, y]")

    linear: ClassVar[bool] = True

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        given, own = shape(ins["input"]), shape(self.axes)
        if len(own) != 2:
            yield f"has {len(own)} axes; a diagonal lies between two", "Give two axes"
        elif given != (sum(own) - 1,):
            yield (
                (
                    f"its input has {list(given)} samples; the diagonals of {list(own)} samples are"
                    f" {sum(own) - 1}"
                ),
                "Give it an input of these",
            )

    def output(self, at: Setting) -> Arrays:
        n, m = shape(self.axes)
        return {"output": at.inputs["input"][np.add.outer(np.arange(n), np.arange(m))]}

    @classmethod
    def example(cls) -> DiagonalExpansion:
        return cls([Axis("x", 0, 10, samples=11), Axis("y", 0, 10, samples=11)], name="example")
