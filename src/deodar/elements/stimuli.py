"""Stimuli: a pattern over axes, on permanently or during time windows."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Element, PortAxes, PortBounds, Setting
from deodar.errors import assign
from deodar.leaves import per_axis, with_entry
from deodar.numerics import starting
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.numerics.convolution import boundaries
from deodar.numerics.intervals import ANY, ZERO, Interval, hull, signed, times
from deodar.numerics.windows import Window, gate
from deodar.parameters import ArrayLike, FrozenArray, Live, PeakBoundary, PerAxis, Rebuild, Recompile
from deodar.registry import register

NOTHING = 3.0
"""Widths beyond the end of an axis from which a Gaussian counts as absent (1 % of its height at the end)."""


@dataclass(frozen=True)
class Stimulus(Element):
    """The base class of stimuli: s(x, t), a pattern times a gate over time; subclasses define the pattern.

    The gate is open in the windows: without windows (None) always, and with an empty list never.
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    windows: Annotated[Sequence[Window] | None, Recompile(if_none="always", if_empty="never")] = dc.field(
        default=None, kw_only=True
    )

    inputs: ClassVar[tuple[str, ...]] = ()

    def pattern(self, at: Setting) -> Array:
        """The value of the stimulus over its axes while it is on."""
        raise NotImplementedError

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        for k, w in enumerate(self.windows or ()):
            if w.stop < w.start:
                yield (
                    f"windows.{k} ends at {w.stop:g}, before it begins at {w.start:g}, so it is never on",
                    (
                        f"Write start and stop: ({w.stop:g}, {w.start:g}), or ({w.start:g},"
                        f" {w.start + w.stop:g}) if {w.stop:g} is its duration"
                    ),
                )

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        for k, w in enumerate(self.windows or ()):
            if w.stop == w.start:
                yield (
                    f"windows.{k} begins and ends at {w.start:g}, so it is never on",
                    "Give it a stop after its start, or leave it out",
                )

    def strength(self) -> Interval:
        """The smallest and largest value of the pattern.

        (0, 0) means that the amplitude is not set yet; `bounds` then assumes any value.
        """
        return ANY

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        found = self.strength()
        return {"output": ANY if found == ZERO else found if self.windows is None else hull(ZERO, found)}

    def placed(self, width: str, ends: Sequence[str]) -> Iterator[tuple[str, str]]:
        """Warn about a center outside the axes, and about a width too small or too large for them."""
        sizes: PerAxis = getattr(self, width)
        every = zip(
            self.axes,
            per_axis(self.center, self.axes),  # type: ignore[attr-defined]
            per_axis(sizes, self.axes),
            ends,
            strict=True,
        )
        for d, (axis, center, size, end) in enumerate(every):
            c, s = float(center), float(size)
            far = NOTHING * s if width == "sigma" else s / 2
            if (
                end != "periodic"
                and not axis.lower - far - axis.step / 2 <= c <= axis.upper + far + axis.step / 2
            ):
                yield (
                    (
                        f"its center {c:g} lies outside the axis {axis.name!r}"
                        f" ({axis.lower:g}..{axis.upper:g}), so its output is nearly 0"
                    ),
                    f"Use a center between {axis.lower:g} and {axis.upper:g}; it is in units of the axis",
                )
            elif s < (0.5 if width == "sigma" else 1) * axis.step:
                yield (
                    (
                        f"its {width} {s:g} is smaller than the step {axis.step:g} of the axis {axis.name!r}:"
                        " how strong it is depends on where it lies"
                    ),
                    assign(
                        f"Use a {width} of {axis.step:g} or more",
                        {width: with_entry(sizes, self.axes, d, axis.step)},
                        "Or take more samples",
                    ),
                )
            elif width == "sigma" and s > axis.range:
                yield (
                    (
                        f"its sigma {s:g} is larger than the axis {axis.name!r} ({axis.range:g}), so it is"
                        " nearly the same everywhere"
                    ),
                    assign(
                        f"Use a sigma far below {axis.range:g}",
                        {width: with_entry(sizes, self.axes, d, axis.range / 10)},
                        "Or take a Boost",
                    ),
                )

    def steady(self) -> bool:
        return not self.windows

    def output(self, at: Setting) -> Arrays:
        return {"output": self.pattern(at) * gate(self.windows, at.time, at.dtype)}


