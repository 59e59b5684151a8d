"""Hebbian weights between two fields or nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Coupling, PortAxes, Setting
from deodar.numerics import plasticity
from deodar.numerics.axes import Axes, Axis, cell, describe, shape, wrong_shape
from deodar.numerics.patches import random_weights
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import ArrayLike, Live, Rebuild, Recompile
from deodar.registry import register

MOST_PATCHES = 64
"""Largest number of patches along an axis: patch numbers have 32 bits, for up to five axes on a side."""


@register
@dataclass(frozen=True)
class Hebbian(Coupling):
    r"""Weights that associate samples of two fields or nodes which are active at the same time.

    Values up to the threshold count as 0 on both sides. Weights change only while both sides have active
    samples, so a source that is active before its target responds unlearns nothing; while one side is
    inactive, a step costs little. Weights that change are limited to `saturation`. `AdaptiveWeights` is the
    rule `outstar` without a threshold.

    The rules outstar, hebb and association, and their decay, act on weights from active samples a; instar
    and oja, and their decay, on weights to active samples b.

    Equation:
        y(b) = \int W(b, a)\, x(a)\, da
        x = \begin{cases} \mathrm{input} & \mathrm{input} > \mathrm{threshold} \\ 0 & \text{else}
            \end{cases},\quad z \text{ alike of } \mathrm{post}
        \frac{dW(b, a)}{dt} = \mathrm{gate}\, (\mathrm{rate}\, R - \mathrm{decay}\, W)
        \text{outstar:}\quad R = x(a)\, (z(b) - W)
        \text{hebb:}\quad R = x(a)\, z(b)
        \text{association:}\quad R = \begin{cases} 1 - W & a \text{ and } b \text{ active} \\ -W &
            \text{only } a \text{ active} \end{cases}
        \text{instar:}\quad R = z(b)\, (x(a) - W)
        \text{oja:}\quad R = z(b)\, (x(a) - z(b)\, W)

    Parameters:
        axes: axes of the output; none: one number.
        rule: outstar, association, hebb, instar or oja.
        rate: speed of learning; per unit of the document's time (and of input, of post, or of both, depending
            on the rule); from 0 to the inverse of the step.
        decay: decay rate of the weights that change; per unit of the document's time; from 0 to the inverse
            of the step.
        saturation: upper bound of weights that change; 0: none.
        threshold: value that active samples of input and post exceed; >= 0.
        gated: whether the element has a port `gate`; without it the gate is 1.
        apart: whether the element has a port `pre`; it takes the place of the input in learning; without it
            the input is learned. Two couplings with the same `pre`, `post`, gate and start have the same
            weights, and can be read at two places at once.
        initial: weights at the start; the largest one if they are random.
        random: whether weights at the start are uniform between 0 and `initial`; else they are `initial`
            itself.
        share: share of the patches that are connected at the start; the other weights are 0. From 0 to 1.
        patches: patches along each axis at the start; inside a patch the weights at the start are equal, if
            they are random or sparse. It makes the map at the start independent of the sampling.
        seed: seed of the weights at the start; 0 to 2^32 - 1, if they are random or sparse.
        start: weights at the start, in place of the five parameters above; for example weights learned in an
            earlier run.

    Ports:
        input: a, any axes.
        post: b, over `axes`: the activity to associate with the input.
        gate: reward, or a time window of learning; one number, only if `gated`. Values below 0 count as 0.
        pre: the activity x of the learning rule, over the axes of the input; only if `apart`.
        output: y, over `axes`; computed from the input of the same step, with the weights learned so far.
        weights: W, over `axes`, then the axes of the input.

    Shapes:
        start: samples of `axes`, then samples of the input's axes; per unit of the source's axes, as in
        `Weights`.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 12: `association`, with the thresholded sum of both
        sides as a step. As printed, all weights decay at every reward, which deletes the rest of the map;
        here only weights from active samples decay. Grossberg (1968), Proc. Natl. Acad. Sci. 59 (outstar,
        instar); Oja (1982), J. Math. Biol. 15, eq. 3; Hebb (1949), The organization of behavior.
    """

    axes: Sequence[Axis] = needed("[x]")
    rule: Annotated[str, Recompile(choices=tuple(plasticity.RULES))] = "outstar"
    rate: Annotated[float, Live("1/time", role="rate", lower=0)] = 0.01
    decay: Annotated[float, Live("1/time", role="rate", lower=0)] = 0.0
    saturation: Annotated[float, Live(lower=0)] = 0.0
    threshold: Annotated[float, Live(lower=0)] = 0.5
    gated: bool = False
    apart: bool = False
    initial: Annotated[float, Live()] = 0.0
    random: bool = False
    share: Annotated[float, Live(lower=0, upper=1)] = 1.0
    patches: Annotated[int, Recompile(lower=1, upper=MOST_PATCHES)] = 16
    seed: Annotated[int, Recompile(lower=0, upper=2**32 - 1)] = 0
    start: Annotated[ArrayLike | None, Rebuild()] = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "post", "gate", "pre")
    reads_own_output: ClassVar[tuple[str, ...]] = ("output",)
    optional: ClassVar[Mapping[str, str]] = {"gate": "gated", "pre": "apart"}

    def polarity(self) -> Sign:
        return sign_of(self.initial, self.start)

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return {"post": tuple(self.axes), "gate": ()}.get(port, arriving)

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": tuple(self.axes), "weights": (*self.axes, *ins["input"])}

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        needed = shape(self.axes) + shape(ins["input"])
        yield from wrong_shape("start", self.start, needed, "target and source have")
        if self.apart and ins["pre"] != ins["input"]:
            yield f"its axes are not those that arrive at pre, {describe(ins['pre'])}"

    def jumps_at(self) -> Sequence[str]:
        return ("threshold",) if self.threshold == 0 else (*self.ports(), "threshold")

    def init(self, at: Setting) -> Arrays:
        pre, post = shape(at.ins["input"]), shape(self.axes)
        if self.start is not None:
            given = at.array(self.start)
            return {"weights": jnp.moveaxis(given, range(len(post)), range(-len(post), 0)) if post else given}
        scale = jnp.asarray(self.initial, at.dtype)
        drawn = random_weights(
            at.ins["input"], tuple(self.axes), self.patches, self.share, self.seed, at.dtype
        )
        return {"weights": (scale * (drawn if self.random else jnp.sign(drawn))).reshape(*pre, *post)}

    def state_axes(self, ins: PortAxes) -> Mapping[str, Sequence[Axis | int]]:
        return {"weights": (*ins["input"], *self.axes)}

    def output(self, at: Setting) -> Arrays:
        pre, post = shape(at.ins["input"]), shape(self.axes)
        out = cell(at.ins["input"]) * plasticity.read(
            self._matrix(at.state["weights"], pre), self._active(at.inputs["input"])
        )
        w = at.state["weights"]
        return {
            "output": out.reshape(post),
            "weights": jnp.moveaxis(w, range(len(pre)), range(-len(pre), 0)) if pre else w,
        }

    def advance(self, at: Setting) -> Arrays:
        w, pre = at.state["weights"], shape(at.ins["input"])
        dt = at.time.dt
        step = dt * jnp.maximum(at.inputs["gate"], 0.0) if self.gated else jnp.asarray(dt, at.dtype)
        step = plasticity.after(step, at.inputs["output"])
        most = jnp.where(self.saturation > 0, self.saturation, jnp.inf).astype(at.dtype)
        x, z = self._active(at.inputs["pre" if self.apart else "input"]), self._active(at.inputs["post"])
        new = plasticity.learn(
            self.rule, self._matrix(w, pre), x, z, self.rate * step, self.decay * step, most
        )
        return {"weights": new.reshape(w.shape)}

    def learned_parameters(self, state: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        w, post = state["weights"], len(self.axes)
        return {"start": np.moveaxis(w, range(w.ndim - post, w.ndim), range(post)) if post else w}

    def _matrix(self, weights: Array, pre: tuple[int, ...]) -> Array:
        return weights.reshape(int(np.prod(pre, dtype=int)), -1)

    def _active(self, x: Array) -> Array:
        return jnp.where(x > self.threshold, x, jnp.zeros_like(x)).ravel()

    @classmethod
    def example(cls) -> Hebbian:
        target = Axis("target", 0, 12, samples=13)
        return cls(
            [target],
            gated=True,
            apart=True,
            random=True,
            initial=0.4,
            share=0.8,
            decay=0.001,
            saturation=0.7,
            threshold=0.2,
            name="example",
        )
