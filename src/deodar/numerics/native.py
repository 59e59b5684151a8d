"""The compiled kernels of the distribution `deodar-native`, where it is installed.

They compute parts of a step in single precision on a CPU: the same integers and the same formulas as the
functions of this package in JAX, in less time, with results that differ by rounding. In double precision, on
other devices and without the distribution these functions run instead. `DEODAR_NATIVE` in the environment
chooses the vector instructions of the kernels; "off" does without the kernels.
"""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Sequence
from typing import Protocol, cast

import numpy as np
from jax import Array

DISTRIBUTION = "deodar-native"
SWITCH = "DEODAR_NATIVE"
LEAST_NOISE = 400
"""Cells with noise in all copies from which a kernel draws it."""

LEAST_LINE = 15_000
"""Lags times samples from which a convolution over one axis is a call of a kernel, which costs 0.1 us."""

LARGEST_PLANE = 40_000
"""Samples of a plane up to which kernels compute it: a kernel uses one core, XLA all of them."""

INTERFACE = 2
"""Version of the functions below; a distribution that states another one is not used."""


class Modes(Protocol):
    """The spectral modes of one axis: a `waves.Waves`, which this module cannot import."""

    @property
    def boundary(self) -> str: ...
    @property
    def samples(self) -> int: ...
    @property
    def length(self) -> int: ...
    @property
    def turns(self) -> np.ndarray: ...


class Kernels(Protocol):
    """The functions of the distribution, traced by JAX; `vmap` maps them."""

    __version__: str
    INTERFACE: int

    def vectors(self) -> str:
        """Return the name of the vector instructions that are used on this processor."""
        ...

    def noise(self, key: Array, tick: Array, start: Array, drawn: Array) -> Array:
        """Return the deviates of both ticks of the block of `tick`, as `noise.block` computes them, at even
        ticks and at the tick `start`, else `drawn`: shape (2, cells), the even tick first.
        """
        ...

    def line(self, weights: Array, y: Array, boundary: str) -> Array:
        """Return what `convolution.tapped` computes."""
        ...

    def cells(self, u: Array, beta: Array, threshold: Array, periodic: Sequence[bool]) -> Array:
        """Return what `quadrature.cell_means` computes for a logistic function over one or two axes."""
        ...

    def to_modes(self, axes: Sequence[Modes], y: Array) -> Array:
        """Return the spectral modes of a plane, with an origin of phases of their own."""
        ...

    def from_modes(self, axes: Sequence[Modes], y: Array) -> Array:
        """Return the plane of these spectral modes."""
        ...


def kernels(platform: str, precision: str) -> Kernels | None:
    """Return the kernels for programs on a platform in a precision; None where JAX computes all."""
    if platform != "cpu" or precision != "float32" or switched_off():
        return None
    return _installed()[0]


def transforms(found: Kernels, waves: Sequence[Modes]) -> bool:
    """Return whether the kernels transform an array over these axes to spectral modes, and back."""
    return (
        len(waves) == 2
        and math.prod(w.samples for w in waves) <= LARGEST_PLANE
        and found.vectors() != "plain"
    )


def means_of_cells(axes: int, samples: int) -> bool:
    """Return whether a kernel computes the means of an output of a number of axes and samples."""
    return 1 <= axes <= 2 and samples <= LARGEST_PLANE


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
