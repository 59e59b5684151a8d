"""Couplings that delay a signal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Element, PortAxes, PortBounds, PortUnits, Setting
from deodar.numerics.axes import Axis
from deodar.numerics.exact import Exact, exact, wide
from deodar.numerics.intervals import hull
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Delay(Element):
    r"""A delay of the input by one step.

    A connection with `reads="delayed"` is compiled to this element. `DelayLine` delays by any time.

    Equation:
        y(x, t + dt) = \mathrm{input}(x, t)

    Parameters:
        axes: axes of the input.
        initial: output in the first step.

    Ports:
        input: over `axes`.
        output: over `axes`.

    Reference:
        no reference
    """

    axes: Sequence[Axis] = ()
    initial: Annotated[float, Live()] = 0.0

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": hull((self.initial, self.initial), inputs["input"])}

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        return {"output": inputs["input"]}

    def init(self, at: Setting) -> Arrays:
        return {"held": at.full(tuple(self.axes), self.initial)}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.state["held"]}

    def advance(self, at: Setting) -> Arrays:
        return {"held": at.inputs["input"]}


NEVER = 1e30
"""Age of samples that have not arrived yet, in any time unit; their time is minus this."""

NEAR = 1e-3
"""Tolerance for rounding when ages are compared, as a fraction of a step."""


@register
@dataclass(frozen=True)
class DelayLine(Element):
    r"""A delay of the input by any time, such as a conduction time or the latency of a sensor.

    The input is stored every delay / slots, but at most once per step, and interpolated linearly between the
    two nearest stored samples. The output is exact if the delay is a whole number of steps, at most `slots`
    of them.

    Equation:
        y(x, t) = \begin{cases} \mathrm{input}(x, t - \mathrm{delay}) & t \ge \mathrm{delay} \\
            \mathrm{initial} & \text{else} \end{cases}

    Parameters:
        axes: axes of the input; none: one number.
        delay: the delay; in the document's time unit, > 0. Shorter than a step: one step. If it increases
            while the model runs, the output is the oldest stored sample until older samples exist.
        slots: number of stored samples.
        initial: output before the first input has passed the delay.

    Ports:
        input: over `axes`.
        output: y, over `axes`.

    Reference:
        no reference
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    delay: Annotated[float, Live("time", role="duration", exact=True, lower=1e-6)] = 100.0
    slots: Annotated[int, Recompile(lower=1, upper=100_000)] = 100
    initial: Annotated[float, Live()] = 0.0

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": hull((self.initial, self.initial), inputs["input"])}

    def init(self, at: Setting) -> Arrays:
        # one extra slot on either side of the delay, so that both neighbours of it are stored
        rows = self.slots + 2
        kept = jnp.broadcast_to(
            at.full(tuple(self.axes), self.initial), (rows, *(a.samples for a in self.axes))
        )
        return {
            "kept": kept,
            "moments": jnp.full((rows,), -NEVER, at.dtype),
            "moments_low": jnp.zeros(rows, at.dtype),
            "newest": at.full((), 0.0),
        }

    def state_axes(self, ins: PortAxes) -> Mapping[str, Sequence[Axis | int]]:
        rows = self.slots + 2
        return {"kept": (rows, *self.axes), "moments": (rows,), "moments_low": (rows,)}

    def output(self, at: Setting) -> Arrays:
        kept, rows = at.state["kept"], self.slots + 2
        first = at.state["newest"].astype(jnp.int32)
        with exact():
            delay, near = wide(self.delay), NEAR * at.time.wide_dt
            ages = jnp.roll(self._ages(at), -first)
            younger = jnp.clip(jnp.sum(ages < delay - near) - 1, 0, rows - 1).astype(jnp.int32)
            older = jnp.minimum(younger + 1, rows - 1)
            a, b = ages[younger], ages[older]
            share = jnp.clip((delay - a) / jnp.where(b > a, b - a, 1.0), 0.0, 1.0)
            # no interpolation towards samples that have not arrived: the output is the initial value until
            # the first sample is old enough
            share = jnp.where((b >= NEVER) | (b - delay < near), 1.0, share)
            share = jnp.where(a >= delay - near, 0.0, share).astype(at.dtype)
        young, old = kept[jnp.mod(first + younger, rows)], kept[jnp.mod(first + older, rows)]
        return {"output": (1 - share) * young + share * old}

    def advance(self, at: Setting) -> Arrays:
        newest, now = at.state["newest"], at.time.moment
        with exact():
            due = (
                self._ages(at)[newest.astype(jnp.int32)]
                >= wide(self.delay) / self.slots - NEAR * at.time.wide_dt
            )
        newest = jnp.where(due, jnp.mod(newest - 1, self.slots + 2), newest)
        place = newest.astype(jnp.int32)
        new = {"kept": at.inputs["input"], "moments": now.high, "moments_low": now.low}
        return {"newest": newest} | {
            name: at.state[name].at[place].set(jnp.where(due, value, at.state[name][place]))
            for name, value in new.items()
        }

    def _ages(self, at: Setting) -> Array:
        """The age of each stored sample in float64; call it inside `exact()`."""
        return jnp.where(
            at.state["moments"] > -0.5 * NEVER,
            at.time.wide - wide(Exact(at.state["moments"], at.state["moments_low"])),
            NEVER,
        )
