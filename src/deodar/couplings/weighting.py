"""The weighting function."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
import numpy.typing as npt
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import ArrayLike, FrozenArray, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Weighting(Coupling):
    r"""A coupling strength that depends on position, such as a ramp or a mask.

    Equation:
        y(x) = c(x) \cdot \mathrm{input}(x)

    Parameters:
        weights: c, one value for each sample of the axes (`Weighting.of(function, axes)` samples a function).
        axes: axes of the weights; the input expands to them.

    Ports:
        input: over `axes`; missing axes expand.
        output: over `axes`.

    Shapes:
        weights: the samples of `axes`, in their order.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 9.
    """

    weights: Annotated[ArrayLike, Rebuild(meaning="c at every sample")] = FrozenArray(np.ones(21))
    axes: Annotated[tuple[Axis, ...], Recompile(meaning="axes of the weights")] = needed("[x]")

    linear: ClassVar[bool] = True

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return {"weights": FrozenArray(np.ones(shape(axes)))}

    def polarity(self) -> Sign:
        return sign_of(self.weights)

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return tuple(self.axes)

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        yield from wrong_shape("weights", self.weights, shape(self.axes))

    def prepare(self, at: Setting) -> Arrays:
        return {"weights": at.array(self.weights)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": constants["weights"] * inputs["input"]}

    @classmethod
    def of(cls, function: Callable[..., npt.ArrayLike], axes: Sequence[Axis]) -> Weighting:
        """Sample the weights from a function of the axes' values: `Weighting.of(lambda x: x / 100, [x])`."""
        grids = np.meshgrid(*(a.points for a in axes), indexing="ij")
        return cls(np.broadcast_to(np.asarray(function(*grids), float), shape(axes)), tuple(axes))

    @classmethod
    def example(cls) -> Weighting:
        return cls(np.ones(21), (Axis("x", 0, 20, samples=21),), name="example")
