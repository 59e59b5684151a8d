"""The compiled kernels of the distribution `deodar-native`, where it is installed.

They compute parts of a step in single precision on a CPU: the same integers and the same formulas as the
functions of this package in JAX, in less time, with results that differ by rounding. In double precision, on
other devices and without the distribution these functions run instead. `DEODAR_NATIVE` in the environment
chooses the vector instructions of the kernels; "off" does without the kernels.
"""

from __future__ import annotations

import functools
import os
from typing import Protocol, cast

from jax import Array

DISTRIBUTION = "deodar-native"
SWITCH = "DEODAR_NATIVE"
INTERFACE = 1
"""Version of the functions below; a distribution that states another one is not used."""


class Kernels(Protocol):
    """The functions of the distribution, traced by JAX; `vmap` maps them."""

    __version__: str
    INTERFACE: int

    def vectors(self) -> str:
        """Return the name of the vector instructions that are used on this processor."""
        ...

    def noise(self, cells: int, key: Array, block: Array) -> Array:
        """Return the deviates of both ticks of a block, as `noise.block` computes them: shape (2, cells)."""
        ...


def kernels(platform: str, precision: str) -> Kernels | None:
    """Return the kernels for programs on a platform in a precision; None where JAX computes all."""
    if platform != "cpu" or precision != "float32" or switched_off():
        return None
    return _installed()[0]


def version(found: Kernels | None) -> str:
    """Return version and vector instructions of the kernels, which determine the last digits of results; ""
    without kernels.
    """
    return f"{found.__version__} {found.vectors()}" if found is not None else ""


def switched_off() -> bool:
    """Return whether the environment does without the kernels."""
    return os.environ.get(SWITCH, "").lower() == "off"


def problem() -> str:
    """Return why an installed distribution cannot be used; "" without a problem, or if it is not
    installed.
    """
    return _installed()[1]


@functools.cache
def _installed() -> tuple[Kernels | None, str]:
    try:
        # optional, and only programs need it
        import deodar_native  # pyright: ignore[reportMissingImports]

        found = cast("Kernels", deodar_native)
        if found.INTERFACE != INTERFACE:
            return None, f"has interface {found.INTERFACE}; this deodar needs {INTERFACE}"
        found.vectors()
    except ModuleNotFoundError as error:
        return None, "" if error.name == "deodar_native" else f"needs {error.name}"
    except Exception as error:  # a library of another platform, or one that is missing
        return None, f"cannot be loaded: {error}"
    return found, ""
