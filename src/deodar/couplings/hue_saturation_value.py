"""Hue, saturation and value of a picture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.colors import CHANNELS, hue_saturation_value
from deodar.numerics.intervals import Interval
from deodar.registry import register

TURN = 360.0
"""Degrees of all hues."""


@register
@dataclass(frozen=True)
class HueSaturationValue(Coupling):
    r"""The hue, saturation and value of each pixel in place of its red, green and blue.

    A grey pixel has the hue 0.

    Equation:
        v = \max(r, g, b),\quad c = v - \min(r, g, b),\quad s = c / v
        h = 60 \cdot \begin{cases} (g - b) / c \bmod 6 & v = r \\ (b - r) / c + 2 & v = g \\
            (r - g) / c + 4 & v = b \end{cases}

    Parameters:
        none.

    Ports:
        input: picture over two dimensions and a last axis of three samples, the channels red, green and blue,
            values 0 to 1.
        output: over the same axes; along the last one hue (0 to 360 degrees, red 0), saturation and value (0
            to 1).

    Reference:
        Smith (1978), Color gamut transform pairs, Comput. Graph. (SIGGRAPH) 12, 12-19.
    """

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        source = ins["input"]
        if len(source) != 3 or source[-1].samples != CHANNELS:
            yield "needs a picture: two dimensions, and a last axis with the channels red, green and blue"

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": (min(0.0, inputs["input"][0]), max(TURN, inputs["input"][1]))}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        hue, saturation, value = hue_saturation_value(inputs["input"])
        return {"output": jnp.stack([TURN * hue, saturation, value], axis=-1)}
