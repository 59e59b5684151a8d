"""Dense weights that learn online."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes, Axis, cell, describe, shape, wrong_shape
from deodar.numerics.signs import Sign
from deodar.parameters import ArrayLike, Live, Rebuild, Recompile
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
        rate: speed of learning, per unit of the document's time and of the input; from 0 to the inverse of
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

    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the output")] = needed("[x]")
    rate: Annotated[float, Live("1/time", role="rate", lower=0, meaning="speed of learning")] = 0.1
    initial: Annotated[float, Live(meaning="all weights at the start")] = 0.0
    gated: Annotated[bool, Recompile(meaning="whether learning waits for the gate")] = False
    apart: Annotated[bool, Recompile(meaning="whether learning reads a port of its own")] = False
    start: Annotated[ArrayLike | None, Rebuild(meaning="weights at the start, source samples first")] = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "post", "gate", "pre")
    stateful: ClassVar[bool] = True

    def polarity(self) -> Sign:
        return "±"

    def ports(self) -> tuple[str, ...]:
        return ("input", "post", *(("gate",) if self.gated else ()), *(("pre",) if self.apart else ()))

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return {"post": tuple(self.axes), "gate": ()}.get(port, arriving)

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes), "weights": (*self.axes, *ins["input"])}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
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

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        x, w = inputs["input"], state["weights"]
        return {
            "output": cell(at.ins["input"]) * jnp.tensordot(x, w, axes=x.ndim, precision="highest"),
            "weights": jnp.moveaxis(w, range(x.ndim), range(-x.ndim, 0)),
        }

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        x, w = inputs["pre" if self.apart else "input"], state["weights"]
        speed = self.rate * jnp.maximum(inputs["gate"], 0.0) if self.gated else self.rate
        pre = x.reshape(x.shape + (1,) * len(self.axes))
        return {"weights": w + time.dt * speed * (inputs["post"] - w) * pre}

    def learned_parameters(self, state: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        return {"start": state["weights"]}

    @classmethod
    def example(cls) -> AdaptiveWeights:
        return cls([Axis("target", 0, 12, samples=13)], gated=True, apart=True, name="example")
