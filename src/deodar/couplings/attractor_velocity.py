"""The velocity that attractor dynamics gives a body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import is_neutral
from deodar.numerics.axes import Axes, Axis, cell, shape
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class AttractorVelocity(Coupling):
    r"""The velocity of a body whose attractor is the position of a peak; it is 0 without a peak.

    The body reports its position p, so that its own dynamics, a limit or a push do not matter: `Attractor`
    integrates the same equation where no body does. The integral N of the input f scales the velocity. With
    `fastest` the vector is shortened and keeps its direction.

    Equation:
        N = \int f(x)\, dx
        \tau v = -\int (p - x)\, f(x)\, dx = \int x f(x)\, dx - N p

    Parameters:
        axes: the dimensions of the position; other axes of the source are integrated out. By default those of
            the source.
        tau: time scale: document time times the integral of the input, so that tau / N is the relaxation
            time; at least one step.
        fastest: largest length of v, axis units per unit of the document's time; 0: no limit.

    Ports:
        input: f, over the axes.
        position: p, one number for one axis; for several axes, an axis with one sample for each of them, in
            their order.
        output: v, with the axes of `position`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 12-15.
    """

    axes: Annotated[
        Sequence[Axis], Recompile(meaning="dimensions of the position; by default those of the source")
    ] = ()
    tau: Annotated[float, Live("time x input", role="time scale", lower=1e-9, meaning="time scale")] = 100.0
    fastest: Annotated[
        float,
        Live("axis/time", role="speed", lower=0, neutral=0.0, off=True, meaning="largest speed; 0: no limit"),
    ] = 0.0

    inputs: ClassVar[tuple[str, ...]] = ("input", "position")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "position")}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return tuple(self.axes) if port == "input" and self.axes else arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": ins["position"]}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        axes, arriving = ins["input"], shape(ins["position"])
        wanted = len(axes)
        if wanted == 0:
            yield "its input has no axes, so it has no position", "Connect a field, or state axes"
        for axis in axes:
            if axis.periodic:
                yield (
                    f"the axis {axis.name!r} is periodic, and has no mean position",
                    "Use Attractor, or an axis that is not periodic",
                )
        if wanted and arriving != (wanted,) and not (wanted == 1 and arriving == ()):
            takes = "one number" if wanted == 1 else f"one axis with {wanted} samples"
            yield (
                f"takes {takes} at its port `position`, one for each axis of its input; that has"
                f" {list(arriving)} samples",
                "Connect a position of that shape",
            )

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        axes = at.ins["input"]
        f, p = inputs["input"] * cell(axes), jnp.reshape(inputs["position"], (len(axes),))
        rates: list[Array] = []
        for d, axis in enumerate(axes):
            along = jnp.sum(f, axis=tuple(k for k in range(len(axes)) if k != d))
            # the distances are summed, not the positions, so that no digits are lost far from 0
            rates.append(jnp.sum((at.points(axis) - p[d]) * along))
        v = jnp.stack(rates) / self.tau
        if not is_neutral(self.fastest):
            length = jnp.sqrt(jnp.sum(v**2))
            v = v * jnp.minimum(1.0, self.fastest / jnp.maximum(length, jnp.finfo(at.dtype).tiny))
        return {"output": jnp.reshape(v, jnp.shape(inputs["position"]))}

    @classmethod
    def example(cls) -> AttractorVelocity:
        return cls([Axis("x", 0, 20, samples=21)], name="example")
