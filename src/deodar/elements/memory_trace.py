"""The memory trace."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp

from deodar.element import Arrays, Element, Setting, Time
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class MemoryTrace(Element):
    """A slow trace of where activation has been, which preshapes the field that made it. It decays only while something else is active.

    Equation:
        where input > threshold: dp/dt = (input - p) / tau_build; elsewhere dp/dt = -p / tau_decay;
        dp/dt = 0 as long as no input is above the threshold.

    Parameters:
        axes: the metric dimensions; none: one number.
        tau_build: time constant of the build-up, in the document's time unit; > 0.
        tau_decay: time constant of the decay, in the document's time unit; > 0.
        threshold: input above which a place is active.

    Ports:
        input: over `axes`; usually the output of a field.
        output: p, over `axes`.
        active: 1 where the input of the step before was above the threshold, over `axes`.

    Reference:
        Lipinski, Simmering, Johnson & Spencer (2010), The role of experience in location estimation, Psychon. Bull. Rev. 17
        (memory traces that grow below peaks and decay between them); Erlhagen & Schöner (2002), Psychol. Rev. 109 (preshape).
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="metric dimensions")] = ()
    tau_build: Annotated[float, Live("time", lower=1e-6, meaning="time constant of the build-up")] = 100.0
    tau_decay: Annotated[float, Live("time", lower=1e-6, meaning="time constant of the decay")] = 1000.0
    threshold: Annotated[float, Live(meaning="input above which a place is active")] = 0.5

    stateful: ClassVar[bool] = True

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes), "active": tuple(self.axes)}

    def init(self, at: Setting) -> Arrays:
        return {"trace": at.full(tuple(self.axes), 0.0), "active": at.full(tuple(self.axes), 0.0)}

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        return {"output": state["trace"], "active": state["active"]}

    def advance(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        p, x = state["trace"], inputs["input"]
        active = x > self.threshold
        rate = jnp.where(active, (x - p) / self.tau_build, -p / self.tau_decay)
        return {"trace": p + time.dt * jnp.where(jnp.any(active), rate, 0.0), "active": active.astype(p.dtype)}
