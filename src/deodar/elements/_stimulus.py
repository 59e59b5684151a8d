"""The contract of a stimulus: a pattern over axes, on permanently or during time windows."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from jax import Array

from deodar.element import Arrays, Element, Setting, Time
from deodar.leaves import per_axis
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.intervals import ANY, ZERO, Interval, hull, times
from deodar.numerics.windows import Window, gate
from deodar.parameters import FrozenArray, PerAxis, Recompile

NOTHING = 3.0
"""Widths beyond the end of an axis from which a Gaussian counts as absent (1 % of its height at the end)."""


@dataclass(frozen=True)
class Stimulus(Element):
    """The base class of stimuli: s(x, t), a pattern times a gate over time; subclasses define the pattern."""

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the pattern")] = ()
    windows: Annotated[Sequence[Window], Recompile(meaning="when it is on; without windows always")] = (
        dc.field(default=(), kw_only=True)
    )

    inputs: ClassVar[tuple[str, ...]] = ()
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ()}

    def pattern(self, at: Setting) -> Array:
        """The value of the stimulus over its axes while it is on."""
        raise NotImplementedError

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        for k, w in enumerate(self.windows):
            if w.stop < w.start:
                yield (
                    f"windows.{k} ends at {w.stop:g}, before it begins at {w.start:g}, so it is never on",
                    (
                        f"Write start and stop: ({w.stop:g}, {w.start:g}), or ({w.start:g},"
                        f" {w.start + w.stop:g}) if {w.stop:g} is its duration"
                    ),
                )

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        for k, w in enumerate(self.windows):
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

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        found = self.strength()
        return {"output": ANY if found == ZERO else hull(ZERO, found) if self.windows else found}

    def placed(self, width: str, ends: Sequence[str]) -> Iterator[tuple[str, str]]:
        """Warn about a center outside the axes, and about a width too small or too large for them."""
        sizes: PerAxis = getattr(self, width)
        for axis, center, size, end in zip(
            self.axes,
            per_axis(self.center, self.axes),  # type: ignore[attr-defined]
            per_axis(sizes, self.axes),
            ends,
            strict=True,
        ):
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
                    f"Use a {width} of {axis.step:g} or more, or more samples",
                )
            elif width == "sigma" and s > axis.range:
                yield (
                    (
                        f"its sigma {s:g} is larger than the axis {axis.name!r} ({axis.range:g}), so it is"
                        " nearly the same everywhere"
                    ),
                    f"Use a sigma far below {axis.range:g}, or a Boost",
                )

    def steady(self) -> bool:
        return not self.windows

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Array | None
    ) -> Arrays:
        return {"output": self.pattern(at) * gate(self.windows, time, at.dtype)}


def array_strength(values: Any, amplitude: float) -> Interval:
    """Return the smallest and largest value of an array times an amplitude; without an array, any value."""
    if not isinstance(values, FrozenArray) or not values.data.size:
        return ANY
    return times((amplitude, amplitude), (float(values.data.min()), float(values.data.max())))
