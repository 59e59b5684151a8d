"""Weights as a product of small matrices, where many rows and columns are equal.

The neurons of a cell have equal synapses, so that a matrix of 600 x 600 weights is one of 30 x 30 between the
sums of equal columns and copies of equal rows.
"""

from __future__ import annotations

import dataclasses as dc

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray


@dc.dataclass(frozen=True, eq=False)
class Factors:
    """y = core (sums of x over equal columns), copied to equal rows.

    Attributes:
        core: distinct rows x distinct columns.
        rows: for each row of the weights the one of the core; none: each its own.
        columns: number of neighbouring equal columns, or for each column the one of the core; 1: each its
            own.
    """

    core: NDArray[np.float32]
    rows: NDArray[np.intp] | None
    columns: int | NDArray[np.intp]

    def __call__(self, x: Array) -> Array:
        """Return the product for copies x values."""
        if isinstance(self.columns, int):
            if self.columns > 1:
                x = x.reshape(*x.shape[:-1], -1, self.columns).sum(-1)
        else:
            x = jnp.zeros((*x.shape[:-1], self.core.shape[1]), x.dtype).at[..., self.columns].add(x)
        y = jnp.matmul(x, self.core.T, precision="highest")
        return y if self.rows is None else y[..., self.rows]


def factors(weight: NDArray[np.float32]) -> Factors:
    """Return the factors of a matrix; the matrix itself if most rows and columns differ."""
    rows = _equal(weight)
    core = weight if rows is None else weight[np.unique(rows, return_index=True)[1]]
    columns = _equal(core.T)
    if columns is None:
        return Factors(core, rows, 1)
    first = np.unique(columns, return_index=True)[1]
    core = core[:, first]
    count = weight.shape[1] // len(first)
    if weight.shape[1] % len(first) == 0 and (columns == np.repeat(np.arange(len(first)), count)).all():
        return Factors(core, rows, count)
    return Factors(core, rows, columns)


def _equal(rows: NDArray[np.float32]) -> NDArray[np.intp] | None:
    """Return for each row the number of its first equal one among the distinct rows; None if at least two
    thirds differ.
    """
    known: dict[bytes, int] = {}
    found = np.array([known.setdefault(r.tobytes(), len(known)) for r in np.ascontiguousarray(rows)])
    return found if len(known) * 3 < 2 * len(rows) else None
