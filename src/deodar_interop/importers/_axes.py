"""The axes of an imported file, one for each dimension and number of samples.

Samples are at 1, 2, ..., so that the step is 1 and integrals are sums. A dimension of one sample has no axis.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from deodar.numerics.axes import MOST_SAMPLES, Axis
from deodar_interop.importers._piece import Dims

MOST_CELLS = 10_000_000
"""Largest number of samples; a larger array is probably an error (a guess; it would take 80 MB)."""


class SizeLimit(ValueError):
    """Raised if a size is implausibly large."""


class LengthAxes:
    """The axes by dimension and length. All axes of one length wrap, or none: as most elements state.

    Args:
        names: names of the dimensions; the most frequent length of a dimension has its name alone.
        elements: for each element its samples along the dimensions, and which of these it declares circular
            or not.
        first: position of the first sample.
        least: smallest length that counts.
    """

    def __init__(
        self,
        names: Sequence[str],
        elements: Iterable[tuple[Sequence[int], Mapping[int, bool]]],
        first: int = 1,
        least: int = 2,
    ) -> None:
        self.names = names
        self.first = first
        self.used: list[Counter[int]] = [Counter() for _ in names]
        self.wraps: Counter[int] = Counter()
        for counts, circular in elements:
            for d, count in enumerate(counts):
                self.used[d][count] += count >= least
            for d, wraps in circular.items():
                if d < len(counts):
                    self.wraps[counts[d]] += 1 if wraps else -1
        self.common = [max(used, key=lambda n: (used[n], n), default=0) for used in self.used]

    def of(self, counts: Sequence[int]) -> Dims:
        """Return the axes of a size.

        Raises:
            SizeLimit: a size is implausibly large.
        """
        if max(counts) > MOST_SAMPLES or math.prod(counts) > MOST_CELLS:
            raise SizeLimit(f"its size {list(counts)} is more than {MOST_CELLS} samples")
        return tuple(self.axis(d, n) if n > 1 else None for d, n in enumerate(counts))

    def axis(self, d: int, count: int) -> Axis:
        """Return the axis of one dimension."""
        common = self.common[d]
        name = self.names[d] if count == common or not self.used[d][common] else f"{self.names[d]}{count}"
        periodic = self.wraps[count] > 0 or count == 1
        return Axis(name, self.first, self.first + count - (not periodic), count, periodic)
