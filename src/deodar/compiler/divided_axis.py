"""The axis along which devices divide the fields of a model."""

from __future__ import annotations

import math
from collections.abc import Sequence

from deodar.errors import DeviceError
from deodar.model.resolve import Node
from deodar.numerics.axes import shape
from deodar.numerics.choice import Shards

LEAST = 2
"""Least number of samples of the divided axis on each device."""


def divided_axis(nodes: Sequence[Node], devices: int) -> Shards:
    """Return the axis along which a model is divided: of the largest element with a state, the first that
    gives all devices the same number of samples.

    Raises:
        DeviceError: it has no such axis.
    """
    largest = max((n for n in nodes if n.element.stateful), key=_cells, default=None)
    axes = max(largest.outs.values(), key=lambda a: math.prod(shape(a)), default=()) if largest else ()
    for axis in axes:
        if axis.samples % devices == 0 and axis.samples >= LEAST * devices:
            return Shards(axis.name, axis.samples, devices)
    if not axes or largest is None:
        raise DeviceError(
            f"the model has no field that {devices} devices could divide",
            fix="Leave out devices; trials and sweep points of any model are divided",
        )
    fitting = sorted(
        {d for a in axes for d in range(2, a.samples // LEAST + 1) if a.samples % d == 0 and d <= 1024}
    )
    sizes = ", ".join(f"{a.name}: {a.samples}" for a in axes)
    fewer = ", ".join(map(str, [d for d in fitting if d < devices][-3:])) or "none"
    raise DeviceError(
        f"no axis can be divided into {devices} equal parts ({sizes})",
        where=largest.path,
        fix=f"Use a number of samples that is a multiple of {devices}, or fewer devices: {fewer}",
    )


def _cells(n: Node) -> int:
    return max((math.prod(shape(axes)) for axes in n.outs.values()), default=0)
