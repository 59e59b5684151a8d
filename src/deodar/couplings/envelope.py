"""The envelope of two signals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval
from deodar.parameters import Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Envelope(Coupling):
    r"""The larger, or the smaller, of two signals at each sample; with a Boost a limit.

    Each port sums all connections into it.

    Equation:
        \text{upper:}\quad y(x) = \max(\mathrm{input}(x), \mathrm{other}(x))
        \text{lower:}\quad y(x) = \min(\mathrm{input}(x), \mathrm{other}(x))

    Parameters:
        side: `upper` or `lower`.

    Ports:
        input: any axes.
        other: the axes of `input`; one number is compared with all samples.
        output: the axes of `input`.

    Reference:
        no reference
    """

    side: Annotated[str, Recompile(choices=("upper", "lower"), meaning="which of both")] = "upper"

    inputs: ClassVar[tuple[str, ...]] = ("input", "other")
    follows: ClassVar[Mapping[str, str]] = {"other": "input"}
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "other")}

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        (a, b), (c, d) = inputs["input"], inputs["other"]
        return {"output": (max(a, c), max(b, d)) if self.side == "upper" else (min(a, c), min(b, d))}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        choose = jnp.maximum if self.side == "upper" else jnp.minimum
        return {"output": choose(inputs["input"], inputs["other"])}
