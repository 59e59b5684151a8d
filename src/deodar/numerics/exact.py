"""Numbers that keep the digits of float64 in a program of single precision.

Document time, and numbers that are compared with it or multiplied by it, need more digits than float32 has:
above 2^24 ms, float32 cannot represent every millisecond. Such a number is stored as two numbers of the
working precision, `high` and `low`. Their sum has 48 bits: at 2^44 steps the rounding is a sixteenth of a
step. Programs compute with it in float64, inside `exact()`, and round once, at the end.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
from collections.abc import Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array
from jax.typing import ArrayLike, DTypeLike

LOW = "~low"
"""Suffix of the path of a traced leaf that stores the rounding error of the leaf without the suffix."""


@jax.tree_util.register_dataclass
@dc.dataclass(frozen=True)
class Exact:
    """A number, or an array of numbers, as the sum of two in the working precision.

    It has no arithmetic: `wide` converts it to float64 inside `exact()`; `high` is the value in the working
    precision.
    """

    high: Any
    low: Any


def exact() -> contextlib.AbstractContextManager[None]:
    """Allow float64 inside a block, also while a program of single precision is traced.

    Cast the results to the working precision at the end of the block.
    """
    return jax.enable_x64(True)


def split(
    value: npt.ArrayLike | Sequence[float | np.ndarray], dtype: DTypeLike
) -> tuple[np.ndarray, np.ndarray]:
    """Return the high and low part of a number or an array of the host."""
    wide = np.asarray(value, np.float64)
    high = wide.astype(dtype)
    # no low part for values that are infinite in this precision
    low = np.where(np.isfinite(high), wide - np.where(np.isfinite(high), high, 0.0), 0.0)
    return high, low.astype(dtype)


def wide(value: Exact | ArrayLike) -> Array:
    """Return the value in float64; call it inside `exact()`."""
    if isinstance(value, Exact):
        return jnp.asarray(value.high, jnp.float64) + jnp.asarray(value.low, jnp.float64)
    return jnp.asarray(value, jnp.float64)
