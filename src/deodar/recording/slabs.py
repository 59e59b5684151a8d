"""An array in blocks of bounded size, in the order of its values."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

Slab = tuple[slice, ...]


def slabs(shape: Sequence[int], most: int) -> Iterator[Slab]:
    """Yield the slices of blocks that cover an array in C order, each of at most `most` values.

    >>> list(slabs((4, 3), 6))
    [(slice(0, 2, None), slice(0, 3, None)), (slice(2, 4, None), slice(0, 3, None))]
    """
    whole = tuple(slice(0, n) for n in shape)
    if not shape or math.prod(shape) <= most:
        yield whole
        return
    inner = math.prod(shape[1:])
    if inner <= most:
        step = max(1, most // inner)
        for first in range(0, shape[0], step):
            yield slice(first, min(first + step, shape[0])), *whole[1:]
        return
    for k in range(shape[0]):
        for tail in slabs(shape[1:], most):
            yield slice(k, k + 1), *tail
