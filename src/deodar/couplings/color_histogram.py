"""The histogram of hues in each column of a picture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array, lax

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import is_neutral
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.colors import CHANNELS, cells, from_hues, hue_saturation_value, same_side
from deodar.numerics.convolution import along
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class ColorHistogram(Coupling):
    r"""The histogram of hues in each column of a picture.

    A column in which all pixels have one hue gives 1 at that hue. n(x, h) is the share of the pixels of
    column x whose hue is h (each pixel is divided between the two nearest samples); pixels with a saturation
    below `palest` or a value below `darkest` are not counted.

    Equation:
        y(x, h) = \sum_j n(x, h_j) \exp\!\left( -\frac{(h - h_j)^2}{2 \sigma^2} \right)
        \sigma = 0\text{:}\quad y(x, h) = n(x, h)

    Parameters:
        axes: the dimension of the picture that remains (it may have fewer samples than the picture), then
            hue; hue is periodic.
        sigma: width of the smoothing over hue, in units of the hue axis; 0: none.
        palest: saturation (0 to 1) below which a pixel is not counted.
        darkest: value (largest channel, 0 to 1) below which a pixel is not counted.

    Ports:
        input: picture over two dimensions and a last axis of three samples, the channels red, green and blue,
            values 0 to 1.
        output: over `axes`, 0 to 1 (with smoothing, contributions of several hues add up).

    Reference:
        Sandamirskaya & Schöner (2010), Serial order in an acting system, Neural Netw. 23, 1164-1179, figure 8
        and section 4. The paper states neither the limits, the smoothing nor the scale; deodar's values are
        guesses (the share per single bin reaches none of the paper's thresholds).
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="side of the picture that is kept, then hue")] = ()
    sigma: Annotated[
        float, Live("hue", lower=0, neutral=0.0, off=True, meaning="width of the smoothing over hue")
    ] = 0.0
    palest: Annotated[float, Live(lower=0, upper=1, meaning="saturation below which a pixel has no hue")] = (
        0.3
    )
    darkest: Annotated[float, Live(lower=0, upper=1, meaning="value below which a pixel has no hue")] = 0.15

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        source = ins["input"]
        if len(source) != 3 or source[-1].samples != CHANNELS or len(self.axes) != 2:
            yield (
                "needs a picture (two dimensions and three channels) and gives one of its dimensions and hue"
            )
            return
        kept, hue = self.axes
        if not hue.periodic:
            yield f"the hue axis {hue.name!r} must be periodic: red lies on both sides of its ends"
        side = next((a for a in source[:2] if a.name == kept.name), None)
        if side is None or not same_side(side, kept):
            found = side or " and ".join(a.name for a in source[:2])
            yield (
                f"axis {kept.name!r} does not fit the picture's: {found} there, {kept} here (ends may differ"
                " by a grid step)"
            )

    def prepare(self, at: Setting) -> Arrays:
        kept = self._kept(at)
        return {"cells": cells(at.ins["input"][kept], self.axes[0], at.dtype)}

    def hoist(self, at: Setting, constants: Arrays) -> Arrays:
        if is_neutral(self.sigma):
            return constants
        hue = self.axes[-1]
        turns = (at.points(hue) - hue.lower) / hue.range
        return constants | {"smooth": jnp.exp(-0.5 * (from_hues(hue, turns, at.dtype) / self.sigma) ** 2)}

    def jumps_at(self) -> Sequence[str]:
        return "input", "palest", "darkest"

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        hue = self.axes[-1]
        turn, saturation, value = hue_saturation_value(inputs["input"])
        coloured = (saturation >= self.palest) & (value >= self.darkest) & (saturation > 0)
        if self._kept(at) == 1:
            turn, coloured = turn.T, coloured.T
        counted = coloured / jnp.asarray(turn.shape[1], at.dtype)

        def add(line: Array, y: Array) -> Array:
            # one line at a time: an array of all pixels and hues would take ten times as long
            shares = jnp.maximum(0.0, 1.0 - jnp.abs(from_hues(hue, turn[:, line], at.dtype)) / hue.step)
            return y + counted[:, line, None] * shares

        y = lax.fori_loop(0, turn.shape[1], add, jnp.zeros((turn.shape[0], hue.samples), at.dtype))
        y = along(constants["cells"], y, 0)
        return {"output": along(constants["smooth"], y, 1) if "smooth" in constants else y}

    def _kept(self, at: Setting) -> int:
        """The index of the picture's dimension that remains."""
        return [a.name for a in at.ins["input"][:2]].index(self.axes[0].name)

    @classmethod
    def example(cls) -> ColorHistogram:
        return cls([Axis("x", 0, 4, 3), Axis("hue", 0, 360, 6, periodic=True)], sigma=30.0, name="example")
