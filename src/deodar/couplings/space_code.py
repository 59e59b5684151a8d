"""The conversion of numbers to a peak at a position."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import per_axis
from deodar.numerics.axes import Axes, Axis, shape
from deodar.numerics.convolution import boundaries
from deodar.numerics.positions import PositionCode
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live, PeakBoundary, PerAxis, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class SpaceCode(Coupling):
    r"""A space code: a Gaussian peak whose position is the input, such as the reading of a compass.

    On a periodic axis the distance is the shorter one, for input of any size. If normalized, y is
    divided by its sum over all samples times the grid steps.

    Equation:
        y(x) = \mathrm{amplitude} \exp\!\left( -\sum_i \frac{(x_i - c_i)^2}{2 \sigma_i^2} \right)
        c_i = \mathrm{gain}_i\, \mathrm{input}_i + \mathrm{offset}_i

    Parameters:
        axes: axes of the peak; at least one.
        sigma: width in axis units, one value or one for each axis; > 0.
        amplitude: value at the centre; if normalized, the integral.
        gain: axis units per unit of the input, one value or one for each axis.
        offset: position of the peak for an input of 0, in axis units, one value or one for each axis.
        normalized: whether the amplitude is the integral.
        boundary: `periodic` (the peak wraps around the ends) or `zero` (it does not), one value or one for
            each axis; none: periodic on periodic axes.

    Ports:
        input: one number for one axis; for several axes, an axis with one sample for each of them, in their
            order.
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5.1 (sensors as space
        code); Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), figure 4 (place and head direction).
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the peak")] = needed("[x]")
    sigma: Annotated[PerAxis, Live("axis", lower=1e-6, meaning="width")] = 5.0
    amplitude: Annotated[float, Live("activation", meaning="value at the centre")] = 1.0
    gain: Annotated[PerAxis, Live(meaning="axis units per unit of the input")] = 1.0
    offset: Annotated[PerAxis, Live("axis", meaning="place of the peak for an input of 0")] = 0.0
    normalized: Annotated[bool, Recompile(meaning="whether the amplitude is the integral")] = dc.field(
        default=False, kw_only=True
    )
    boundary: PeakBoundary = dc.field(default=None, kw_only=True)

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",)}

    def polarity(self) -> Sign:
        return sign_of(self.amplitude)

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.axes:
            yield "axes", "is empty; a peak needs at least one axis"

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        if self.boundary is not None and len(self.boundary) not in (1, len(self.axes)):
            yield (
                f"boundary has {len(self.boundary)} entries for {len(self.axes)} axes",
                "Give one for all axes, or one for each",
            )
        arriving, wanted = shape(ins["input"]), len(self.axes)
        if arriving != (wanted,) and not (wanted == 1 and arriving == ()):
            takes = "one number" if wanted == 1 else f"one axis with {wanted} samples"
            yield (
                f"takes {takes}, one for each of its axes; its input has {list(arriving)} samples",
                "Connect an input of that shape",
            )

    def position_codes(self, ins: Mapping[str, Axes]) -> Mapping[str, PositionCode]:
        axes = tuple(self.axes)
        return {"input": PositionCode(axes, per_axis(self.gain, axes), per_axis(self.offset, axes))}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        axes, values = tuple(self.axes), jnp.reshape(inputs["input"], (len(self.axes),))
        ends = boundaries(self.boundary, axes)
        every = zip(
            axes,
            ends,
            per_axis(self.sigma, axes),
            per_axis(self.gain, axes),
            per_axis(self.offset, axes),
            strict=True,
        )
        factors: list[Array] = []
        for d, (axis, end, sigma, gain, offset) in enumerate(every):
            distance = at.points(axis) - (gain * values[d] + offset)
            if end == "periodic":
                length = axis.range if axis.periodic else axis.step * axis.samples
                distance = distance - length * jnp.round(distance / length)
            factor = jnp.exp(-0.5 * (distance / sigma) ** 2)
            # the sum may be 0: a narrow peak may lie outside the axis or between two samples
            if self.normalized:
                whole = jnp.sum(factor) * axis.step
                factor = factor / jnp.where(whole > 0, whole, 1.0)
            factors.append(factor)
        y = self.amplitude * factors[0]
        for factor in factors[1:]:
            # a product of matrices (the second row adds 0) is computed once; otherwise XLA would recompute
            # the exponentials in every sum that reads them, which doubled the step of a model with 16 fields
            y = jnp.tensordot(
                jnp.stack([y, jnp.zeros_like(y)]),
                jnp.stack([factor, factor]),
                axes=(0, 0),
                precision="highest",
            )
        return {"output": y}

    @classmethod
    def example(cls) -> SpaceCode:
        return cls([Axis("x", 0, 20, samples=21)], name="example")