def array_strength(values: Any, amplitude: float) -> Interval:
    """Return the smallest and largest value of an array times an amplitude; without an array, any value."""
    if not isinstance(values, FrozenArray) or not values.data.size:
        return ANY
    return times((amplitude, amplitude), (float(values.data.min()), float(values.data.max())))


@register
@dataclass(frozen=True)
class Boost(Stimulus):
    r"""A homogeneous input that moves a field or node closer to its detection instability.

    Equation:
        s(x) = \mathrm{amplitude}

    Parameters:
        axes: axes of the stimulus; none: a constant, which expands along the axes of any target.
        amplitude: value at every sample.
        windows: when it is on; pairs (start, stop) in the document's time unit; none: always; []: never.

    Ports:
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 7 (the boost of a field by a
        node).
    """

    amplitude: Annotated[float, Live("activation")] = 1.0

    signed_by: ClassVar[tuple[str, ...]] = ("amplitude",)

    def strength(self) -> Interval:
        return self.amplitude, self.amplitude

    def pattern(self, at: Setting) -> Array:
        return jnp.broadcast_to(jnp.asarray(self.amplitude, at.dtype), shape(self.axes))


@register
@dataclass(frozen=True)
class GaussianStimulus(Stimulus):
    r"""A Gaussian input, localised around one position.

    On an axis that wraps, the distance is the shorter one. If normalized, the Gaussian is divided by its sum
    over all samples times the grid steps.

    Equation:
        s(x) = \mathrm{amplitude} \exp\!\left( -\sum_i \frac{(x_i - \mathrm{center}_i)^2}{2
            \sigma_i^2} \right)

    Parameters:
        axes: axes of the stimulus; none: a constant for a node.
        center: position of the maximum; in axis units, one value or one for each axis.
        sigma: width; in axis units, one value or one for each axis, > 0.
        amplitude: value at the centre; if normalized, the integral.
        windows: when it is on; pairs (start, stop) in the document's time unit; none: always; []: never.
        normalized: whether the amplitude is the integral.
        boundary: whether it wraps around the ends; `periodic` (the Gaussian wraps around the ends) or `zero`
            (it does not), one value or one for each axis; none: periodic on periodic axes.

    Ports:
        output: over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    center: Annotated[PerAxis, Live("axis")] = 0.0
    sigma: Annotated[PerAxis, Live("axis", lower=1e-6)] = 5.0
    amplitude: Annotated[float, Live("activation")] = 1.0
    normalized: bool = dc.field(default=False, kw_only=True)
    boundary: PeakBoundary = dc.field(default=None, kw_only=True)

    signed_by: ClassVar[tuple[str, ...]] = ("amplitude",)

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return starting.bump(axes, "sigma")

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        yield from super().validate_axes(ins)
        if self.boundary is not None and len(self.boundary) not in (1, len(self.axes)):
            yield f"boundary has {len(self.boundary)} entries for {len(self.axes)} axes"

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from super().warnings(ins)
        yield from self.placed("sigma", boundaries(self.boundary, tuple(self.axes)))

    def strength(self) -> Interval:
        return ANY if self.normalized else signed(self.amplitude)

    def pattern(self, at: Setting) -> Array:
        y = self.amplitude * jnp.ones((), at.dtype)
        centers, sigmas = per_axis(self.center, self.axes), per_axis(self.sigma, self.axes)
        ends = boundaries(self.boundary, tuple(self.axes))
        for axis, center, sigma, end in zip(self.axes, centers, sigmas, ends, strict=True):
            distance = at.points(axis) - center
            if end == "periodic":
                length = axis.step * axis.samples
                distance = distance - length * jnp.round(distance / length)
            factor = jnp.exp(-0.5 * (distance / sigma) ** 2)
            # a Gaussian between two samples and far narrower than their distance stays zero
            if self.normalized:
                whole = jnp.sum(factor) * axis.step
                factor = factor / jnp.where(whole > 0, whole, 1.0)
            y = y[..., None] * factor
        return y


@register
@dataclass(frozen=True)
class BoxStimulus(Stimulus):
    r"""A constant input inside a box and 0 outside.

    A cell that is partly inside the box gets the amplitude times the part of its width that is inside.

    Equation:
        s(x) = \begin{cases} \mathrm{amplitude} & |x_i - \mathrm{center}_i| <
            \frac{\mathrm{width}_i}{2} \ \forall i \\ 0 & \text{else} \end{cases}

    Parameters:
        axes: axes of the stimulus; none: a constant for a node.
        center: middle of the box; in axis units, one value or one for each axis.
        width: full width; in axis units, one value or one for each axis, > 0.
        amplitude: value inside.
        windows: when it is on; pairs (start, stop) in the document's time unit; none: always; []: never.

    Ports:
        output: over `axes`.

    Reference:
        no reference
    """

    center: Annotated[PerAxis, Live("axis")] = 0.0
    width: Annotated[PerAxis, Live("axis", lower=1e-6)] = 10.0
    amplitude: Annotated[float, Live("activation")] = 1.0

    signed_by: ClassVar[tuple[str, ...]] = ("amplitude",)

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return starting.bump(axes, "width", 2)

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from super().warnings(ins)
        yield from self.placed("width", boundaries(None, tuple(self.axes)))

    def strength(self) -> Interval:
        return signed(self.amplitude)

    def pattern(self, at: Setting) -> Array:
        y = self.amplitude * jnp.ones((), at.dtype)
        centers, widths = per_axis(self.center, self.axes), per_axis(self.width, self.axes)
        for axis, center, width in zip(self.axes, centers, widths, strict=True):
            distance = at.points(axis) - center
            if axis.periodic:
                distance = distance - axis.range * jnp.round(distance / axis.range)
            upper = jnp.minimum(distance + axis.step / 2, width / 2)
            lower = jnp.maximum(distance - axis.step / 2, -width / 2)
            y = y[..., None] * jnp.maximum(0.0, upper - lower) / axis.step
        return y


@register
@dataclass(frozen=True)
class Pattern(Stimulus):
    r"""An input defined by an array, one value for each sample.

    Equation:
        s(x) = \mathrm{amplitude} \cdot \mathrm{values}(x)

    Parameters:
        axes: axes of the stimulus; none: a constant for a node.
        values: one value for each sample of the axes.
        amplitude: factor.
        windows: when it is on; pairs (start, stop) in the document's time unit; none: always; []: never.

    Ports:
        output: over `axes`.

    Shapes:
        values: the samples of `axes`, in their order.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    axes: Sequence[Axis] = needed("[x]")
    values: Annotated[ArrayLike, Rebuild("activation")] = FrozenArray([float(k % 7 == 3) for k in range(21)])
    amplitude: Annotated[float, Live()] = 1.0

    signed_by: ClassVar[tuple[str, ...]] = ("values", "amplitude")

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return {"values": FrozenArray(starting.hill(axes)), "amplitude": starting.STRENGTH}

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        yield from super().validate_axes(ins)
        yield from wrong_shape("values", self.values, shape(self.axes))

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from super().warnings(ins)
        if isinstance(self.values, FrozenArray) and not self.values.data.any():
            yield (
                "its values are all zero, so it gives nothing",
                "Give it the values that it should show, or remove it",
            )

    def strength(self) -> Interval:
        return array_strength(self.values, self.amplitude)

    def pattern(self, at: Setting) -> Array:
        return self.amplitude * jnp.broadcast_to(at.array(self.values), shape(self.axes))
