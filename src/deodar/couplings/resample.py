"""The resampling of a signal on another grid."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics import resampling
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.convolution import along
from deodar.numerics.intervals import ZERO, Interval, hull
from deodar.parameters import Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Resample(Coupling):
    r"""The input on another grid of the same dimensions, which may cover another range.

    Values between samples are interpolated; values beyond the ends of an axis that is not periodic are 0.

    Equation:
        y(x) = \mathrm{input}(x)

    Parameters:
        axes: axes of the same names in the same order, with the new grid.
        interpolation: `linear` or `nearest`.

    Ports:
        input: axes of the same names in the same order.
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 3.3.
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="the new grid")] = ()
    interpolation: Annotated[str, Recompile(choices=resampling.INTERPOLATIONS, meaning="between samples")] = (
        "linear"
    )

    linear: ClassVar[bool] = True

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        there, here = [a.name for a in ins["input"]], [a.name for a in self.axes]
        if there != here:
            yield f"the source has the axes {there}, here are {here}; write Project to change dimensions"
            return
        for a, b in zip(ins["input"], self.axes, strict=True):
            if a.periodic and not (b.periodic and a.fits(b)):
                yield f"the periodic axis {a.name!r} has other bounds here: {a} at the source, {b} here"

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        for a, b in zip(ins["input"], self.axes, strict=True):
            if a.unit != b.unit:
                yield (
                    (
                        f"the axis {a.name!r} is in {a.unit!r} at the source and in {b.unit!r} here, and"
                        " values are not converted"
                    ),
                    "Give both axes one unit",
                )
            if not a.periodic and (b.lower > a.upper or b.upper < a.lower):
                what = (
                    f"its axis {b.name!r} ({b.lower:g}..{b.upper:g}) and the source's"
                    f" ({a.lower:g}..{a.upper:g}) do not overlap, so its output is 0"
                )
                yield what, "Give both axes bounds that overlap"

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": hull(ZERO, inputs["input"])}

    def prepare(self, at: Setting) -> list[Array]:
        pairs = zip(at.ins["input"], self.axes, strict=True)
        return [resampling.weights(a, b.points, self.interpolation, at.dtype) for a, b in pairs]

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: list[Array],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        y = inputs["input"]
        for d, weights in enumerate(constants):
            y = along(weights, y, d)
        return {"output": y}

    @classmethod
    def example(cls) -> Resample:
        return cls([Axis("x", 0, 20, samples=31)], name="example")
