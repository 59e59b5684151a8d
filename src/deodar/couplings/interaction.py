"""The lateral interaction of a field, as a coupling."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics import interaction
from deodar.numerics.axes import Axes, cell
from deodar.numerics.interaction import KernelWeights, Mixture
from deodar.numerics.kernels._base import Kernel, validate_kernels
from deodar.numerics.kernels.gaussian import Gaussian
from deodar.numerics.signs import Sign, together
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Interaction(Coupling):
    r"""The interaction of a field (kernels and global inhibition) as a coupling between fields.

    Equation:
        y(x) = \sum_k \int k(x - x')\, \mathrm{input}(x')\, dx'
        \quad {} - c \int \mathrm{input}(x')\, dx'

    Parameters:
        kernel: one kernel or several, summed.
        global_inhibition: c, factor of the integral of the input.

    Ports:
        input: any axes.
        output: the same axes.
        total: the integral of the input, one number.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (its integrals).
    """

    kernel: Annotated[Sequence[Kernel], Recompile(meaning="kernels, summed")] = (Gaussian(),)
    global_inhibition: Annotated[
        float, Live("activation", meaning="inhibition by the integral of the input")
    ] = 0.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "total": ("input",)}
    linear: ClassVar[bool] = True

    def polarity(self) -> Sign:
        inhibition: list[Sign] = ["-"] if self.global_inhibition > 0 else []
        return together([*(k.polarity() for k in self.kernel), *inhibition])

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": ins["input"], "total": ()}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        yield from validate_kernels(self.kernel, ins["input"])

    def prepare(self, at: Setting) -> dict[str, list[KernelWeights]]:
        return {"kernel": interaction.prepare(self.kernel, at.ins["input"], at.dtype)}

    def hoist(self, at: Setting, constants: dict[str, list[KernelWeights]]) -> dict[str, Mixture]:
        return {"kernel": interaction.mix(self.kernel, at.ins["input"], constants["kernel"])}

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: dict[str, Mixture],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        x, axes = inputs["input"], at.ins["input"]
        total = cell(axes) * jnp.sum(x)
        return {
            "output": interaction.apply(constants["kernel"], axes, x) - self.global_inhibition * total,
            "total": total,
        }
