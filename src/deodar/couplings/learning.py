"""Couplings that learn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, PortAxes, Setting
from deodar.numerics.axes import Axes, Axis, cell, describe, shape, wrong_shape
from deodar.numerics.exact import Exact, exact, wide
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import ArrayLike, Live, Rebuild
from deodar.registry import register


@register
@dataclass(frozen=True)
class AdaptiveWeights(Coupling):
    r"""Learned weights between all samples of a source and all samples of a target.

    Weights from active samples relax towards the activity of the target, without a threshold: where the
    target is 0 they decay to 0. `Hebbian` learns only where both sides exceed a threshold, and has other
    rules, bounds and random weights; it costs far less for maps between two-dimensional fields.

    Equation:
        y(x) = \int W(x', x)\, \mathrm{input}(x')\, dx'
        \frac{dW(x', x)}{dt} = \mathrm{rate}\, \mathrm{gate}\, (\mathrm{post}(x) - W(x', x))\,
            \mathrm{pre}(x')

    Parameters:
        axes: axes of the output; none: one number.
        rate: speed of learning; per unit of the document's time and of the input; from 0 to the inverse of
            the step.
        initial: all weights at the start.
        gated: whether the element has a port `gate`; without it the gate is 1.
        apart: whether the element has a port `pre`; without it pre is the input.
        start: weights at the start, in place of `initial`; for example weights learned in an earlier run.

    Ports:
        input: any axes.
        post: the activity that the weights learn, over `axes`.
        gate: one number; only if `gated`. Values below 0 count as 0.
        pre: factor of the learning rate of each source sample, over the axes of the input; only if `apart`.
        output: over `axes`; computed from the input of the same step, with the weights learned so far.
        weights: the weights learned so far, over `axes`, then the input's axes.

    Shapes:
        start: samples of the input's axes, then samples of `axes`; per unit of the source's axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, section 3.3 (weights between fields that
        relax towards the target's activity).
    """

    axes: Sequence[Axis] = needed("[x]")
    rate: Annotated[float, Live("1/time", role="rate", lower=0)] = 0.1
    initial: Annotated[float, Live()] = 0.0
    gated: bool = False
    apart: bool = False
    start: Annotated[ArrayLike | None, Rebuild()] = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "post", "gate", "pre")
    optional: ClassVar[Mapping[str, str]] = {"gate": "gated", "pre": "apart"}
    # a rate below 0 would make the weights grow without bound
    bounded_inputs: ClassVar[tuple[str, ...]] = ("input", "post", "pre")

    def polarity(self) -> Sign:
        return "±"

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return {"post": tuple(self.axes), "gate": ()}.get(port, arriving)

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": tuple(self.axes), "weights": (*self.axes, *ins["input"])}

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        needed = shape(ins["input"]) + shape(self.axes)
        yield from wrong_shape("start", self.start, needed, "source and target have")
        if self.apart and ins["pre"] != ins["input"]:
            yield f"its axes are not those that arrive at pre, {describe(ins['pre'])}"

    def init(self, at: Setting) -> Arrays:
        return {
            "weights": at.full((*at.ins["input"], *self.axes), self.initial)
            if self.start is None
            else at.array(self.start)
        }

    def state_axes(self, ins: PortAxes) -> Mapping[str, Sequence[Axis | int]]:
        return {"weights": (*ins["input"], *self.axes)}

    def output(self, at: Setting) -> Arrays:
        x, w = at.inputs["input"], at.state["weights"]
        return {
            "output": cell(at.ins["input"]) * jnp.tensordot(x, w, axes=x.ndim, precision="highest"),
            "weights": jnp.moveaxis(w, range(x.ndim), range(-x.ndim, 0)),
        }

    def advance(self, at: Setting) -> Arrays:
        x, w = at.inputs["pre" if self.apart else "input"], at.state["weights"]
        speed = self.rate * jnp.maximum(at.inputs["gate"], 0.0) if self.gated else self.rate
        pre = x.reshape(x.shape + (1,) * len(self.axes))
        return {"weights": w + at.time.dt * speed * (at.inputs["post"] - w) * pre}

    def learned_parameters(self, state: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        return {"start": state["weights"]}

    @classmethod
    def example(cls) -> AdaptiveWeights:
        return cls([Axis("target", 0, 12, samples=13)], gated=True, apart=True, name="example")


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
        threshold: value of r above which the gate opens; in units of the input times the axes.
        duration: time for which the gate is open; in the document's time unit; 0: as long as the reward
            lasts.
        strength: epsilon while open, or its factor if graded.
        graded: whether epsilon is proportional to r while the gate is open; as in eq. 16.
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

    threshold: Annotated[float, Live(lower=0)] = 0.5
    duration: Annotated[
        float,
        Live(
            "time",
            role="duration",
            exact=True,
            lower=0,
        ),
    ] = 0.0
    strength: Annotated[float, Live()] = 1.0
    graded: bool = False
    gated: bool = False

    inputs: ClassVar[tuple[str, ...]] = ("input", "gate")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "gate")}
    signed_by: ClassVar[tuple[str, ...]] = ("strength",)
    optional: ClassVar[Mapping[str, str]] = {"gate": "gated"}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving if port == "input" else ()

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": ()}

    def jumps_at(self) -> Sequence[str]:
        return *self.ports(), "threshold"

    def init(self, at: Setting) -> Arrays:
        return {"onset": at.full((), NEVER), "onset_low": at.full((), 0.0), "rewarded": at.full((), 0.0)}

    def output(self, at: Setting) -> Arrays:
        reward = self._reward(at)
        with exact():
            duration = wide(self.duration)
            passed = at.time.wide - wide(Exact(at.state["onset"], at.state["onset_low"]))
            # half a step of tolerance, so that rounding moves no edge
            lasts, bounded = passed < duration - 0.5 * at.time.wide_dt, duration > 0
        is_open = jnp.where(bounded, self._onset(at, reward) | lasts, reward > self.threshold)
        return {"output": jnp.where(is_open, self.strength * (reward if self.graded else 1.0), 0.0)}

    def advance(self, at: Setting) -> Arrays:
        reward, now = self._reward(at), at.time.moment
        begins = self._onset(at, reward)
        return {
            "onset": jnp.where(begins, now.high, at.state["onset"]),
            "onset_low": jnp.where(begins, now.low, at.state["onset_low"]),
            "rewarded": (reward > self.threshold).astype(at.dtype),
        }

    def _reward(self, at: Setting) -> Array:
        reward = cell(at.ins["input"]) * jnp.sum(at.inputs["input"])
        return reward * at.inputs["gate"] if self.gated else reward

    def _onset(self, at: Setting, reward: Array) -> Array:
        return (reward > self.threshold) & (at.state["rewarded"] == 0)

    @classmethod
    def example(cls) -> RewardGate:
        return cls(duration=3.0, graded=True, gated=True, name="example")


@register
@dataclass(frozen=True)
class GainAdaptation(Coupling):
    r"""A map from the position of a peak to a value, with gains that adapt to an error at that position.

    f is the input, lambda are the gains; without input the value is 0.

    Equation:
        y = \int \lambda(x)\, f(x)\, dx
        \mathrm{value} = \frac{y}{\int f(x)\, dx}
        \tau \frac{d\lambda(x)}{dt} = \mathrm{gate}\, \mathrm{error}\, f(x)

    Parameters:
        tau: time scale; document time times error times input, over a change of the gains, > 0, and at least
            one step.
        initial: gains at the start; equal at all samples.
        gated: whether the element has a port `gate`; without it the gate is 1.
        start: gains at the start; in place of `initial`; for example gains learned in an earlier run.

    Ports:
        input: f, any axes; usually the output of a motor field.
        error: one number with a sign: desired minus reached value, in units of the gains.
        gate: the time window of learning, one number, only if `gated`. Values below 0 count as 0.
        output: y, one number: the input of the motor variable of eq. 9.
        value: the attractor of that motor variable, one number.
        gains: lambda, over the axes of the input.

    Shapes:
        start: the samples of the input's axes, in their order.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 13, with eq. 9. Corrected: the printed epsilon is
        error times time window, here two ports, and the error is signed, so that gains can also decrease.
        With the decay of eq. 9 multiplied by the integral of f (as printed, the attractor would not vanish
        with the peak) the value changes at the rate error integral f^2 / (tau integral f): an error decays
        exponentially, at a rate that depends neither on the width of the peak nor on the sampling.
    """

    tau: Annotated[float, Live("time x input", role="time scale", lower=1e-6)] = 100.0
    initial: Annotated[float, Live()] = 0.0
    gated: bool = False
    start: Annotated[ArrayLike | None, Rebuild()] = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "error", "gate")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "value": ("input",)}
    optional: ClassVar[Mapping[str, str]] = {"gate": "gated"}

    def polarity(self) -> Sign:
        return sign_of(self.initial, self.start)

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving if port == "input" else ()

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": (), "value": (), "gains": ins["input"]}

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from wrong_shape("start", self.start, shape(ins["input"]), "the input has")

    def init(self, at: Setting) -> Arrays:
        return {
            "gains": at.full(at.ins["input"], self.initial) if self.start is None else at.array(self.start)
        }

    def state_axes(self, ins: PortAxes) -> Mapping[str, Sequence[Axis | int]]:
        return {"gains": ins["input"]}

    def output(self, at: Setting) -> Arrays:
        gains, f = at.state["gains"], at.inputs["input"] * cell(at.ins["input"])
        drive, whole = jnp.sum(gains * f), jnp.sum(f)
        return {
            "output": drive,
            "value": jnp.where(whole > 0, drive / jnp.where(whole > 0, whole, 1.0), 0.0),
            "gains": gains,
        }

    def advance(self, at: Setting) -> Arrays:
        speed = at.time.dt / self.tau * at.inputs["error"]
        if self.gated:
            speed = speed * jnp.maximum(at.inputs["gate"], 0.0)
        return {"gains": at.state["gains"] + speed * at.inputs["input"]}

    def learned_parameters(self, state: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        return {"start": state["gains"]}

    @classmethod
    def example(cls) -> GainAdaptation:
        return cls(gated=True, initial=0.5, name="example")
