"""The parameters of one element, in the notation of dnf-composer, and sizes as it computes them.

A line has the axis x, a plane the axes y and x. Samples are at 1, 2, ..., as dnf-composer counts them for
stimuli; the step is 1, since its kernels and sums never use `d_x`.
"""

from __future__ import annotations

import math
from typing import Any, cast

from deodar.numerics.kernels.separable import NARROWEST
from deodar.parameters import show
from deodar_interop.importers._axes import LengthAxes
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._values import LARGEST, ForeignValues
from deodar_interop.importers.dnf_composer.file import StoredSimulation, number

WIDEST = 1e9
"""Largest width in samples; a wider Gaussian is constant over any axis."""


class StoredValues(ForeignValues):
    """The parameter values of an element. The default of a parameter that is not in the file is reported,
    because dnf-composer refuses such a file.
    """

    def __init__(self, element: Foreign) -> None:
        super().__init__(element.values, element.label)
        self.optional: set[str] = set()

    def single(self, name: str) -> float | None:
        return number(self.body[name])

    def absent(self, name: str, default: Any) -> Any:
        if name not in self.optional:
            self.say(name, "approximated", f"it is not in the file; {show(default)} is used")
        return default

    def width(self, name: str, default: float) -> float:
        """Return the width of a Gaussian; at 0, where dnf-composer computes 0 / 0, a single sample."""
        width = self.number(name, default, 0.0, WIDEST)
        if width == 0 and name in self.body:
            self.say(name, "approximated", "a width of 0 has no values; a single sample is used")
        return max(width, NARROWEST)

    def flag(self, name: str, default: bool) -> bool:
        """Return a switch; older programs may have written it as 0 or 1."""
        if name not in self.body:
            return self.absent(name, default)
        flag = self.body[name]
        if isinstance(flag, bool):
            self.say(name)
            return flag
        if number(flag) in (0, 1):
            self.say(name, "approximated", f"it is {flag}, read as {show(bool(flag))}")
            return bool(flag)
        return self.instead(name, default)

    def choice(self, name: str, choices: tuple[str, ...]) -> str:
        """Return one of several words, which the file gives by its number; the first one is the default."""
        if name not in self.body:
            return choices[0]
        index = number(self.body[name])
        if index is None or index not in range(len(choices)):
            self.say(name, "approximated", f"it is {show(self.body[name])}; {choices[0]} is used")
            return choices[0]
        self.say(name, "carried", choices[int(index)])
        return choices[int(index)]

    def rows(self, name: str, width: int) -> list[list[float]]:
        """Return rows of `width` numbers; others are reported and left out."""
        stated = self.body.get(name)
        if stated is None or stated == {}:
            if name in self.body:
                self.say(name)
            return []
        entries = cast("list[Any]", stated) if isinstance(stated, list) else [stated]
        rows = [
            [min(max(v, -LARGEST), LARGEST) for n in cast("list[Any]", row) if (v := number(n)) is not None]
            for row in entries
            if isinstance(row, list) and len(cast("list[Any]", row)) == width
        ]
        good = [row for row in rows if len(row) == width]
        lost = len(entries) - len(good)
        if lost:
            why = f"{lost} of {len(entries)} entries are not {width} numbers, and are left out"
            self.say(name, "approximated" if good else "dropped", why)
        else:
            self.say(name)
        return good


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
