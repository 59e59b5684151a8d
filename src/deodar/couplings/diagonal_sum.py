"""The sum along the diagonals of a plane."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, Axis, shape
from deodar.parameters import Recompile
from deodar.registry import register


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

    axes: Annotated[Sequence[Axis], Recompile(meaning="axis of the sum")] = needed("[x]")

    linear: ClassVar[bool] = True

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
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

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        x = inputs["input"]
        n, m = x.shape
        # rows of n + m samples, reshaped to rows of n + m - 1: this shifts each row by one sample more
        skewed = jnp.pad(x, ((0, 0), (0, n))).reshape(-1)[: n * (n + m - 1)].reshape(n, n + m - 1)
        return {"output": at.ins["input"][1].step * jnp.sum(skewed, axis=0)}

    @classmethod
    def example(cls) -> DiagonalSum:
        return cls([Axis("sum", 0, 28, samples=29)], name="example")
