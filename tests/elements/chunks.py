"""What a stimulus shows at one moment, however the run before it was divided."""

from __future__ import annotations

import numpy as np

from deodar.element import Element, Setting, Time
from deodar.numerics.axes import Axes


def require_the_same_in_any_chunks(element: Element, axes: Axes) -> None:
    """Time is kept as the start of a chunk and what has passed since: the bits must not depend on where chunks began."""
    at, dt = Setting({}, {"output": axes}, np.dtype("float32")), np.float32(0.1)
    constants = element.prepare(at)
    for tick in range(0, 140, 9):
        shown = []
        for first in (0, tick // 3, tick // 2, tick):
            start = np.float32(first * 0.1)
            time = Time(start, np.float32(first * 0.1 - float(start)) + np.float32(tick - first) * dt, dt)
            shown.append(np.asarray(element.output(at, {}, {}, constants, time, None)["output"]))
        for other in shown[1:]:
            np.testing.assert_array_equal(other, shown[0])
