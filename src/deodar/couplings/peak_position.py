"""The read-out of a peak's position."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, Axis, one_axis
from deodar.numerics.centres import centre
from deodar.numerics.positions import PositionUnit, PositionUnits
from deodar.parameters import Live, Recompile
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
        absent: output without a peak (or, on a periodic axis, for input without direction), in axis units.

    Ports:
        input: f, over the axis.
        output: x_cmd, one number, in axis units.
        strength: N, one number.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 12 and 13.
    """

    axis: Annotated[
        Axis | None, Recompile(meaning="dimension read out; by default the axis of the source")
    ] = None
    least: Annotated[
        float, Live("input x axis", lower=1e-9, meaning="integral below which there is no peak")
    ] = 0.1
    absent: Annotated[float, Live("axis", meaning="position while there is no peak")] = 0.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "strength": ("input",)}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving if self.axis is None else (self.axis,)

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        yield from one_axis(ins["input"])

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": (), "strength": ()}

    def position_units(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, PositionUnits]
    ) -> Mapping[str, PositionUnits]:
        axes = ins["input"]
        read = PositionUnit.of(axes[0]) if len(axes) == 1 else None
        return {} if read is None else {"output": (read,)}

    def jumps_at(self) -> Sequence[str]:
        return ("least",)

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        [axis] = at.ins["input"]
        place, there, n = centre(axis, inputs["input"] * axis.step, self.least)
        return {"output": jnp.where(there, place, self.absent), "strength": n}

    @classmethod
    def example(cls) -> PeakPosition:
        return cls(Axis("x", 0, 20, samples=21), name="example")
