"""Sizes of elements as dnf-composer computes them, and the corresponding axes.

A line has the axis x, a plane the axes y and x. Samples are at 1, 2, ..., as dnf-composer counts them for
stimuli; the step is 1, since its kernels and sums never use `d_x`.
"""

from __future__ import annotations

import math

from deodar_interop.importers._axes import LengthAxes
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers.dnf_composer.file import StoredSimulation, number

NAMES = ("y", "x")

INPUT_LENGTH = 100
"""Number of input samples of a coupling whose file does not state them."""


class SampleAxes(LengthAxes):
    """The axes of a file of dnf-composer."""

    def __init__(self, simulation: StoredSimulation) -> None:
        super().__init__(NAMES, ((n, _circular(e, n)) for e in simulation.elements for n in [size(e)]))


def is_plane(e: Foreign) -> bool:
    """Return whether an element has two dimensions."""
    return e.kind.endswith("2d") or e.kind == "expand"


def size(e: Foreign) -> tuple[int, int]:
    """Return the numbers of samples along y and x; 1 where the file states no valid extent."""
    rows = samples(e, "y_max", "d_y") if is_plane(e) else 1
    return rows or 1, samples(e, "x_max", "d_x") or 1


def samples(e: Foreign, extent: str, step: str) -> int | None:
    """Return the number of samples of one dimension, extent / step, half away from zero."""
    fallback = 1 if extent == "y_max" else None
    length, d = number(e.values.get(extent, fallback)), number(e.values.get(step, 1.0))
    if length is None or d is None or not length > 0 or not d > 0 or not length / d < 1e12:
        return None
    return max(math.floor(length / d + 0.5), 1)


def input_length(e: Foreign) -> int:
    """Return the number of input samples of a coupling.

    Until 2024 the file stated it as `inputFieldSize`, which today's program ignores.
    """
    if "input_x_max" in e.values and "input_d_x" in e.values:
        return samples(e, "input_x_max", "input_d_x") or INPUT_LENGTH
    stated = number(e.values.get("inputFieldSize"))
    return INPUT_LENGTH if stated is None or not 1 <= stated < 1e12 else math.floor(stated + 0.5)


def _circular(e: Foreign, counts: tuple[int, int]) -> dict[int, bool]:
    """Return for the dimensions of an element whether it declares them circular.

    Couplings are left out: their switch is about distances among peaks, and usually not given.
    """
    circular = e.values.get("circular")
    if not isinstance(circular, bool) or "coupling" in e.kind:
        return {}
    return {d: circular for d, count in enumerate(counts) if count > 1}
