"""The homogeneous boost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Setting
from deodar.elements._stimulus import Stimulus
from deodar.numerics.axes import shape
from deodar.numerics.intervals import Interval
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class Boost(Stimulus):
    r"""A homogeneous input that moves a field or node closer to its detection instability.

    Equation:
        s(x) = \mathrm{amplitude}

    Parameters:
        axes: axes of the stimulus; none: a constant, which expands along the axes of any target.
        amplitude: value at every sample.
        windows: when it is on, pairs (start, stop) in the document's time unit; without windows always.

    Ports:
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 7 (the boost of a field by a
        node).
    """

    amplitude: Annotated[float, Live("activation", meaning="value everywhere")] = 1.0

    def strength(self) -> Interval:
        return self.amplitude, self.amplitude

    def polarity(self) -> Sign:
        return sign_of(self.amplitude)

    def pattern(self, at: Setting) -> Array:
        return jnp.broadcast_to(jnp.asarray(self.amplitude, at.dtype), shape(self.axes))
