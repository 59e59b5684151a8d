"""Compiled kernels for deodar, as calls inside programs of JAX on a CPU.

deodar finds this package where it is installed; nothing has to be imported. The functions here are traced by
JAX, in single precision, and may be mapped by `vmap`.
"""

from __future__ import annotations

import ctypes
import functools
import os
from collections.abc import Sequence
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar_native.modes import AxisTables, Modes, axis_tables

__version__ = "0.1.0"

CHOICE = "DEODAR_NATIVE"
"""Environment variable with the name of the vector instructions to use; without it the widest ones. deodar
does not call this package if it is `off`.
"""

INTERFACE = 2
"""Version of the functions that deodar calls; deodar uses no package with another one."""

_LIBRARY = Path(__file__).with_name("kernels.so")
_HANDLERS = ("noise", "bits", "line", "to_modes", "from_modes", "cells")
_BOUNDARIES = {"zero": 0, "periodic": 1, "reflect": 2}


def vectors() -> str:
    """Return the vector instructions that the kernels use on this processor: avx512, avx2 or plain."""
    return _library().deodar_vectors().decode()


def noise(key: Array, tick: Array, start: Array, drawn: Array) -> Array:
    """Return the standard normal deviates of the two ticks of the block of `tick`, shape (2, cells): the even
    tick first.

    They are computed at even ticks and at the tick `start`; at other ticks they are `drawn`. The integers and
    the formula are those of `deodar.numerics.noise.block`: two words of Threefry-2x32-20 with the counter
    (cell, tick // 2), then the method of Box and Muller.

    Args:
        key: two words, uint32.
        tick: the present tick, uint32.
        start: the first tick of a run, uint32.
        drawn: the result at the tick before, in whose memory the new one is written. It is mapped by `vmap`
            where another argument is.
    """
    out = jax.ShapeDtypeStruct(drawn.shape, drawn.dtype)
    return _call("noise", out, key, tick, start, drawn, aliases={3: 0})


def bits(cells: int, key: Array, block: Array) -> Array:
    """Return the two words of each cell from which `noise` computes deviates, shape (2, cells), uint32.

    The counter is (cell, block).
    """
    return _call("bits", jax.ShapeDtypeStruct((2, cells), jnp.uint32), key, block)


def line(weights: Array, y: Array, boundary: str) -> Array:
    """Return the convolution over one axis with a symmetric kernel, as
    `deodar.numerics.convolution.tapped` computes it.

    Args:
        weights: weights of the lags 0 to `reach`, less than half the number of samples.
        y: the samples.
        boundary: `zero`, `periodic` or `reflect`.
    """
    return _call(
        "line", jax.ShapeDtypeStruct(y.shape, y.dtype), weights, y, boundary=np.int64(_BOUNDARIES[boundary])
    )


def cells(u: Array, beta: Array, threshold: Array, periodic: Sequence[bool]) -> Array:
    """Return the means of a logistic output over the cells of a line or a plane, as
    `deodar.numerics.quadrature.cell_means` computes them.

    Args:
        u: the activation, with one or two axes of more than one sample.
        beta: steepness of the logistic function, one number.
        threshold: its threshold, one number.
        periodic: whether each axis is.
    """
    out = jax.ShapeDtypeStruct(u.shape, u.dtype)
    return _call("cells", out, u, beta, threshold, periodic=np.asarray(periodic, np.int64))


def to_modes(axes: Sequence[Modes], y: Array) -> Array:
    """Return the spectral modes of a plane, in the order of the modes of its two axes."""
    outer, inner = axis_tables(axes[0], True), axis_tables(axes[1], False)
    return _plane("to_modes", (outer.total, inner.total), y, outer, inner, outer.forward, inner.forward)


def from_modes(axes: Sequence[Modes], y: Array) -> Array:
    """Return the plane that has given spectral modes."""
    outer, inner = axis_tables(axes[0], True), axis_tables(axes[1], False)
    shape = (axes[0].samples, axes[1].samples)
    return _plane("from_modes", shape, y, outer, inner, outer.back, inner.back)


def _plane(
    name: str,
    shape: tuple[int, int],
    y: Array,
    outer: AxisTables,
    inner: AxisTables,
    *tables: np.ndarray,
) -> Array:
    args = [y, *map(jnp.asarray, (*tables, outer.places, inner.places))]
    out = jax.ShapeDtypeStruct(shape, y.dtype)
    return _call(name, out, *args, outer_counts=outer.counts, inner_counts=inner.counts)


def _call(
    name: str,
    out: jax.ShapeDtypeStruct,
    *args: Array,
    aliases: dict[int, int] | None = None,
    **attributes: np.int64 | np.ndarray,
) -> Array:
    register()
    call = jax.ffi.ffi_call(_target(name), out, vmap_method="expand_dims", input_output_aliases=aliases)
    return call(*args, **attributes)


@functools.cache
def register() -> None:
    """Make the kernels known to XLA; a program that was kept on disk needs this before it is loaded."""
    for name in _HANDLERS:
        handler = jax.ffi.pycapsule(getattr(_library(), f"deodar_{name}"))
        jax.ffi.register_ffi_target(_target(name), handler, platform="cpu")


def _target(name: str) -> str:
    # programs on disk hold this name: a handler with other arguments must have another one
    return f"deodar_native_{name}_{INTERFACE}"


@functools.cache
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(str(_LIBRARY))
    library.deodar_vectors.restype = ctypes.c_char_p
    library.deodar_choose.restype = ctypes.c_bool
    wanted = os.environ.get(CHOICE, "").lower()
    if not library.deodar_choose(wanted.encode()):
        raise ValueError(
            f"{CHOICE} is {wanted!r}; expected off, or vectors of this processor: plain, avx2, avx512"
        )
    return library
