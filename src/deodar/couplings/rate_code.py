"""The conversion of a peak's position to numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import per_axis
from deodar.numerics.axes import Axes, Axis, cell
from deodar.numerics.centres import centre
from deodar.parameters import Live, PerAxis, Recompile
from deodar.registry import register


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
        gain: axis units per unit of the output, one value or one for each axis; not 0.
        offset: position of the peak for an output of 0, in axis units, one value or one for each axis.
        least: integral up to which the input counts as no peak; > 0.
        absent: output without a peak (or, on a periodic axis, for input without direction), one value or one
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

    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the peak")] = needed("[x]")
    gain: Annotated[PerAxis, Live(meaning="axis units per unit of the output")] = 1.0
    offset: Annotated[PerAxis, Live("axis", meaning="place of the peak for an output of 0")] = 0.0
    least: Annotated[
        float, Live("input x axis", lower=1e-9, meaning="integral up to which there is no peak")
    ] = 0.1
    absent: Annotated[PerAxis, Live(meaning="output while there is no peak")] = 0.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "strength": ("input",)}

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.axes:
            yield "axes", "is empty; a peak needs at least one axis"
        if 0.0 in (self.gain if isinstance(self.gain, tuple) else (self.gain,)):
            yield "gain", "is 0: then every number has the same position, so a position encodes none"

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return tuple(self.axes)

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        n = len(self.axes)
        return {"output": (Axis("component", 0, n - 1, n),) if n > 1 else (), "strength": ()}

    def jumps_at(self) -> Sequence[str]:
        return ("least",)

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        axes, f = tuple(self.axes), inputs["input"] * cell(self.axes)
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
