"""The convolution with a kernel that is an input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.leaves import per_axis
from deodar.numerics.axes import Axes, Axis, cell, describe
from deodar.numerics.convolution import BOUNDARIES, boundaries
from deodar.numerics.intervals import Interval, times
from deodar.parameters import PerAxis, Recompile
from deodar.registry import register

PADDED = {"periodic": "wrap", "zero": "constant", "reflect": "symmetric", "replicate": "edge"}
"""How arrays are continued beyond their ends, in the words of `jnp.pad`."""


@register
@dataclass(frozen=True)
class SteeredConvolve(Coupling):
    r"""A convolution whose kernel is itself an input: a kernel that is learned, or a population of shifts.

    A kernel with a single peak at s shifts the input by s, and blurs it by the width of the peak; a flat
    kernel over all shifts blurs it entirely. `SteeredShift` shifts by one number, and `Convolve` has fixed
    kernels. The time of a step grows with the samples of the input times those of the kernel.

    Equation:
        y(x) = \int \mathrm{kernel}(\mathrm{origin} + s)\, \mathrm{input}(x - s)\, ds

    Parameters:
        origin: position on the axes of the kernel at which s is 0, one value or one for each axis; the
            nearest sample is used.
        boundary: what lies beyond the ends of the input: `periodic`, `zero`, `reflect` (its mirror image) or
            `replicate` (its outermost value); one for all axes or one for each. None: the axis decides.

    Ports:
        input: any axes.
        kernel: as many axes as `input`, of equal steps in the same order; names and numbers of samples may
            differ.
        output: the axes of `input`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 10, with a kernel that is an
        input.
    """

    origin: Annotated[PerAxis, Recompile("axis", meaning="where on the kernel's axes the shift is 0")] = 0.0
    boundary: Annotated[
        Sequence[str] | None,
        Recompile(
            choices=BOUNDARIES,
            meaning="what lies beyond the border, one for all axes or one for each; none: the axis decides",
        ),
    ] = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "kernel")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "kernel")}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        here, there = ins["input"], ins["kernel"]
        if len(here) != len(there):
            yield f"its kernel is over {describe(there)}, not one axis for each axis of the input"
            return
        if not np.allclose([a.step for a in here], [k.step for k in there], rtol=1e-6, atol=0.0):
            yield f"its kernel over {describe(there)} has other steps than its input over {describe(here)}"
        if self.boundary is not None and len(self.boundary) not in (1, len(here)):
            yield (
                f"has {len(self.boundary)} boundaries for {len(here)} axes",
                "Give one, or one for each axis",
            )

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        size = cell(ins["kernel"]) * float(np.prod([a.samples for a in ins["kernel"]]))
        low, high = times((size, size), times(inputs["input"], inputs["kernel"]))
        return {"output": (min(low, 0.0), max(high, 0.0))}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        y, kernel = inputs["input"], inputs["kernel"]
        axes, places = at.ins["input"], at.ins["kernel"]
        if not axes:
            return {"output": y * kernel}
        origin = per_axis(self.origin, places)
        ends = boundaries(self.boundary, axes)
        for d, (place, boundary) in enumerate(zip(places, ends, strict=True)):
            y = _extended(y, d, place, float(origin[d]), boundary)
        y = lax.conv_general_dilated(
            y[None, None],
            jnp.flip(kernel)[None, None],
            window_strides=(1,) * len(axes),
            padding="VALID",
            precision=lax.Precision.HIGHEST,
        )[0, 0]
        return {"output": cell(places) * y}


def _extended(y: Array, d: int, place: Axis, origin: float, boundary: str) -> Array:
    """Return an array with all values along an axis that a kernel reads: n + m - 1 for m samples of the
    kernel.
    """
    n, m = y.shape[d], place.samples
    centre = round((origin - place.lower) / place.step)
    widths = [(0, 0)] * y.ndim
    widths[d] = (max(m - 1 - centre, 0), max(centre, 0))
    y = jnp.pad(y, widths, mode=PADDED[boundary])  # pyright: ignore[reportArgumentType]
    return lax.slice_in_dim(y, max(centre - m + 1, 0), max(centre - m + 1, 0) + n + m - 1, axis=d)
