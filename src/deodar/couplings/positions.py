"""Couplings between peaks and numbers that are positions on axes."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, PortAxes, PortUnits, Setting
from deodar.leaves import per_axis
from deodar.numerics.axes import Axes, Axis, cell, one_axis, shape
from deodar.numerics.centres import centre
from deodar.numerics.convolution import boundaries
from deodar.numerics.positions import PositionCode, PositionUnit
from deodar.parameters import Live, PeakBoundary, PerAxis
from deodar.registry import register


@register
@dataclass(frozen=True)
class PeakPosition(Coupling):
    r"""The position of a peak: the mean of the axis weighted by the input.

    Equation:
        N = \int f(x)\, dx
        x_{\mathrm{cmd}} = \begin{cases} \frac{1}{N} \int x\, f(x)\, dx & N > \mathrm{least} \\
            \mathrm{absent} & \text{else} \end{cases}
        \text{axis of period } P\text{:}\quad x_{\mathrm{cmd}} = \frac{P}{2 \pi} \arg \int e^{2 \pi
            i x / P} f(x)\, dx

    Parameters:
        axis: the dimension read out; other axes of the source are integrated out. By default the axis of the
            source, which then must have exactly one axis.
        least: N up to which the input counts as no peak; > 0.
        absent: output without a peak; also, on a periodic axis, for input without direction; in axis units.

    Ports:
        input: f, over the axis.
        output: x_cmd, one number, in axis units.
        strength: N, one number.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 12 and 13.
    """

    axis: Axis | None = None
    least: Annotated[float, Live("input x axis", lower=1e-9)] = 0.1
    absent: Annotated[float, Live("axis")] = 0.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "strength": ("input",)}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving if self.axis is None else (self.axis,)

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        yield from one_axis(ins["input"])

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": (), "strength": ()}

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        axes = ins["input"]
        read = PositionUnit.of(axes[0]) if len(axes) == 1 else None
        return {} if read is None else {"output": (read,)}

    def jumps_at(self) -> Sequence[str]:
        return ("least",)

    def output(self, at: Setting) -> Arrays:
        [axis] = at.ins["input"]
        place, there, n = centre(axis, at.inputs["input"] * axis.step, self.least)
        return {"output": jnp.where(there, place, self.absent), "strength": n}

    @classmethod
    def example(cls) -> PeakPosition:
        return cls(Axis("x", 0, 20, samples=21), name="example")


@register
@dataclass(frozen=True)
class MaximumPosition(Coupling):
    r"""The position of the largest sample; of several equal ones the first.

    It jumps by whole samples, and noise moves it. `PeakPosition` and `RateCode` give the mean of a peak.

    Equation:
        x_{\mathrm{max}} = \begin{cases} \arg \max_x f(x) & \max_x f(x) > \mathrm{least} \\
            \mathrm{absent} & \text{else} \end{cases}

    Parameters:
        least: value that the largest sample must exceed.
        absent: output along every axis if it does not, in axis units.

    Ports:
        input: f, any axes, at least one.
        output: one number for one axis, in axis units; for several axes, an axis with one sample for each of
            them, in their order.

    Reference:
        no reference
    """

    least: Annotated[float, Live()] = 0.1
    absent: Annotated[float, Live("axis")] = 0.0

    jumps: ClassVar[bool] = True
    # at the edge of a plateau an output beyond 1 would be the largest
    bounded_inputs: ClassVar[tuple[str, ...]] = ("input",)

    def jumps_at(self) -> Sequence[str]:
        return "input", "least"

    def outputs(self, ins: PortAxes) -> PortAxes:
        n = len(ins["input"])
        return {"output": (Axis("component", 0, n - 1, n),) if n > 1 else ()}

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        if not ins["input"]:
            yield "needs an input with an axis, not one number"

    def output(self, at: Setting) -> Arrays:
        axes, f = at.ins["input"], at.inputs["input"]
        places = jnp.unravel_index(jnp.argmax(f), f.shape)
        there = jnp.max(f) > self.least
        found = [
            jnp.where(there, axis.lower + axis.step * place, self.absent).astype(at.dtype)
            for axis, place in zip(axes, places, strict=True)
        ]
        return {"output": jnp.stack(found) if len(found) > 1 else found[0]}


@register
@dataclass(frozen=True)
class RateCode(Coupling):
    r"""A rate code of a peak's position: the inverse of `SpaceCode` with the same gain and offset.

    The inverse is exact if the axis contains the whole peak. On a linear axis the error of the position is at
    most 1.4e-4 sigma for a peak 4 sigma from an end, and 6.1e-9 sigma at 6 sigma; nearer to an end the mean
    shifts inwards, because the axis cuts off a part of the peak. On a periodic axis the peak's sigma must be
    at most a twelfth of the period; whole turns are lost, because c lies between the ends of the axis.

    Equation:
        y_i = \begin{cases} \frac{c_i - \mathrm{offset}_i}{\mathrm{gain}_i} & \int f(x)\, dx >
            \mathrm{least} \\ \mathrm{absent}_i & \text{else} \end{cases}
        c_i = \frac{\int x_i\, f(x)\, dx}{\int f(x)\, dx}
        \text{axis of period } P\text{:}\quad c_i = \frac{P}{2 \pi} \arg \int e^{2 \pi i x_i / P}
            f(x)\, dx

    Parameters:
        axes: axes of the peak; at least one.
        gain: axis units per unit of the output; one value or one for each axis; not 0.
        offset: position of the peak for an output of 0; in axis units, one value or one for each axis.
        least: integral up to which the input counts as no peak; > 0.
        absent: output without a peak; also, on a periodic axis, for input without direction; one value or one
            for each axis.

    Ports:
        input: f, over `axes`.
        output: y, one number for one axis; for several axes, an axis with one sample for each of them, in
            their order.
        strength: the integral of f, one number.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 12 and 13 (the read-out of a
        peak); on a periodic axis the population vector: Georgopoulos, Schwartz & Kettner (1986), Science 233,
        1416-1419.
    """

    axes: Sequence[Axis] = needed("[x]")
    gain: Annotated[PerAxis, Live()] = 1.0
    offset: Annotated[PerAxis, Live("axis")] = 0.0
    least: Annotated[float, Live("input x axis", lower=1e-9)] = 0.1
    absent: Annotated[PerAxis, Live()] = 0.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "strength": ("input",)}

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.axes:
            yield "axes", "is empty; a peak needs at least one axis"
        if 0.0 in (self.gain if isinstance(self.gain, tuple) else (self.gain,)):
            yield "gain", "is 0: then every number has the same position, so a position encodes none"

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return tuple(self.axes)

    def outputs(self, ins: PortAxes) -> PortAxes:
        n = len(self.axes)
        return {"output": (Axis("component", 0, n - 1, n),) if n > 1 else (), "strength": ()}

    def jumps_at(self) -> Sequence[str]:
        return ("least",)

    def output(self, at: Setting) -> Arrays:
        axes, f = tuple(self.axes), at.inputs["input"] * cell(self.axes)
        every = zip(axes, *(per_axis(v, axes) for v in (self.gain, self.offset, self.absent)), strict=True)
        found: list[Array] = []
        for d, (axis, gain, offset, absent) in enumerate(every):
            along = jnp.sum(f, axis=tuple(k for k in range(len(axes)) if k != d))
            place, there, _ = centre(axis, along, self.least)
            found.append(jnp.where(there, (place - offset) / gain, absent))
        return {"output": jnp.stack(found) if len(axes) > 1 else found[0], "strength": jnp.sum(f)}

    @classmethod
    def example(cls) -> RateCode:
        return cls([Axis("x", 0, 20, samples=21)], name="example")


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
        sigma: width; in axis units, one value or one for each axis, > 0.
        amplitude: value at the centre; if normalized, the integral.
        gain: axis units per unit of the input; one value or one for each axis.
        offset: position of the peak for an input of 0; in axis units, one value or one for each axis.
        normalized: whether the amplitude is the integral.
        boundary: whether it wraps around the ends; `periodic` (the peak wraps around the ends) or `zero` (it
            does not), one value or one for each axis; none: periodic on periodic axes.

    Ports:
        input: one number for one axis; for several axes, an axis with one sample for each of them, in their
            order.
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5.1 (sensors as space
        code); Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), figure 4 (place and head direction).
    """

    axes: Sequence[Axis] = needed("[x]")
    sigma: Annotated[PerAxis, Live("axis", lower=1e-6)] = 5.0
    amplitude: Annotated[float, Live("activation")] = 1.0
    gain: Annotated[PerAxis, Live()] = 1.0
    offset: Annotated[PerAxis, Live("axis")] = 0.0
    normalized: bool = dc.field(default=False, kw_only=True)
    boundary: PeakBoundary = dc.field(default=None, kw_only=True)

    signed_by: ClassVar[tuple[str, ...]] = ("amplitude",)

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.axes:
            yield "axes", "is empty; a peak needs at least one axis"

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
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

    def position_codes(self, ins: PortAxes) -> Mapping[str, PositionCode]:
        axes = tuple(self.axes)
        return {"input": PositionCode(axes, per_axis(self.gain, axes), per_axis(self.offset, axes))}

    def output(self, at: Setting) -> Arrays:
        axes, values = tuple(self.axes), jnp.reshape(at.inputs["input"], (len(self.axes),))
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
