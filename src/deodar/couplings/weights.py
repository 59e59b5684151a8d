"""Dense weights between all samples of two elements."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics import starting
from deodar.numerics.axes import Axes, Axis, cell, shape, wrong_shape
from deodar.numerics.intervals import Interval, times, total
from deodar.numerics.positions import PositionUnit, PositionUnits
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import ArrayLike, FrozenArray, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Weights(Coupling):
    r"""Fixed weights between all samples of a source and all samples of a target: any linear map.

    The integral is the sum times the source's grid step.

    Equation:
        y(x) = \int W(x, x')\, \mathrm{input}(x')\, dx'

    Parameters:
        weights: W, target samples first, then source samples; per unit of the source's axes.
        axes: axes of the output; none: one number.

    Ports:
        input: any axes.
        output: over `axes`.

    Shapes:
        weights: samples of `axes`, then samples of the input's axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 7.
    """

    weights: Annotated[ArrayLike, Rebuild(meaning="W, target samples first")] = FrozenArray(np.eye(21))
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the output")] = needed("[x]")

    linear: ClassVar[bool] = True
    maps: ClassVar[Mapping[str, tuple[str, ...]]] = {"weights": ("output", "input")}

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        weights = starting.map_of_places(axes, axes if arriving is None else arriving)
        return {} if weights is None else {"weights": FrozenArray(weights)}

    def polarity(self) -> Sign:
        return sign_of(self.weights)

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        needed = shape(self.axes) + shape(ins["input"])
        yield from wrong_shape("weights", self.weights, needed, "target and source have")

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        if isinstance(self.weights, FrozenArray) and not self.weights.data.any():
            yield (
                "its weights are all zero, so nothing passes",
                "Give it the weights of the map, or remove it",
            )

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        if not isinstance(self.weights, FrozenArray):
            return {}
        rows = self.weights.data.reshape(math.prod(shape(self.axes)), -1) * cell(ins["input"])
        up, down = float(np.maximum(rows, 0).sum(axis=1).max()), float(np.minimum(rows, 0).sum(axis=1).min())
        return {"output": total(times((0.0, up), inputs["input"]), times((down, 0.0), inputs["input"]))}

    def position_units(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, PositionUnits]
    ) -> Mapping[str, PositionUnits]:
        arriving = inputs["input"]
        if not arriving or not isinstance(self.weights, FrozenArray):
            return {}
        rows = self.weights.data.reshape(-1, len(arriving)) * cell(ins["input"])
        return {"output": tuple(_weighted(row.tolist(), arriving) for row in rows)}

    def prepare(self, at: Setting) -> Arrays:
        return {"weights": at.array(self.weights) * cell(at.ins["input"])}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        x = inputs["input"]
        return {"output": jnp.tensordot(constants["weights"], x, axes=x.ndim, precision="highest")}

    @classmethod
    def example(cls) -> Weights:
        return cls(np.eye(21), [Axis("x", 0, 20, samples=21)], name="example")


def _weighted(row: Sequence[float], arriving: PositionUnits) -> PositionUnit | None:
    """Return the unit of a weighted sum of positions; None if its terms have no common one."""
    used = [p and p.scaled(weight) for weight, p in zip(row, arriving, strict=True) if weight != 0]
    first = used[0] if used else None
    if first is None or any(p is None or not p.fits(first) for p in used):
        return None
    return first if len(used) == 1 else first.unbounded()
