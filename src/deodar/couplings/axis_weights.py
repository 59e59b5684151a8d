"""Weights along one axis."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, Axis, wrong_shape
from deodar.numerics.convolution import along
from deodar.numerics.intervals import Interval, times, total
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import ArrayLike, FrozenArray, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class AxisWeights(Coupling):
    r"""Fixed weights between the samples of one axis of the input and a new axis, the same everywhere else.

    It resamples, crops, pads, mirrors or permutes an array along one axis; one after another, several of them
    do so along several axes. `Weights` has weights between all samples.

    Equation:
        y(x, z) = \sum_{x'} W(x, x')\, \mathrm{input}(x', z)

    Parameters:
        weights: W, samples of the new axis first.
        axis: the new axis, x.
        along: name of the axis of the input that it takes the place of; empty: the axis of the same name.

    Ports:
        input: any axes, one of them `along`.
        output: the axes of the input, with `axis` in the place of the one that is summed.

    Shapes:
        weights: samples of `axis`, then samples of the axis `along` of the input.

    Reference:
        no reference
    """

    weights: Annotated[ArrayLike, Rebuild(meaning="W, samples of the new axis first")] = FrozenArray(
        np.eye(21)
    )
    axis: Annotated[Axis, Recompile(meaning="the new axis")] = needed("x")
    along: Annotated[str, Recompile(meaning="name of the axis of the input; empty: the same name")] = ""

    linear: ClassVar[bool] = True

    def polarity(self) -> Sign:
        return sign_of(self.weights)

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axis if a.name == self._name else a for a in ins["input"])}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        found = next((a for a in ins["input"] if a.name == self._name), None)
        if found is None:
            given = ", ".join(repr(a.name) for a in ins["input"]) or "none"
            yield (
                f"acts along the axis {self._name!r}, which the input does not have; it has {given}",
                "Write along='NAME'",
            )
            return
        if self.axis.name != self._name and any(a.name == self.axis.name for a in ins["input"]):
            yield f"gives an axis {self.axis.name!r}, which the input has already"
        yield from wrong_shape(
            "weights", self.weights, (self.axis.samples, found.samples), "the new axis and the old one have"
        )

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        if not isinstance(self.weights, FrozenArray):
            return {}
        w, x = self.weights.data, inputs["input"]
        up, down = float(np.maximum(w, 0).sum(axis=1).max()), float(np.minimum(w, 0).sum(axis=1).min())
        return {"output": total(times((0.0, up), x), times((down, 0.0), x))}

    def prepare(self, at: Setting) -> Arrays:
        return {"weights": at.array(self.weights)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        d = next(k for k, a in enumerate(at.ins["input"]) if a.name == self._name)
        return {"output": along(constants["weights"], inputs["input"], d)}

    @property
    def _name(self) -> str:
        return self.along or self.axis.name

    @classmethod
    def example(cls) -> AxisWeights:
        return cls(np.eye(21), Axis("x", 0, 20, samples=21), name="example")
