"""The expansion along the diagonals of a plane."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, Axis, shape
from deodar.parameters import Recompile
from deodar.registry import register


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

    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the output")] = needed("[x, y]")

    linear: ClassVar[bool] = True

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
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

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        n, m = shape(self.axes)
        return {"output": inputs["input"][np.add.outer(np.arange(n), np.arange(m))]}

    @classmethod
    def example(cls) -> DiagonalExpansion:
        return cls([Axis("x", 0, 10, samples=11), Axis("y", 0, 10, samples=11)], name="example")
