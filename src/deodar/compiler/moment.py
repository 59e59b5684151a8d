"""A moment of a run, as a program gets it: when it is, and how many steps and records there are to be."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar.numerics.exact import Exact, split

if TYPE_CHECKING:
    from jax.typing import DTypeLike

WHOLE = ("tick", "origin", "period", "head", "every", "records")
REAL = ("start", "dt")


def packed(now: Mapping[str, Any], dtype: DTypeLike) -> tuple[np.ndarray, np.ndarray]:
    """When it is, and how many steps and records there are to be, as two arrays: each argument of a program
    costs microseconds.

    The time is `start` at the tick `origin`; `start` and `dt` keep the digits of float64.
    """
    whole = np.array([now.get(name, 0) for name in WHOLE], np.uint32)
    return whole, np.stack(split([now.get(name, 0.0) for name in REAL], dtype))


def unpacked(whole: Any, real: Any) -> dict[str, Any]:
    """The same by name."""
    return {name: whole[k] for k, name in enumerate(WHOLE)} | {
        name: Exact(real[0, k], real[1, k]) for k, name in enumerate(REAL)
    }
