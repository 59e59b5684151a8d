"""Axes of the sizes in a file.

cedar numbers dimensions and samples from 0 and has no metric: samples are at 0, 1, 2, ... here, so that the
step is 1 and widths and integrals have cedar's values. The dimensions are called x, y, z and w in their
order; an axis of an unusual length has the length in its name, because axes of one name must agree.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from deodar.numerics.axes import MOST_SAMPLES, Axis
from deodar_interop.importers._axes import MOST_CELLS, LengthAxes, SizeLimit
from deodar_interop.importers.cedar.convolution_kernels import CedarBorder
from deodar_interop.importers.cedar.file import CedarFile, CedarStep, items
from deodar_interop.importers.cedar.values import number

NAMES = ("x", "y", "z", "w")

Counts = tuple[int, ...]
"""Samples of each dimension; () is one number."""


class SampleGrid(LengthAxes):
    """The axis of each length in a file: all of one length wrap, or none, as the kernels of most fields."""

    def __init__(self, architecture: CedarFile) -> None:
        super().__init__(NAMES, map(_declared, architecture.root.all_steps()), first=0, least=1)

    def axes(self, dims: Sequence[int]) -> tuple[Axis, ...]:
        """Return the axes of a size.

        Raises:
            SizeLimit: the size is implausibly large.
        """
        many = len(dims) > len(NAMES) or math.prod(dims) > MOST_CELLS
        if many or max(dims, default=0) > MOST_SAMPLES:
            raise SizeLimit(f"its size {list(dims)} is more than {len(NAMES)} axes or {MOST_CELLS} samples")
        return tuple(self.axis(d, n) for d, n in enumerate(dims))


def _declared(step: CedarStep) -> tuple[list[int], Mapping[int, bool]]:
    """Return the samples that a step states, and which dimensions of a field wrap."""
    stated = (number(v) for v in items(step.values.get("sizes")))
    counts = [max(int(n), 1) for n in stated if n is not None][: len(NAMES)]
    if step.short != "NeuralField":
        return counts, {}
    cyclic = CedarBorder.of(step.values.get("lateral kernel convolution"), 1).type == "Cyclic"
    return counts, dict.fromkeys(range(len(counts)), cyclic)
