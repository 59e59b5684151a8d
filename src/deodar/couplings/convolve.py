"""The convolution with a kernel."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

from jax import Array

from deodar.element import Arrays, Convolution, Coupling, Setting, Time
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, times, total
from deodar.numerics.kernels._base import Kernel, validate_kernels
from deodar.numerics.kernels.gaussian import Gaussian
from deodar.numerics.signs import Sign, together
from deodar.parameters import Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Convolve(Coupling):
    r"""The convolution of the input with one or more kernels.

    Equation:
        y(x) = \sum_k \int k(x - x')\, \mathrm{input}(x')\, dx'

    Parameters:
        kernel: one kernel or several, summed.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 10.
    """

    kernel: Annotated[Sequence[Kernel], Recompile(meaning="kernels, summed")] = (Gaussian(),)

    linear: ClassVar[bool] = True
    convolution: ClassVar[Convolution | None] = Convolution("input", into="output")

    def polarity(self) -> Sign:
        return together(k.polarity() for k in self.kernel)

    def kernels(self) -> Sequence[Kernel]:
        return self.kernel

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        yield from validate_kernels(self.kernel, ins["input"])

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        x = inputs["input"]
        parts = [kernel.bounds(ins["input"]) for kernel in self.kernel]
        return {
            "output": total(*(times((0.0, k[1]), x) for k in parts), *(times((k[0], 0.0), x) for k in parts))
        }

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": at.convolve(inputs["input"])}
