"""The Gaussian stimulus."""

from __future__ import annotations

import dataclasses as dc
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
from deodar.numerics.intervals import ANY, Interval, signed
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live, PeakBoundary, PerAxis, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class GaussianStimulus(Stimulus):
    r"""A Gaussian input, localised around one position.

    On an axis that wraps, the distance is the shorter one. If normalized, the Gaussian is divided by its sum
    over all samples times the grid steps.

    Equation:
        s(x) = \mathrm{amplitude} \exp\!\left( -\sum_i \frac{(x_i - \mathrm{center}_i)^2}{2
            \sigma_i^2} \right)

    Parameters:
        axes: axes of the stimulus; none: a constant for a node.
        center: position of the maximum in axis units, one value or one for each axis.
        sigma: width in axis units, one value or one for each axis; > 0.
        amplitude: value at the centre; if normalized, the integral.
        windows: when it is on, pairs (start, stop) in the document's time unit; without windows always.
        normalized: whether the amplitude is the integral.
        boundary: `periodic` (the Gaussian wraps around the ends) or `zero` (it does not), one value or one
            for each axis; none: periodic on periodic axes.

    Ports:
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    center: Annotated[PerAxis, Live("axis", meaning="place of the maximum")] = 0.0
    sigma: Annotated[PerAxis, Live("axis", lower=1e-6, meaning="width")] = 5.0
    amplitude: Annotated[
        float, Live("activation", meaning="value at the centre, or the integral if normalized")
    ] = 1.0
    normalized: Annotated[bool, Recompile(meaning="whether the amplitude is the integral")] = dc.field(
        default=False, kw_only=True
    )
    boundary: PeakBoundary = dc.field(default=None, kw_only=True)

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return (
            {
                "center": starting.middle(axes),
                "sigma": starting.one_or_each(starting.widths(axes)),
                "amplitude": starting.STRENGTH,
            }
            if axes
            else {"amplitude": starting.STRENGTH}
        )

    def polarity(self) -> Sign:
        return sign_of(self.amplitude)

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        yield from super().validate_axes(ins)
        if self.boundary is not None and len(self.boundary) not in (1, len(self.axes)):
            yield f"boundary has {len(self.boundary)} entries for {len(self.axes)} axes"

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        yield from super().warnings(ins)
        yield from self.placed("sigma", boundaries(self.boundary, tuple(self.axes)))

    def strength(self) -> Interval:
        return ANY if self.normalized else signed(self.amplitude)

    def pattern(self, at: Setting) -> Array:
        y = self.amplitude * jnp.ones((), at.dtype)
        centers, sigmas = per_axis(self.center, self.axes), per_axis(self.sigma, self.axes)
        ends = boundaries(self.boundary, tuple(self.axes))
        for axis, center, sigma, end in zip(self.axes, centers, sigmas, ends, strict=True):
            distance = at.points(axis) - center
            if end == "periodic":
                length = axis.step * axis.samples
                distance = distance - length * jnp.round(distance / length)
            factor = jnp.exp(-0.5 * (distance / sigma) ** 2)
            # a Gaussian between two samples and far narrower than their distance stays zero
            if self.normalized:
                whole = jnp.sum(factor) * axis.step
                factor = factor / jnp.where(whole > 0, whole, 1.0)
            y = y[..., None] * factor
        return y
