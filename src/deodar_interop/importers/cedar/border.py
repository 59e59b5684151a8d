"""What lies beyond the ends of an array that is convolved."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

from deodar.numerics.axes import Axis
from deodar_interop.importers.cedar.file import members, text
from deodar_interop.importers.cedar.values import StepValues

BORDERS = ("Zero", "Cyclic", "Replicate", "Reflect")
ENDS = {"Zero": "zero", "Cyclic": "periodic", "Reflect": "reflect", "Replicate": "replicate"}
FASTEST = "cedar.aux.conv.FFTW"


@dc.dataclass(frozen=True)
class CedarBorder:
    """What lies beyond the ends of a convolved array, and cedar's centre of a kernel of even size."""

    type: str = "Zero"
    fourier: bool = False
    later: bool = False

    @classmethod
    def of(cls, body: Any, dimensions: int) -> CedarBorder:
        """Return the border of a convolution object; FFTW is cyclic whatever the object states."""
        values = members(body)
        fourier = text(members(values.get("engine")).get("type")) == FASTEST or dimensions > 2
        stated = text(values.get("borderType"))
        kind = "Cyclic" if fourier else stated if stated in BORDERS else "Zero"
        later = fourier or text(values.get("alternate even kernel center")) == "true"
        return cls(kind, fourier, later)

    def ends(self, axes: Sequence[Axis]) -> list[str] | None:
        """Return the boundary of each axis; None if it is that of the axes themselves."""
        axis_ends = ["periodic" if a.periodic else "zero" for a in axes]
        kernel_ends = [ENDS[self.type]] * len(axes)
        return None if axis_ends == kernel_ends else kernel_ends


def border(values: StepValues, name: str, dimensions: int) -> CedarBorder:
    """Read a convolution object, with report lines."""
    convolution = CedarBorder.of(values.body.get(name), dimensions)
    if name not in values.body:
        return convolution
    inside = values.inside(name)
    stated = inside.word("borderType", "Zero", BORDERS)
    if convolution.type != stated:
        who = "FFTW" if dimensions <= 2 else "FFTW, which cedar takes from three dimensions on,"
        inside.say("borderType", "carried", f"{who} is always cyclic")
    inside.word("mode", "Same", ("Same",))
    inside.say("engine")
    if "alternate even kernel center" in inside.body:
        inside.flag("alternate even kernel center", False)
    values.say(name)
    return convolution
