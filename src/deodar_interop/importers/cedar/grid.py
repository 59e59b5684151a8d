"""Axes of the sizes in a file.

cedar numbers dimensions and samples from 0 and has no metric: samples are at 0, 1, 2, ... here, so that the
step is 1 and widths and integrals have cedar's values. The dimensions are called x, y, z and w in their
order; an axis of an unusual length has the length in its name, because axes of one name must agree.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from deodar.numerics.axes import MOST_SAMPLES, Axis
from deodar_interop.importers.cedar.border import CedarBorder
from deodar_interop.importers.cedar.file import CedarFile, CedarStep, items
from deodar_interop.importers.cedar.values import number

NAMES = ("x", "y", "z", "w")

MOST_CELLS = 10_000_000
"""Largest number of samples; a larger array is probably an error (a guess; it would take 80 MB)."""

Counts = tuple[int, ...]
"""Samples of each dimension; () is one number."""


class TooManySamples(ValueError):
    """Raised if a size is implausibly large."""


class SampleGrid:
    """The axis of each length in a file."""

    def __init__(self, architecture: CedarFile) -> None:
        self.used: list[Counter[int]] = [Counter() for _ in NAMES]
        self.wraps: Counter[int] = Counter()
        for step in architecture.root.all_steps():
            sizes = [n for n in (number(v) for v in items(step.values.get("sizes"))) if n is not None]
            for d, count in enumerate(sizes[: len(NAMES)]):
                self.used[d][int(count)] += 1
                if step.short == "NeuralField":
                    self.wraps[int(count)] += 1 if _cyclic(step) else -1
        self.common = [max(used, key=lambda n: (used[n], n), default=0) for used in self.used]

    def axes(self, dims: Sequence[int]) -> tuple[Axis, ...]:
        """Return the axes of a size.

        Raises:
            TooManySamples: the size is implausibly large.
        """
        total = 1
        for count in dims:
            total *= count
        if len(dims) > len(NAMES) or max(dims, default=0) > MOST_SAMPLES or total > MOST_CELLS:
            raise TooManySamples(
                f"its size {list(dims)} is more than {len(NAMES)} axes or {MOST_CELLS} samples"
            )
        return tuple(self.axis(d, n) for d, n in enumerate(dims))

    def axis(self, d: int, count: int) -> Axis:
        """Return the axis of one dimension.

        All dimensions of one length wrap, or none: as the kernels of most fields of this length do.
        """
        usual = count == self.common[d] or not self.common[d]
        name = NAMES[d] if usual else f"{NAMES[d]}{count}"
        periodic = self.wraps[count] > 0 or count == 1
        return Axis(name, 0, count if periodic else count - 1, count, periodic)


def _cyclic(step: CedarStep) -> bool:
    return CedarBorder.of(step.values.get("lateral kernel convolution"), 1).type == "Cyclic"
