"""The projection between dimensions: expansion, contraction, reordering, renaming."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics import resampling
from deodar.numerics.axes import Axes, Axis, shape
from deodar.numerics.convolution import along
from deodar.numerics.intervals import Interval, times
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
        axes: dimensions of the output, in its order.
        reduce: contraction over axes that the output does not have: `integral`, `sum`, `mean`, `max` or
            `min`.
        rename: names of the source's axes and their names in the output: `{"pan": "x"}`.
        interpolation: `linear` or `nearest`, for axes whose sampling differs.

    Ports:
        input: any axes.
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 5-8.
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="dimensions of the output")] = ()
    reduce: Annotated[str, Recompile(choices=resampling.REDUCTIONS, meaning="how missing axes contract")] = (
        "integral"
    )
    rename: Annotated[Mapping[str, str], Recompile(meaning="source name to name here")] = ()  # type: ignore[assignment]
    interpolation: Annotated[
        str, Recompile(choices=resampling.INTERPOLATIONS, meaning="where the sampling differs")
    ] = "linear"

    @property
    def linear(self) -> bool:  # type: ignore[override]
        """Whether the output is linear in the input: an integral, a sum or a mean."""
        return self.reduce in ("integral", "sum", "mean")

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
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

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        here, there = [a.name for a in self.axes], self._source(ins["input"])
        if here and there and not set(here) & set(there) and self.reduce in ("integral", "sum", "mean"):
            yield (
                (
                    f"shares no axis with its source: it keeps the {self.reduce} over {', '.join(there)}"
                    f" alone, and is uniform along {', '.join(here)}"
                ),
                (
                    "Rename the axis that is meant (rename={...}), or use Weights; for one number for all"
                    " places write Project([])"
                ),
            )

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
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

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        y, keep = inputs["input"], self._source(at.ins["input"])
        names = [a.name for a in self.axes]
        for d in reversed(range(len(keep))):
            if keep[d] not in names:
                y = resampling.reduce(y, d, at.ins["input"][d], self.reduce)
                del keep[d]
        for d, name in enumerate(keep):
            if name in constants:
                y = along(constants[name], y, d)
        y = jnp.transpose(y, [keep.index(name) for name in names if name in keep])
        y = y.reshape([a.samples if a.name in keep else 1 for a in self.axes])
        return {"output": jnp.broadcast_to(y, shape(self.axes))}

    def _renames(self) -> tuple[tuple[str, str], ...]:
        return tuple(dict(self.rename).items())

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
