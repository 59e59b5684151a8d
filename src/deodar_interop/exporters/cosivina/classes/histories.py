"""Elements that store their input."""

from __future__ import annotations

import numpy as np

from deodar.elements.memories import History, SampledHistory
from deodar.numerics.axes import Axis
from deodar.numerics.windows import FOR_EVER
from deodar.parameters import FrozenArray
from deodar_interop.exporters.cosivina.draft import FilePart, Given
from deodar_interop.exporters.cosivina.layout import layout
from deodar_interop.importers._piece import Dims
from deodar_interop.importers.cosivina.classes.fields import MOST_COUNTED


def running(b: Given, element: History) -> None:
    """Write RunningHistory."""
    values = {"timeSlots": element.slots.samples, "interval": element.interval}
    part = b.sized("RunningHistory", values, layout(tuple(element.axes)))
    _stored(b, part, element.slots, layout(tuple(element.axes)), element.empty)


def sampled(b: Given, element: SampledHistory) -> None:
    """Write History, with the times as cosivina counts them."""
    times = np.asarray(element.times.data if isinstance(element.times, FrozenArray) else [], np.float64)
    start, step = b.draft.start, b.draft.step
    ticks = np.round((times.reshape(-1) - start) / step)
    reached = ticks < FOR_EVER / step / 2
    last = int(max(ticks[reached], default=0))
    counted = np.add.accumulate([start, *[step] * min(last, MOST_COUNTED)])
    found = [
        start - step  # a time that no step reaches
        if not there or tick < 1
        else float(counted[int(tick)])
        if tick < len(counted)
        else float(start + tick * step)
        for tick, there in zip(ticks, reached, strict=True)
    ]
    part = b.sized("History", {"storingTimes": found}, layout(tuple(element.axes)))
    _stored(b, part, element.slots, layout(tuple(element.axes)), element.empty)


def _stored(b: Given, part: FilePart, slots: Axis, dims: Dims, empty: str) -> None:
    """Show what is stored: the slots are the rows of a row, and the last dimension of a plane."""
    kept = None if slots.samples == 1 else slots
    there: Dims = (kept, dims[1]) if dims[0] is None else dims if kept is None else (*dims, kept)
    if b.draft.readers(b.id) and empty == "zero":
        b.say("empty", "approximated", "cosivina has NaN there")
        b.approximate("cosivina has NaN where nothing is stored yet, and fields that read it stay undefined")
    b.take(part)
    b.show(part, dims=there)


KINDS = {History: running, SampledHistory: sampled}
