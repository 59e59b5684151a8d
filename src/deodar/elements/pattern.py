"""The stimulus defined by an array."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Setting
from deodar.elements._stimulus import Stimulus, array_strength
from deodar.numerics import starting
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.numerics.intervals import Interval
from deodar.numerics.signs import Sign, product, sign_of
from deodar.parameters import ArrayLike, FrozenArray, Live, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Pattern(Stimulus):
    r"""An input defined by an array, one value for each sample.

    Equation:
        s(x) = \mathrm{amplitude} \cdot \mathrm{values}(x)

    Parameters:
        axes: axes of the stimulus; none: a constant for a node.
        values: one value for each sample of the axes.
        amplitude: factor.
        windows: when it is on, pairs (start, stop) in the document's time unit; without windows always.

    Ports:
        output: over `axes`.

    Shapes:
        values: the samples of `axes`, in their order.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the pattern")] = needed("[x]")
    values: Annotated[ArrayLike, Rebuild("activation", meaning="one value for each sample")] = FrozenArray(
        [float(k % 7 == 3) for k in range(21)]
    )
    amplitude: Annotated[float, Live(meaning="factor")] = 1.0

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return {"values": FrozenArray(starting.hill(axes)), "amplitude": starting.STRENGTH}

    def polarity(self) -> Sign:
        return product(sign_of(self.values), sign_of(self.amplitude))

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        yield from super().validate_axes(ins)
        yield from wrong_shape("values", self.values, shape(self.axes))

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        yield from super().warnings(ins)
        if isinstance(self.values, FrozenArray) and not self.values.data.any():
            yield (
                "its values are all zero, so it gives nothing",
                "Give it the values that it should show, or remove it",
            )

    def strength(self) -> Interval:
        return array_strength(self.values, self.amplitude)

    def pattern(self, at: Setting) -> Array:
        return self.amplitude * jnp.broadcast_to(at.array(self.values), shape(self.axes))
