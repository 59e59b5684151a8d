"""The box stimulus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp
from jax import Array

from deodar.element import Setting
from deodar.elements._stimulus import Stimulus
from deodar.leaves import per_axis
from deodar.numerics import starting
from deodar.numerics.axes import Axes
from deodar.numerics.convolution import boundaries
from deodar.numerics.intervals import Interval, signed
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live, PerAxis
from deodar.registry import register


@register
@dataclass(frozen=True)
class BoxStimulus(Stimulus):
    r"""A constant input inside a box and 0 outside.

    A cell that is partly inside the box gets the amplitude times the part of its width that is inside.

    Equation:
        s(x) = \begin{cases} \mathrm{amplitude} & |x_i - \mathrm{center}_i| <
            \frac{\mathrm{width}_i}{2} \ \forall i \\ 0 & \text{else} \end{cases}

    Parameters:
        axes: axes of the stimulus; none: a constant for a node.
        center: middle of the box in axis units, one value or one for each axis.
        width: full width in axis units, one value or one for each axis; > 0.
        amplitude: value inside.
        windows: when it is on, pairs (start, stop) in the document's time unit; without windows always.

    Ports:
        output: over `axes`.

    Reference:
        no reference
    """

    center: Annotated[PerAxis, Live("axis", meaning="middle of the region")] = 0.0
    width: Annotated[PerAxis, Live("axis", lower=1e-6, meaning="full width")] = 10.0
    amplitude: Annotated[float, Live("activation", meaning="value inside")] = 1.0

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        if not axes:
            return {"amplitude": starting.STRENGTH}
        width = starting.one_or_each(tuple(2 * sigma for sigma in starting.widths(axes)))
        return {"center": starting.middle(axes), "width": width, "amplitude": starting.STRENGTH}

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        yield from super().warnings(ins)
        yield from self.placed("width", boundaries(None, tuple(self.axes)))

    def strength(self) -> Interval:
        return signed(self.amplitude)

    def polarity(self) -> Sign:
        return sign_of(self.amplitude)

    def pattern(self, at: Setting) -> Array:
        y = self.amplitude * jnp.ones((), at.dtype)
        centers, widths = per_axis(self.center, self.axes), per_axis(self.width, self.axes)
        for axis, center, width in zip(self.axes, centers, widths, strict=True):
            distance = at.points(axis) - center
            if axis.periodic:
                distance = distance - axis.range * jnp.round(distance / axis.range)
            upper = jnp.minimum(distance + axis.step / 2, width / 2)
            lower = jnp.maximum(distance - axis.step / 2, -width / 2)
            y = y[..., None] * jnp.maximum(0.0, upper - lower) / axis.step
        return y
