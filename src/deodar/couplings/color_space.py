"""The conversion of a picture's colours to a space code."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import is_neutral
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.colors import CHANNELS, cells, from_hues, hue_saturation_value, same_side
from deodar.numerics.convolution import along
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class ColorSpace(Coupling):
    r"""A space code of a picture over position and hue, with the saturation as amplitude.

    H(p) and S(p) are hue and saturation of pixel p; S counts as 0 where the value is below `darkest`. For
    sigma = 0, w is a density of integral 1, which divides S between the two nearest samples.

    Equation:
        y(x, \mathrm{hue}) = \operatorname{mean}_{p \in \mathrm{cell}(x)} S(p)\, w(\mathrm{hue} -
            H(p))
        w(d) = \exp\!\left( -\frac{d^2}{2 \sigma^2} \right)
        \sigma = 0\text{:}\quad w(d) = \frac{1}{\mathrm{step}} \max\!\left(0, 1 -
            \frac{|d|}{\mathrm{step}}\right)

    Parameters:
        axes: the picture's two dimensions (they may have fewer samples than the picture), then hue; hue is
            periodic.
        sigma: width of the code along hue, in units of the hue axis; 0: no smoothing (a hue is divided
            between its two nearest samples).
        darkest: value (largest channel, 0 to 1) below which a pixel does not count, because its saturation is
            mostly noise.

    Ports:
        input: picture over the same two dimensions and a last axis of three samples, the channels red, green
            and blue, values 0 to 1.
        output: over `axes`; 0 to 1, for sigma = 0 per unit of the hue axis, 0 to 1 / step. Its integral over
            hue does not depend on the sampling of hue.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 11 and the smoothing after it.
        Hue and saturation: Smith (1978), Color gamut transform pairs, SIGGRAPH '78 (HSV).
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="two dimensions of the picture, then hue")] = ()
    sigma: Annotated[
        float, Live("hue", lower=0, neutral=0.0, off=True, meaning="width of the code along hue")
    ] = 0.0
    darkest: Annotated[float, Live(lower=0, upper=1, meaning="value below which a pixel has no colour")] = (
        0.15
    )

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        source = ins["input"]
        if len(source) != 3 or source[-1].samples != CHANNELS or len(self.axes) != 3:
            yield "needs a picture (two dimensions and three channels) and gives two dimensions and hue"
            return
        if not self.axes[-1].periodic:
            yield f"the hue axis {self.axes[-1].name!r} must be periodic: red lies on both sides of its ends"
        for fine, coarse in zip(source[:2], self.axes[:2], strict=True):
            if not same_side(fine, coarse):
                yield (
                    f"axis {coarse.name!r} does not fit the picture's: {fine} there, {coarse} here (ends may"
                    " differ by a grid step)"
                )

    def prepare(self, at: Setting) -> list[Array]:
        return [cells(a, b, at.dtype) for a, b in zip(at.ins["input"][:2], self.axes[:2], strict=True)]

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: list[Array],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        hue_axis = self.axes[-1]
        turn, saturation, value = hue_saturation_value(inputs["input"])
        saturation = jnp.where(value < self.darkest, 0.0, saturation)
        distance = from_hues(hue_axis, turn, at.dtype)
        if is_neutral(self.sigma):
            code = jnp.maximum(0.0, 1.0 - jnp.abs(distance) / hue_axis.step) / hue_axis.step
        else:
            code = jnp.exp(-0.5 * (distance / self.sigma) ** 2)
        y = saturation[..., None] * code
        for d, weights in enumerate(constants):
            y = along(weights, y, d)
        return {"output": y}

    @classmethod
    def example(cls) -> ColorSpace:
        axes = [Axis("x", 0, 4, 3), Axis("y", 0, 4, 3), Axis("hue", 0, 360, 6, periodic=True)]
        return cls(axes, sigma=30.0, name="example")
