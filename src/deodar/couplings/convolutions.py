"""Couplings that convolve a signal, or shift it, over its own axes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.element import Arrays, Convolution, Coupling, PortAxes, PortBounds, Setting
from deodar.errors import did_you_mean
from deodar.leaves import per_axis
from deodar.numerics import interaction, resampling
from deodar.numerics.axes import Axes, Axis, cell, describe, shape
from deodar.numerics.convolution import BOUNDARIES, boundaries
from deodar.numerics.interaction import KernelWeights, Mixture
from deodar.numerics.intervals import ZERO, hull, times, total
from deodar.numerics.kernels._base import Kernel, validate_kernels
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.positions import PositionCode
from deodar.numerics.signs import Sign, together
from deodar.parameters import Live, PerAxis, Rebuild, Recompile
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

    kernel: Sequence[Kernel] = (Gaussian(),)

    linear: ClassVar[bool] = True
    convolution: ClassVar[Convolution | None] = Convolution("input", into="output")

    def polarity(self) -> Sign:
        return together(k.polarity() for k in self.kernel)

    def kernels(self) -> Sequence[Kernel]:
        return self.kernel

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        yield from validate_kernels(self.kernel, ins["input"])

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        x = inputs["input"]
        parts = [kernel.bounds(ins["input"]) for kernel in self.kernel]
        return {
            "output": total(*(times((0.0, k[1]), x) for k in parts), *(times((k[0], 0.0), x) for k in parts))
        }

    def output(self, at: Setting) -> Arrays:
        return {"output": at.convolve(at.inputs["input"])}


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
        origin: position on the axes of the kernel at which s is 0; one value or one for each axis; the
            nearest sample is used.
        boundary: what lies beyond the ends of the input; `periodic`, `zero`, `reflect` (its mirror image) or
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

    origin: Annotated[PerAxis, Recompile("axis")] = 0.0
    boundary: Annotated[Sequence[str] | None, Recompile(choices=BOUNDARIES)] = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "kernel")

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
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

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        size = cell(ins["kernel"]) * float(np.prod([a.samples for a in ins["kernel"]]))
        low, high = times((size, size), times(inputs["input"], inputs["kernel"]))
        return {"output": (min(low, 0.0), max(high, 0.0))}

    def output(self, at: Setting) -> Arrays:
        y, kernel = at.inputs["input"], at.inputs["kernel"]
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

    kernel: Sequence[Kernel] = (Gaussian(),)
    global_inhibition: Annotated[float, Live("activation")] = 0.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "total": ("input",)}
    linear: ClassVar[bool] = True

    def polarity(self) -> Sign:
        inhibition: list[Sign] = ["-"] if self.global_inhibition > 0 else []
        return together([*(k.polarity() for k in self.kernel), *inhibition])

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": ins["input"], "total": ()}

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        yield from validate_kernels(self.kernel, ins["input"])

    def prepare(self, at: Setting) -> dict[str, list[KernelWeights]]:
        return {"kernel": interaction.prepare(self.kernel, at.ins["input"], at.dtype)}

    def hoist(self, at: Setting) -> dict[str, Mixture]:
        return {"kernel": interaction.mix(self.kernel, at.ins["input"], at.constants["kernel"])}

    def output(self, at: Setting) -> Arrays:
        x, axes = at.inputs["input"], at.ins["input"]
        total = cell(axes) * jnp.sum(x)
        return {
            "output": interaction.apply(at.constants["kernel"], axes, x) - self.global_inhibition * total,
            "total": total,
        }


@register
@dataclass(frozen=True)
class Shift(Coupling):
    r"""A shift of the input by a fixed amount: a peak at x arrives at x + amount.

    Values between samples are interpolated linearly; an axis that is not periodic is padded with 0.

    Equation:
        y(x) = \mathrm{input}(x - \mathrm{amount})

    Parameters:
        amount: the shift; in axis units, one value or one for each axis.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), appendix
        A (the plain shifts between its fields).
    """

    amount: Annotated[PerAxis, Rebuild("axis")] = 0.0

    linear: ClassVar[bool] = True

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        for a, amount in zip(ins["input"], per_axis(self.amount, ins["input"]), strict=True):
            if not a.periodic and abs(float(amount)) > a.range:
                what = (
                    f"its amount {float(amount):g} is longer than the axis {a.name!r} ({a.range:g}), so"
                    " everything is shifted out and it gives 0"
                )
                yield what, f"Use an amount below {a.range:g}, or a periodic axis"

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": hull(ZERO, inputs["input"])}

    def prepare(self, at: Setting) -> list[tuple[Array, Array]]:
        axes = at.ins["input"]
        return [
            resampling.steps(a, amount, at.dtype)
            for a, amount in zip(axes, per_axis(self.amount, axes), strict=True)
        ]

    def output(self, at: Setting) -> Arrays:
        y = at.inputs["input"]
        for d, (axis, (whole, part)) in enumerate(zip(at.ins["input"], at.constants, strict=True)):
            y = resampling.shifted(y, d, axis.periodic, whole, part)
        return {"output": y}


@register
@dataclass(frozen=True)
class SteeredShift(Coupling):
    r"""A shift of the input by an amount that is itself an input, for changes of reference frame.

    Values between samples are interpolated linearly; an axis that is not periodic is padded with 0.

    Equation:
        y(x) = \mathrm{input}(x - a)
        a_i = \mathrm{gain}\, \mathrm{by}_i + \mathrm{offset}

    Parameters:
        along: names of the axes along which the input is shifted; at least one.
        gain: axis units per unit of `by`; a negative gain shifts in the opposite direction.
        offset: shift for a `by` of 0, in axis units.

    Ports:
        input: any axes, including those of `along`.
        by: one number for one axis; for several axes, an axis with one sample for each of them, in their
            order. If each axis needs its own source or gain, connect several SteeredShifts in series.
        output: the axes of `input`.

    Reference:
        Schneegans & Schöner (2012), A neural mechanism for coordinate transformation predicts pre-saccadic
        remapping, Biol. Cybern. 106, 89-109 (the map that its transformation field computes: retinal
        position and gaze direction to position in the world).
    """

    along: Sequence[str] = ("x",)
    gain: Annotated[float, Live()] = 1.0
    offset: Annotated[float, Live("axis")] = 0.0

    inputs: ClassVar[tuple[str, ...]] = ("input", "by")

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.along:
            yield "along", "is empty; name at least one axis of the input"
        if len(set(self.along)) < len(self.along):
            yield "along", f"contains a name twice: {', '.join(self.along)}"

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return () if port == "by" and len(self.along) == 1 else arriving

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        known, arriving = [a.name for a in ins["input"]], shape(ins["by"])
        for name in self.along:
            if name not in known:
                yield (
                    f"shifts along {name!r}, and its input has no such axis",
                    did_you_mean(name, known) or "Give it an input that has this axis",
                )
        if len(self.along) > 1 and arriving != (len(self.along),):
            takes = f"one axis with {len(self.along)} samples, one for each of {', '.join(self.along)}"
            yield (
                f"takes {takes} at its port 'by'; its input has {list(arriving)} samples",
                "Connect such an input, or use several SteeredShifts in series",
            )

    def position_codes(self, ins: PortAxes) -> Mapping[str, PositionCode]:
        known = {a.name: a for a in ins["input"]}
        axes = tuple(known[name] for name in self.along if name in known)
        return {"by": PositionCode(axes, (self.gain,) * len(axes))}

    def output(self, at: Setting) -> Arrays:
        y, names = at.inputs["input"], [a.name for a in at.ins["input"]]
        amounts = jnp.reshape(at.inputs["by"], (len(self.along),))
        for k, name in enumerate(self.along):
            d = names.index(name)
            axis = at.ins["input"][d]
            whole, part = resampling.steps(axis, self.gain * amounts[k] + self.offset, at.dtype)
            y = resampling.shifted(y, d, axis.periodic, whole, part)
        return {"output": y}
