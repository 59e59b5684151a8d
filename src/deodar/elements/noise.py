"""The noise source."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Element, Setting, Time
from deodar.leaves import is_neutral, per_axis
from deodar.numerics import noise as noises
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.signs import Sign
from deodar.parameters import Live, PerAxis, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Noise(Element):
    r"""A source of Gaussian noise, for several targets at once or through a coupling.

    As input of a field it has the same effect as the field's parameter `noise` of strength q: an Euler step
    adds q sqrt(dt) / tau xi_n.

    Equation:
        y(x, t_n) = \frac{q\, \xi_n(x)}{\sqrt{dt}}

    Parameters:
        axes: axes of the noise; none: one number.
        amplitude: q, strength; without `length` divided by the root of the cell's volume, else the standard
            deviation at a point of the process that the stochastic Euler step adds.
        length: correlation length in axis units, one value or one for each axis; 0: white.

    Ports:
        output: over `axes`; a new sample in every step of the element.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 16 and 17.
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="where it is defined")] = ()
    amplitude: Annotated[float, Live("activation", lower=0, neutral=0.0, meaning="strength")] = 1.0
    length: Annotated[
        PerAxis, Rebuild("axis", lower=0, neutral=0.0, off=True, meaning="correlation length")
    ] = 0.0

    inputs: ClassVar[tuple[str, ...]] = ()
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ()}

    def polarity(self) -> Sign:
        return "±"

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def steady(self) -> bool:
        return False

    def noise_axes(self) -> Axes | None:
        return None if is_neutral(self.amplitude) else tuple(self.axes)

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        lengths = [float(v) for v in per_axis(self.length, self.axes)]
        if any(lengths) and not all(lengths):
            yield "length is 0 on one axis and not on another; give all of them or none"

    def prepare(self, at: Setting) -> dict[str, list[Array]]:
        return noises.prepare(tuple(self.axes), self.length, at.dtype)

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: dict[str, list[Array]],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        if noise is None:
            return {"output": at.full(tuple(self.axes), 0.0)}
        return {"output": self.amplitude / jnp.sqrt(time.dt) * self._over(noise, constants)}

    def _over(self, deviates: Array, constants: dict[str, list[Array]]) -> Array:
        return noises.over(tuple(self.axes), deviates, constants.get("noise"))
