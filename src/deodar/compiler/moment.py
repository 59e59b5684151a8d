"""The clock arguments of a program: the time, and the numbers of steps and records."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, cast

import numpy as np

from deodar.compiler.arguments import EitherArray, ProgramClock
from deodar.numerics.exact import Exact, split

if TYPE_CHECKING:
    from jax.typing import DTypeLike

WHOLE = ("tick", "origin", "period", "head", "every", "records")
REAL = ("start", "dt")


def packed(now: Mapping[str, float], dtype: DTypeLike) -> tuple[np.ndarray, np.ndarray]:
    """Pack the time and the numbers of steps and records into two arrays, as each argument of a program costs
    microseconds.

    The time is `start` at the tick `origin`; `start` and `dt` keep the digits of float64.
    """
    whole = np.array([now.get(name, 0) for name in WHOLE], np.uint32)
    return whole, np.stack(split([now.get(name, 0.0) for name in REAL], dtype))


def unpacked(whole: EitherArray, real: EitherArray) -> ProgramClock:
    """Return the packed numbers by name."""
    named = {name: whole[k] for k, name in enumerate(WHOLE)} | {
        name: Exact(real[0, k], real[1, k]) for k, name in enumerate(REAL)
    }
    return cast("ProgramClock", named)
