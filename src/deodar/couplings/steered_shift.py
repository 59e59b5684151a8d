"""The shift by an amount that is an input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.errors import did_you_mean
from deodar.numerics import resampling
from deodar.numerics.axes import Axes, shape
from deodar.numerics.positions import PositionCode
from deodar.parameters import Live, Recompile
from deodar.registry import register


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

    along: Annotated[Sequence[str], Recompile(meaning="names of the axes along which it shifts")] = ("x",)
    gain: Annotated[float, Live(meaning="axis units per unit of the steering input")] = 1.0
    offset: Annotated[float, Live("axis", meaning="shift where the steering input is 0")] = 0.0

    inputs: ClassVar[tuple[str, ...]] = ("input", "by")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "by")}

    def validate(self) -> Iterator[tuple[str, str]]:
        if not self.along:
            yield "along", "is empty; name at least one axis of the input"
        if len(set(self.along)) < len(self.along):
            yield "along", f"contains a name twice: {', '.join(self.along)}"

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return () if port == "by" and len(self.along) == 1 else arriving

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
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
                f"takes {takes} at its port `by`; its input has {list(arriving)} samples",
                "Connect such an input, or use several SteeredShifts in series",
            )

    def position_codes(self, ins: Mapping[str, Axes]) -> Mapping[str, PositionCode]:
        known = {a.name: a for a in ins["input"]}
        axes = tuple(known[name] for name in self.along if name in known)
        return {"by": PositionCode(axes, (self.gain,) * len(axes))}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        y, names = inputs["input"], [a.name for a in at.ins["input"]]
        amounts = jnp.reshape(inputs["by"], (len(self.along),))
        for k, name in enumerate(self.along):
            d = names.index(name)
            axis = at.ins["input"][d]
            whole, part = resampling.steps(axis, self.gain * amounts[k] + self.offset, at.dtype)
            y = resampling.shifted(y, d, axis.periodic, whole, part)
        return {"output": y}
