"""Whether a run fits into memory, told before anything is allocated."""

from __future__ import annotations

import math

import numpy as np
import psutil

from deodar.errors import TooLarge
from deodar.model.resolve import Node
from deodar.numerics.axes import Axes, shape
from deodar.parameters import leaves

SHARE = 0.8
"""Share of the free memory that a run may ask for (a guess that leaves the rest of the machine alive)."""

COPIES = 6
"""Arrays that a step keeps for each output (state, new state, outputs, noise, intermediate; measured 4 to 6)."""


def require(nodes: list[Node], precision: str, copies: int, recorded: int) -> None:
    """Raise unless states, constants and `recorded` numbers fit into the memory that is free."""
    size = 8 if precision == "float64" else 4
    need = size * (copies * COPIES * sum(_cells(n) for n in nodes) + sum(_constants(n) for n in nodes) + recorded)
    free = psutil.virtual_memory().available
    if need > SHARE * free:
        largest = max(nodes, key=lambda n: _cells(n) * copies + _constants(n))
        axes = ", ".join(f"{a.name}: {a.samples}" for a in _axes(largest))
        raise TooLarge(
            f"this run needs about {need / 2**30:,.1f} GiB and {free / 2**30:,.1f} GiB are free; most of it is {largest.path} ({axes or 'no axes'})",
            fix="Take fewer samples, fewer trials, or a larger `every`",
        )


def _axes(n: Node) -> Axes:
    ports = [*n.outs.values(), *n.ins.values()]
    return max(ports, key=lambda axes: math.prod(shape(axes)), default=())


def _cells(n: Node) -> int:
    return sum(math.prod(shape(axes)) for axes in [*n.outs.values(), *n.ins.values()])


def _constants(n: Node) -> int:
    """Matrices of kernels (one for each axis) and arrays given as parameters."""
    kernels = len(getattr(n.element, "kernel", ()) or ())
    arrays = sum(int(np.size(value)) for _, value, _ in leaves(n.element) if np.ndim(value))
    return 2 * kernels * sum(a.samples**2 for a in _axes(n)) + arrays
