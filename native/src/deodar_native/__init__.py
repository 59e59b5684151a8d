"""Compiled kernels for deodar, as calls inside programs of JAX on a CPU.

deodar finds this package where it is installed; nothing has to be imported. The functions here are traced by
JAX, in single precision, and may be mapped by `vmap`.
"""

from __future__ import annotations

import ctypes
import functools
import os
from pathlib import Path

import jax
import jax.numpy as jnp
from jax import Array

__version__ = "0.1.0"

CHOICE = "DEODAR_NATIVE"
"""Environment variable with the name of the vector instructions to use; without it the widest ones. deodar
does not call this package if it is `off`.
"""

INTERFACE = 1
"""Version of the functions that deodar calls; deodar uses no package with another one."""

_LIBRARY = Path(__file__).with_name("kernels.so")
_HANDLERS = ("noise", "bits")


def vectors() -> str:
    """Return the vector instructions that the kernels use on this processor: avx512, avx2 or plain."""
    return _library().deodar_vectors().decode()


def noise(cells: int, key: Array, block: Array) -> Array:
    """Return the standard normal deviates of a block of two ticks, shape (2, cells): the even tick first.

    The integers and the formula are those of `deodar.numerics.noise.block`: two words of Threefry-2x32-20
    with the counter (cell, block), then the method of Box and Muller.

    Args:
        cells: number of cells.
        key: two words, uint32.
        block: number of the block, uint32: half the tick.
    """
    return _call("noise", jax.ShapeDtypeStruct((2, cells), jnp.float32), key, block)


def bits(cells: int, key: Array, block: Array) -> Array:
    """Return the two words of each cell from which `noise` computes deviates, shape (2, cells), uint32."""
    return _call("bits", jax.ShapeDtypeStruct((2, cells), jnp.uint32), key, block)


def _call(name: str, out: jax.ShapeDtypeStruct, *args: Array) -> Array:
    register()
    return jax.ffi.ffi_call(_target(name), out, vmap_method="broadcast_all")(*args)


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
