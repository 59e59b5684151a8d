"""The matrix of a linear element, and of the interaction of a field: what it gives for each unit vector."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Sequence

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.compiler.functions import Functions
from deodar.element import Setting, Time
from deodar.errors import TooLarge
from deodar.model.resolve import Node
from deodar.numerics import interaction
from deodar.numerics.axes import Axes, shape
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.processor import on_cpu
from deodar_spikes.network import WeightMatrix

BLOCK = 512
MOST_ENTRIES = 30_000_000
"""Entries of the largest matrix between cells: 0.24 GB."""


def element_matrix(node: Node, port: str) -> WeightMatrix:
    """Return the matrix of a linear element without a state, outputs x inputs.

    Args:
        node: the resolved element; its one input port is `input`.
        port: the output port.
    """
    ins, outs, element = node.ins["input"], node.outs[port], node.element
    with on_cpu(), jax.enable_x64(True):
        dtype, functions = np.dtype("float64"), Functions(node, {})
        at = Setting(node.ins, node.outs, dtype, time=Time.at(0.0, 1.0, dtype))
        at = dc.replace(at, constants=functions.prepare(element, at))
        at = dc.replace(at, constants=functions.hoist(element, at))

        def output(x: Array) -> Array:
            return jnp.asarray(functions.output(element, dc.replace(at, inputs={"input": x}))[port], dtype)

        return _matrix(output, ins, outs)


def kernel_matrix(kernels: Sequence[Kernel], axes: Axes) -> WeightMatrix:
    """Return the matrix of an interaction: kernels times the grid step; on a node the sum of amplitudes."""
    if not kernels:
        return np.zeros((math.prod(shape(axes)),) * 2)
    with on_cpu(), jax.enable_x64(True):
        mixture = interaction.mix(kernels, axes, interaction.prepare(kernels, axes, np.dtype("float64")))
        return _matrix(lambda x: interaction.apply(mixture, axes, x), axes, axes)


def require_size(entries: int, what: str) -> None:
    """Refuse a matrix that would take too much memory."""
    if entries > MOST_ENTRIES:
        raise TooLarge(
            f"{what} has {entries:,} weights, more than {MOST_ENTRIES:,}",
            fix="Use fewer samples, or fewer neurons: a network has a weight for each pair of neurons",
        )


def _matrix(function: Callable[[Array], Array], ins: Axes, outs: Axes) -> WeightMatrix:
    columns, rows = math.prod(shape(ins)), math.prod(shape(outs))
    require_size(columns * rows, f"a coupling of {columns} cells with {rows} cells")
    many = jax.jit(jax.vmap(lambda x: function(x.reshape(shape(ins))).reshape(rows)))
    blocks = [np.asarray(many(np.eye(columns)[k : k + BLOCK]), np.float64) for k in range(0, columns, BLOCK)]
    return np.concatenate(blocks).T
