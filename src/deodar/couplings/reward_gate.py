"""The gate that a reward opens for learning."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, cell
from deodar.numerics.exact import Exact, exact, wide
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Live, Recompile
from deodar.registry import register

NEVER = -1e30
"""Time of the last onset while no onset has occurred, in any time unit."""


@register
@dataclass(frozen=True)
class RewardGate(Coupling):
    r"""A gate of learning, open while a reward lasts or for a fixed time from its onset.

    With `duration` 0 the gate is open while r > threshold. Otherwise it opens when r exceeds the threshold
    and stays open for `duration`; the next onset, after r has fallen to the threshold, opens it again.

    Equation:
        r = \mathrm{gate} \int \mathrm{input}(x)\, dx
        \epsilon = \begin{cases} \mathrm{strength} & \text{while open} \\ 0 & \text{else}
            \end{cases}
        \text{graded:}\quad \epsilon = \mathrm{strength}\, r \text{ while open}

    Parameters:
        threshold: value of r above which the gate opens, in units of the input times the axes.
        duration: time for which the gate is open, in the document's time unit; 0: as long as the reward
            lasts.
        strength: epsilon while open, or its factor if graded.
        graded: whether epsilon is proportional to r while the gate is open, as in eq. 16.
        gated: whether the element has a port `gate`; without it the gate factor is 1.

    Ports:
        input: the reward, any axes; usually the output of a field or node that detects success.
        gate: factor of the reward, such as a signal that a movement has ended; one number, only if `gated`.
        output: epsilon, one number; computed from the reward of the same step.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 16 (graded), and the time windows of eqs. 12 and 13.
        The window of fixed length is deodar's addition: it limits the learning from one reward, and continues
        after a reward that is shorter.
    """

    threshold: Annotated[float, Live(lower=0, meaning="value that the reward must exceed")] = 0.5
    duration: Annotated[
        float,
        Live(
            "time",
            role="duration",
            exact=True,
            lower=0,
            meaning="how long a window is open; 0: while reward lasts",
        ),
    ] = 0.0
    strength: Annotated[float, Live(meaning="output while open, or its factor")] = 1.0
    graded: Annotated[bool, Recompile(meaning="whether the output follows the reward")] = False
    gated: Annotated[bool, Recompile(meaning="whether reward waits for the gate")] = False

    inputs: ClassVar[tuple[str, ...]] = ("input", "gate")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "gate")}
    stateful: ClassVar[bool] = True

    def polarity(self) -> Sign:
        return sign_of(self.strength)

    def ports(self) -> tuple[str, ...]:
        return self.inputs if self.gated else self.inputs[:1]

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving if port == "input" else ()

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": ()}

    def jumps_at(self) -> Sequence[str]:
        return *self.ports(), "threshold"

    def init(self, at: Setting) -> Arrays:
        return {"onset": at.full((), NEVER), "onset_low": at.full((), 0.0), "rewarded": at.full((), 0.0)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        reward = self._reward(at, inputs)
        with exact():
            duration, passed = (
                wide(self.duration),
                time.wide - wide(Exact(state["onset"], state["onset_low"])),
            )
            # half a step of tolerance, so that rounding moves no edge
            lasts, bounded = passed < duration - 0.5 * time.wide_dt, duration > 0
        is_open = jnp.where(bounded, self._onset(state, reward) | lasts, reward > self.threshold)
        return {"output": jnp.where(is_open, self.strength * (reward if self.graded else 1.0), 0.0)}

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        reward, now = self._reward(at, inputs), time.moment
        begins = self._onset(state, reward)
        return {
            "onset": jnp.where(begins, now.high, state["onset"]),
            "onset_low": jnp.where(begins, now.low, state["onset_low"]),
            "rewarded": (reward > self.threshold).astype(at.dtype),
        }

    def _reward(self, at: Setting, inputs: Arrays) -> Array:
        reward = cell(at.ins["input"]) * jnp.sum(inputs["input"])
        return reward * inputs["gate"] if self.gated else reward

    def _onset(self, state: Arrays, reward: Array) -> Array:
        return (reward > self.threshold) & (state["rewarded"] == 0)

    @classmethod
    def example(cls) -> RewardGate:
        return cls(duration=3.0, graded=True, gated=True, name="example")
