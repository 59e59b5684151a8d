"""Counter-based noise: Threefry-2x32-20 and Box-Muller.

The integers depend on seed, trial, the element's stored id, the cell and the element's own tick, and on
nothing else: not on names, order, grouping, batches, chunks, precision or device.

References:
    Salmon, Moraes, Dror & Shaw (2011), Parallel random numbers: as easy as 1, 2, 3, SC'11 (Threefry, 20
    rounds). Box & Muller (1958), A note on the generation of random normal deviates, Ann. Math. Statist. 29.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import TypeAlias

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.typing import DTypeLike

from deodar.leaves import is_neutral, per_axis
from deodar.numerics import convolution
from deodar.numerics.axes import Axes, Axis, cell
from deodar.numerics.kernels.separable import profile
from deodar.numerics.native import Kernels
from deodar.numerics.scalar import Scalar
from deodar.parameters import PerAxis

STREAM = 0x5EED
"""Second key word of every noise key; the first is the seed."""

_ROTATIONS = ((13, 15, 26, 6), (17, 29, 16, 24))
_PARITY = 0x1BD11BDA

# Minimax-like polynomials on the reduced ranges, fitted for float32 (largest error of log 7e-5, at 1.5, of
# sine 5e-6).
_LOG = (0.9999990, -0.4999706, 0.3335, -0.2519, 0.20685, -0.1584, 0.0754)
_SINE = (6.2831853, -41.341675, 81.60523, -76.70, 42.0)


def threefry(x0: Array, x1: Array, k0: Array, k1: Array) -> tuple[Array, Array]:
    """Threefry-2x32 with 20 rounds: two uint32 counters and two uint32 key words to two uint32."""
    # primitives, not operators: each operator would be traced as a nested function, and there are a hundred
    x0, x1, k0, k1 = jnp.broadcast_arrays(*(jnp.asarray(word, jnp.uint32) for word in (x0, x1, k0, k1)))
    keys = (k0, k1, lax.bitwise_xor(lax.bitwise_xor(k0, k1), lax.full_like(k0, _PARITY)))
    x0, x1 = lax.add(x0, keys[0]), lax.add(x1, keys[1])
    for i in range(20):
        x0 = lax.add(x0, x1)
        x1 = lax.bitwise_xor(_rotated(x1, _ROTATIONS[(i // 4) % 2][i % 4]), x0)
        if i % 4 == 3:
            k = i // 4 + 1
            x0 = lax.add(x0, keys[k % 3])
            x1 = lax.add(lax.add(x1, keys[(k + 1) % 3]), lax.full_like(x1, k))
    return x0, x1


def _rotated(word: Array, count: int) -> Array:
    """Return 32-bit words with their bits rotated to the left."""
    high = lax.shift_left(word, lax.full_like(word, count))
    return lax.bitwise_or(high, lax.shift_right_logical(word, lax.full_like(word, 32 - count)))


def element_keys(seed: Array | int, trial: Array | int, idents: Array | np.ndarray | Sequence[int]) -> Array:
    """Return two key words for the noise of each element, shape (elements, 2): threefry(counter (id, trial),
    key (seed, STREAM)).
    """
    u32 = jnp.uint32
    ids = jnp.asarray(idents, u32)
    words = threefry(ids, jnp.full(ids.shape, trial, u32), jnp.asarray(seed, u32), u32(STREAM))
    return jnp.stack(words, axis=-1)


Cells: TypeAlias = int | tuple[int, ...]
"""A number of cells, or the shape in which they lie; they are numbered in C order."""


def bits(cells: Cells, key: Array, block: Array) -> tuple[Array, Array]:
    """Return two uint32 for each cell: counter (cell, block)."""
    return words(cells, 0, key, block)


def words(cells: Cells, first: int, key: Array, block: Array) -> tuple[Array, Array]:
    """Return two uint32 for each of the cells from number `first` on: counter (cell, block)."""
    counter = jnp.arange(cells, dtype=jnp.uint32) if isinstance(cells, int) else _numbers(cells)
    if first:
        counter = counter + jnp.uint32(first)
    return threefry(counter, jnp.full(counter.shape, block, jnp.uint32), key[0], key[1])


def _numbers(shape: tuple[int, ...]) -> Array:
    """Return the number of each cell, in a form of which devices compute parts along any axis."""
    parts = [
        lax.broadcasted_iota(jnp.uint32, shape, d) * jnp.uint32(math.prod(shape[d + 1 :]))
        for d in range(len(shape))
    ]
    return functools.reduce(lax.add, parts, jnp.zeros(shape, jnp.uint32))


def box_muller(one: Array, two: Array, dtype: DTypeLike) -> tuple[Array, Array]:
    """Return two independent standard normal deviates from two uniform numbers in (0, 1], in `dtype`:
    sqrt(-2 ln one) sin(2 pi two) and the same with the cosine.
    """
    radius = _length(one, dtype)
    return radius * _sine(two, dtype), radius * _cosine(two, dtype)


@functools.partial(jax.jit, static_argnames=("shape", "dtype", "shaped"))
def normal(shape: tuple[int, ...], key: Array, tick: Array, dtype: DTypeLike, shaped: bool = False) -> Array:
    """Return standard normal deviates of one tick, computed in `dtype`; along one line of cells, which is
    faster, or in their shape, which devices can divide.

    Block `tick // 2` gives two words a, b for each cell (in C order). With u = (a >> 9 + 1/2) / 2^23 and v
    the same of b, the pair is sqrt(-2 ln u) sin(2 pi v), the first, on even ticks, and sqrt(-2 ln u) cos(2 pi
    v), the second, on odd ones. The 23 bits are those that float32 holds exactly, so that both precisions
    draw the same numbers; the formula is then computed in `dtype`.
    """
    a, b = bits(shape if shaped else math.prod(shape), key, tick >> jnp.uint32(1))
    odd = (tick & jnp.uint32(1)).astype(bool)
    radius, turn = _radius(a, dtype), uniform(b)
    wave = jnp.where(odd, _cosine(turn, dtype), _sine(turn, dtype))
    return (radius * wave).reshape(shape)


@functools.partial(jax.jit, static_argnames=("cells", "dtype"))
def block(cells: Cells, key: Array, tick: Array, dtype: DTypeLike) -> Array:
    """Return the deviates of both ticks of the block of `tick` for each cell: the even one as the real part
    of a complex number, the odd one as the imaginary part.

    As one array they have one loop, where the integers are computed once. They equal those of `normal` up to
    rounding.
    """
    a, b = bits(cells, key, tick >> jnp.uint32(1))
    radius, turn = _radius(a, dtype), uniform(b)
    return lax.complex(radius * _sine(turn, dtype), radius * _cosine(turn, dtype))


def no_block(cells: Cells, dtype: DTypeLike, kernels: Kernels | None = None) -> Array:
    """Return zeros of the shape and type of a block: that of `block`, or that of the compiled kernels, where
    the deviates of both ticks are rows, shape (2, cells).
    """
    if kernels is not None:
        return jnp.zeros((2, cells), dtype)
    return jnp.zeros(cells, jnp.result_type(dtype, jnp.complex64))


def of_block(drawn: Array, tick: Array) -> Array:
    """Return the deviates of one of the two ticks of a block."""
    odd = tick & jnp.uint32(1)
    if not jnp.iscomplexobj(drawn):
        return lax.dynamic_index_in_dim(drawn, odd.astype(jnp.int32), keepdims=False)
    return jnp.where(odd.astype(bool), lax.imag(drawn), lax.real(drawn))


def prepare(axes: Axes, length: PerAxis, dtype: DTypeLike) -> dict[str, list[Array]]:
    """Return the constants of noise with a correlation length, under `noise`; none for white noise."""
    if is_neutral(length):
        return {}
    return {"noise": correlation(axes, per_axis(length, axes), dtype)}


def correlation(axes: Axes, lengths: Sequence[Scalar], dtype: DTypeLike) -> list[Array]:
    """Return matrices that give white deviates the correlation exp(-d^2 / (2 length^2)) and the variance 1.

    One matrix for each axis: the symmetric square root of the correlation matrix, so that the correlation is
    exact up to the borders. On a periodic axis the correlation is the sum over all images, divided by its
    value at distance 0 (equal to the formula for lengths below an eighth of the period, and its nearest valid
    form above).
    """
    return [_square_root(axis, length, dtype) for axis, length in zip(axes, lengths, strict=True)]


def _square_root(axis: Axis, length: Scalar, dtype: DTypeLike) -> Array:
    x = jnp.asarray(axis.points, dtype)
    period = axis.range if axis.periodic else None
    covariance = profile(x[:, None] - x[None, :], length, period) / profile(
        jnp.zeros((), dtype), length, period
    )
    values, vectors = jnp.linalg.eigh(covariance)
    root = jnp.matmul(vectors * jnp.sqrt(jnp.maximum(values, 0.0)), vectors.T, precision="highest")
    # in single precision the variance is 1 to 1e-6
    return root / jnp.sqrt(jnp.sum(root * root, axis=1, keepdims=True))


def over(axes: Axes, deviates: Array, filters: Sequence[Array] | None) -> Array:
    """Return noise of unit amplitude over a field: white, divided by the root of the cell, or correlated with
    variance 1.
    """
    if filters is None:
        return deviates / math.sqrt(cell(axes))
    return convolution.separable(filters, deviates)


def uniform(word: Array) -> Array:
    """Return a uniform number in (0, 1) from the upper 23 bits, exact in float32."""
    one_to_two = lax.bitcast_convert_type((word >> 9) | jnp.uint32(0x3F800000), jnp.float32)
    return one_to_two - jnp.float32(1.0 - 2.0**-24)


def _radius(word: Array, dtype: DTypeLike) -> Array:
    return _length(uniform(word), dtype)


def _length(share: Array, dtype: DTypeLike) -> Array:
    if dtype == jnp.float64:
        return jnp.sqrt(-2.0 * jnp.log(share.astype(dtype)))
    return jnp.sqrt(jnp.maximum(jnp.float32(-2.0) * _log(share), jnp.float32(0)))


def _sine(turn: Array, dtype: DTypeLike) -> Array:
    if dtype == jnp.float64:
        return jnp.sin(2 * jnp.pi * turn.astype(dtype))
    t = turn - jnp.float32(0.5)
    a = jnp.abs(t)
    return -_sine_of_turn(jnp.where(a > 0.25, jnp.sign(t) * (jnp.float32(0.5) - a), t))


def _cosine(turn: Array, dtype: DTypeLike) -> Array:
    if dtype == jnp.float64:
        return jnp.cos(2 * jnp.pi * turn.astype(dtype))
    return -_sine_of_turn(jnp.float32(0.25) - jnp.abs(turn - jnp.float32(0.5)))


def _sine_of_turn(q: Array) -> Array:
    """Return sin(2 pi q) for q in [-1/4, 1/4]."""
    return q * _polynomial(q * q, _SINE)


def _log(x: Array) -> Array:
    """Return the natural logarithm of a float32 in (0, 1]: exponent and a polynomial on [0.75, 1.5)."""
    word = lax.bitcast_convert_type(x, jnp.int32)
    exponent = (word - 0x3F400000) >> 23
    m = lax.bitcast_convert_type(word - (exponent << 23), jnp.float32) - jnp.float32(1)
    return m * _polynomial(m, _LOG) + exponent.astype(jnp.float32) * jnp.float32(math.log(2))


def _polynomial(x: Array, coefficients: tuple[float, ...]) -> Array:
    total: Array = jnp.float32(coefficients[-1])
    for c in reversed(coefficients[:-1]):
        total = jnp.float32(c) + x * total
    return total
