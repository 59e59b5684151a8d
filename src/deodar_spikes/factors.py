"""WeightMatrix as a small matrix between blocks of neurons.

The neurons of a cell have equal synapses, so that a matrix of 600 x 600 weights is one of 30 x 30 between the
sums over blocks of inputs and copies of the results.
"""

from __future__ import annotations

import dataclasses as dc
import math

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray


@dc.dataclass(frozen=True, eq=False)
class Factors:
    """y = core (sums of x over blocks), repeated.

    Attributes:
        core: blocks of rows x blocks of columns.
        rows, columns: rows and columns of a block.
    """

    core: NDArray[np.float32]
    rows: int
    columns: int

    def __call__(self, x: Array) -> Array:
        """Return the product for copies x values."""
        if self.columns > 1:
            x = x.reshape(*x.shape[:-1], -1, self.columns).sum(-1)
        y = jnp.matmul(x, self.core.T, precision="highest")
        return jnp.repeat(y, self.rows, axis=-1) if self.rows > 1 else y


def factors(weight: NDArray[np.float32]) -> Factors:
    """Return the factors of a matrix with the largest blocks of equal rows and columns."""
    rows = _block(weight)
    core = weight[::rows]
    columns = _block(core.T)
    return Factors(np.ascontiguousarray(core[:, ::columns]), rows, columns)


def _block(rows: NDArray[np.float32]) -> int:
    """Return the largest number of which all runs of equal neighbouring rows are multiples."""
    changes = np.flatnonzero((rows[1:] != rows[:-1]).any(axis=1)) + 1
    return math.gcd(len(rows), *(int(k) for k in changes))
