"""Numbers that keep the digits of float64 in a program of single precision.

Document time, and what is compared with it or multiplied by it, needs more digits than float32 has: from 2^24
ms on float32 does not tell one millisecond from the next. Such a number is held as two of the working
precision, `high` and `low`. Their sum has 48 bits: at 2^44 steps the rounding is a sixteenth of a step.
Programs compute with it in float64, inside `exact()`, and round once, at the end.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import DTypeLike

LOW = "~low"
"""Ends the path of a traced leaf that holds what the leaf without it lost by rounding."""


@jax.tree_util.register_dataclass
@dc.dataclass(frozen=True)
class Exact:
    """A number, or an array of numbers, as the sum of two in the working precision.

    It takes part in no arithmetic by itself: `wide` gives float64 inside `exact()`, `rounded` the working
    precision.
    """

    high: Any
    low: Any

    @property
    def rounded(self) -> Any:
        """The value in the working precision."""
        return self.high


def exact() -> contextlib.AbstractContextManager[None]:
    """Allow float64 for the operations of a block, also while a program of single precision is traced; leave
    with a cast.
    """
    return jax.enable_x64(True)


def split(value: Any, dtype: DTypeLike) -> tuple[np.ndarray, np.ndarray]:
    """High and low part of a number or an array of the host."""
    wide = np.asarray(value, np.float64)
    high = wide.astype(dtype)
    rest = np.where(
        np.isfinite(high), wide - np.where(np.isfinite(high), high, 0.0), 0.0
    )  # none of what is infinite in this precision
    return high, rest.astype(dtype)


def wide(value: Any) -> Array:
    """The value in float64, inside `exact()`."""
    if isinstance(value, Exact):
        return jnp.asarray(value.high, jnp.float64) + jnp.asarray(value.low, jnp.float64)
    return jnp.asarray(value, jnp.float64)
