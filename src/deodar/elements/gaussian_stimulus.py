"""The Gaussian stimulus."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp

from deodar.element import Setting
from deodar.elements._stimulus import Stimulus
from deodar.leaves import per_axis
from deodar.parameters import Live, PerAxis
from deodar.registry import register


@register
@dataclass(frozen=True)
class GaussianStimulus(Stimulus):
    """Localised input: what a sensor or another field sends about one value.

    Equation:
        s(x) = amplitude * exp(-sum_i (x_i - center_i)^2 / (2 sigma_i^2)); on a periodic axis the shortest way round.

    Parameters:
        axes: where it is defined; none: a constant for a node.
        center: place of the maximum in axis units, one or one for each axis.
        sigma: width in axis units, one or one for each axis; > 0.
        amplitude: value at the centre.
        windows: when it is on, pairs (start, stop) in the document's time unit; without windows always.

    Ports:
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    center: Annotated[PerAxis, Live("axis", meaning="place of the maximum")] = 0.0
    sigma: Annotated[PerAxis, Live("axis", lower=1e-6, meaning="width")] = 5.0
    amplitude: Annotated[float, Live("activation", meaning="value at the centre")] = 1.0

    def pattern(self, at: Setting) -> Any:
        y = self.amplitude * jnp.ones((), at.dtype)
        centers, sigmas = per_axis(self.center, self.axes), per_axis(self.sigma, self.axes)
        for axis, center, sigma in zip(self.axes, centers, sigmas, strict=True):
            distance = at.points(axis) - center
            if axis.periodic:
                distance = distance - axis.range * jnp.round(distance / axis.range)
            y = y[..., None] * jnp.exp(-0.5 * (distance / sigma) ** 2)
        return y
