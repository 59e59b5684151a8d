"""A detector of change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp

import deodar as dd


@dd.register
@dataclass(frozen=True)
class Change(dd.Element):
    r"""What is new in the input: strong where something appears, silent where it stays.

    Equation:
        \tau \frac{dz}{dt} = -z + \mathrm{input}
        y(x) = \max(0, \mathrm{input}(x) - z(x))

    Parameters:
        axes: where it is defined; none: one number.
        tau: time constant; in the document's time unit, > 0.

    Ports:
        input: over `axes`.
        output: y, over `axes`.

    Reference:
        no reference
    """

    name: str = ""
    axes: Sequence[dd.Axis] = ()
    tau: Annotated[float, dd.Live("time", role="time constant", lower=1e-6)] = 100.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",)}

    def init(self, at: dd.Setting) -> dd.Arrays:
        return {"z": at.full(tuple(self.axes), 0.0)}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": jnp.maximum(0.0, at.inputs["input"] - at.state["z"])}

    def advance(self, at: dd.Setting) -> dd.Arrays:
        return {"z": dd.euler(at.state["z"], -at.state["z"] + at.inputs["input"], self.tau, at.time.dt)}
