"""The fixed shift."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import per_axis
from deodar.numerics.axes import Axis
from deodar.parameters import PerAxis, Rebuild
from deodar.registry import register


@register
@dataclass(frozen=True)
class Shift(Coupling):
    """Moves a pattern: a peak at x arrives at x + amount.

    Equation:
        y(x) = input(x - amount), interpolated linearly; zero comes in at the ends of an axis that is not periodic

    Parameters:
        amount: how far, in axis units, one or one for each axis.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), appendix A (the
        plain shifts between its fields).
    """

    amount: Annotated[PerAxis, Rebuild("axis", meaning="how far")] = 0.0

    linear: ClassVar[bool] = True

    def prepare(self, at: Setting) -> Any:
        axes = at.ins["input"]
        return [_neighbours(at, axis, amount) for axis, amount in zip(axes, per_axis(self.amount, axes), strict=True)]

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        y = inputs["input"]
        for d, ((place, share), (above, rest)) in enumerate(constants):
            along = [1] * y.ndim
            along[d] = -1
            y = share.reshape(along) * jnp.take(y, place, d, mode="clip") + rest.reshape(along) * jnp.take(y, above, d, mode="clip")
        return {"output": y}


def _neighbours(at: Setting, axis: Axis, amount: Any) -> list[tuple[Any, Any]]:
    """For every sample the two samples between which it comes from, and the share of each: moving them is five times cheaper than a product."""
    start = (at.points(axis) - amount - axis.lower) / axis.step
    below = jnp.floor(start)
    share = start - below
    out: list[tuple[Any, Any]] = []
    for place, part in ((below, 1 - share), (below + 1, share)):
        n = axis.samples
        if axis.periodic:
            out.append((jnp.mod(place, n).astype(jnp.int32), part))
        else:
            out.append((jnp.clip(place, 0, n - 1).astype(jnp.int32), jnp.where((place >= 0) & (place < n), part, 0.0)))
    return out
