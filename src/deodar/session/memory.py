"""Check whether a run fits into memory, before anything is allocated."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np
import psutil

from deodar.compiler.strategies import acted_axes
from deodar.errors import TooLarge
from deodar.kind_errors import errors_of_kind
from deodar.leaves import is_neutral, leaves
from deodar.model.resolve import Node
from deodar.numerics import interaction
from deodar.numerics.axes import Axes, shape
from deodar.numerics.choice import Shards

SHARE = 0.8
"""Share of the free memory that a run may use (a guess that leaves enough for other programs)."""

COPIES = 6
"""Arrays per output in a step (state, new state, outputs, noise, intermediate; measured 4 to 6)."""


PROCESS = 300 * 2**20
"""Bytes that a worker process needs with a small model.

Measured with JAX 0.10: 210 MiB before the model, 280 to 310 MiB with its programs.
"""


def require(
    nodes: Sequence[Node],
    precision: str,
    copies: int,
    recorded: int,
    rebuilt: Collection[str] = (),
    points: int = 1,
    workers: int = 0,
) -> None:
    """Raise TooLarge unless states, constants and records fit into the free memory.

    Args:
        nodes: the nodes of the model.
        precision: float32, float64, or float32-exact.
        copies: number of copies of the model that run at once, in each process.
        recorded: number of values that are recorded.
        rebuilt: the elements (by id) whose constants differ between the points of a sweep.
        points: number of such points that run at once, in each process.
        workers: number of worker processes; they keep their records until this process has received them.
    """
    constants = sum(_constants(n) * (points - 1) for n in nodes if n.id in rebuilt)
    bytes_of_run = run_bytes(nodes, precision, copies, rebuilt) + _size(precision) * constants
    need = max(1, workers) * bytes_of_run + _size(precision) * recorded + workers * PROCESS
    free = psutil.virtual_memory().available
    if need > SHARE * free:
        largest = max(
            nodes, key=lambda n: _cells(n) * copies + _constants(n, _by_matrices(n, precision, rebuilt))
        )
        axes = ", ".join(f"{a.name}: {a.samples}" for a in _axes(largest))
        raise TooLarge(
            f"this run needs about {need / 2**30:,.1f} GiB and {free / 2**30:,.1f} GiB are free; most of it"
            f" is {largest.path} ({axes or 'no axes'})",
            fix="Use fewer samples, fewer trials, "
            + ("fewer workers, " if workers > 1 else "")
            + "or a larger `every`",
        )


def run_bytes(nodes: Sequence[Node], precision: str, copies: int, rebuilt: Collection[str] = ()) -> int:
    """Return about how many bytes the states and the constants of copies of a model need that run at once.

    Kernels count as the planner applies them; those of elements in `rebuilt` as matrices.
    """
    cells = copies * COPIES * sum(_cells(n) for n in nodes)
    constants = 0
    for n in nodes:
        with errors_of_kind(n.element, n.path):
            constants += _constants(n, _by_matrices(n, precision, rebuilt))
    return _size(precision) * (cells + constants)


def copy_bytes(nodes: Sequence[Node], precision: str, rebuilt: Collection[str] = (), trials: int = 1) -> int:
    """Return the bytes of all ports of one copy of a model, and of the constants that it has for itself.

    Args:
        nodes: the nodes of the model.
        precision: float32 or float64.
        rebuilt: the elements (by id) whose constants differ between the points of a sweep.
        trials: number of copies that share the constants of a point.
    """
    constants = sum(_constants(n) for n in nodes if n.id in rebuilt)
    return _size(precision) * (sum(_cells(n) for n in nodes) + constants // trials)


def device_bytes(nodes: Sequence[Node], precision: str, shards: Shards) -> int:
    """Return about how many bytes one of several devices needs that divide an axis."""

    def part(axes: Axes) -> float:
        return math.prod(shape(axes)) / (1 if shards.index(axes) is None else shards.devices)

    cells = sum(part(axes) for n in nodes for axes in [*n.outs.values(), *n.ins.values()])
    return round(_size(precision) * (COPIES * cells + sum(_constants(n) for n in nodes)))


def _size(precision: str) -> int:
    return 8 if precision == "float64" else 4


def _axes(n: Node) -> Axes:
    ports = [*n.outs.values(), *n.ins.values()]
    return max(ports, key=lambda axes: math.prod(shape(axes)), default=())


def _cells(n: Node) -> int:
    return sum(math.prod(shape(axes)) for axes in [*n.outs.values(), *n.ins.values()])


def _by_matrices(n: Node, precision: str, rebuilt: Collection[str]) -> bool:
    return precision != "float32" or n.id in rebuilt


def _kernel_values(n: Node) -> int:
    """Return the number of values of the kernels of a node, as the planner applies them to one copy."""
    axes, kernels = acted_axes(n), n.element.kernels()
    chosen = interaction.choices(kernels, axes)
    # the kernels of one kind of boundaries share modes, and the sum of their gains
    waves = [choice.waves for choice in chosen.values() if choice.method == "waves"]
    values = sum(w.samples * w.count for several in waves for w in several)
    values += sum(math.prod(w.count for w in several) // 2 for several in waves)
    for kernel in kernels if axes else ():
        choice = chosen.get(interaction.boundaries(kernel, axes)) if kernel.widths() else None
        if choice is None:
            values += sum(a.samples**2 for a in axes)
        elif choice.method == "taps":
            values += sum(choice.reaches)
        elif choice.method == "waves":
            values += sum(w.count for w in choice.waves)
        else:
            values += math.prod(w.length for w in choice.waves)
    return values


def _constants(n: Node, by_matrices: bool = True) -> int:
    """Return the number of values in the constants of a node.

    Constants are those of kernels, the matrices of correlated noise, of shifts and of resampling (one for
    each axis), and arrays given as parameters.
    """
    e = n.element
    square = sum(not is_neutral(getattr(e, name, 0.0)) for name in ("noise_length", "length", "amount"))
    if by_matrices:
        square += len(getattr(e, "kernel", ()) or ())
    kernels = 0 if by_matrices else _kernel_values(n)
    arrays = sum(int(np.size(value)) for _, value, _ in leaves(e) if np.ndim(value))
    samples_of = {a.name: a.samples for axes in n.ins.values() for a in axes}
    between = sum(
        a.samples * samples_of[a.name]
        for axes in n.outs.values()
        for a in axes
        if samples_of.get(a.name, a.samples) != a.samples
    )
    return 2 * (square * sum(a.samples**2 for a in _axes(n)) + kernels + between) + arrays
