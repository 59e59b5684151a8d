"""The transforms of an array over axes to spectral modes and back.

An axis is transformed by a product with its whole basis, or folded: each class of modes of equal symmetries
needs only the sum or the difference of two halves of the array, so its product has half the size, or a
quarter with both symmetries of a ring. The inverse transform adds and subtracts in reverse.

Only the CPU folds. On other devices the start of an operation takes longer than folding can save.
"""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
from jax import Array, lax
from jax.custom_batching import custom_vmap

from deodar.numerics import convolution, native
from deodar.numerics.native import Kernels
from deodar.numerics.waves import Waves


def to_waves(waves: Sequence[Waves], y: Array, kernels: Kernels | None = None) -> Array:
    """Transform an array over axes to spectral modes; by compiled kernels, if they can."""
    if kernels is not None and native.transforms(kernels, waves):
        return kernels.to_modes(waves, y)

    def whole(y: Array) -> Array:
        return convolution.separable([jnp.asarray(w.basis().T, y.dtype) for w in waves], y, _order(waves))

    def folded(y: Array) -> Array:
        for d in _folded_order(waves):
            y = _forward(waves[d], y, d)
        return y

    return lax.platform_dependent(y, cpu=folded, default=whole) if _any_folded(waves) else whole(y)


def from_waves(waves: Sequence[Waves], y: Array, kernels: Kernels | None = None) -> Array:
    """Transform spectral modes to an array over axes; by the same means as `to_waves`."""
    if kernels is not None and native.transforms(kernels, waves):
        return kernels.from_modes(waves, y)

    def whole(y: Array) -> Array:
        bases = [jnp.asarray(w.basis(), y.dtype) for w in waves]
        return convolution.separable(bases, y, _order(waves)[::-1])

    def folded(y: Array) -> Array:
        for d in reversed(_folded_order(waves)):
            y = _back(waves[d], y, d)
        return y

    return lax.platform_dependent(y, cpu=folded, default=whole) if _any_folded(waves) else whole(y)


def _any_folded(waves: Sequence[Waves]) -> bool:
    return any(w.classes > 1 for w in waves)


def _order(waves: Sequence[Waves]) -> list[int]:
    """Return the order in which axes are transformed, up to 30 % faster than others because of the memory
    layout of the products; an axis that devices divide comes last.
    """
    if any(w.divided for w in waves):
        return sorted(range(len(waves)), key=lambda d: (waves[d].divided, -d))
    return [1, 0] if len(waves) == 2 else _folded_order(waves)


def _folded_order(waves: Sequence[Waves]) -> list[int]:
    return [0, *range(len(waves) - 1, 0, -1)]


def _forward(w: Waves, y: Array, d: int) -> Array:
    """Transform axis d to spectral modes."""
    if w.classes == 1:
        return convolution.along(jnp.asarray(w.basis().T, y.dtype), y, d)
    tables, shape = w.tables(), y.shape
    if w.by_symmetry and w.folded_samples % 2:  # the middle is its own mirror image, and counted twice
        tables[::2, -1] /= 2
    tables = jnp.asarray(tables, y.dtype)
    if d == y.ndim - 1:
        return lax.concatenate([_right(fold, tables[k]) for k, fold in enumerate(_fold(w, y, d))], d)
    rows = y.reshape((*shape[:d], w.samples, -1))
    modes = _stacked(tables.mT, jnp.stack(_fold(w, rows, d), axis=d))
    return modes.reshape((*shape[:d], w.count, *shape[d + 1 :]))


def _back(w: Waves, y: Array, d: int) -> Array:
    """Transform the spectral modes along axis d to samples."""
    if w.classes == 1:
        return convolution.along(jnp.asarray(w.basis(), y.dtype), y, d)
    tables, shape, modes = jnp.asarray(w.tables(), y.dtype), y.shape, w.count // w.classes
    if d == y.ndim - 1:
        parts = [lax.slice_in_dim(y, k, k + modes, axis=d) for k in range(0, w.count, modes)]
        return _unfold(w, [_right(part, table.T) for part, table in zip(parts, tables, strict=True)], d)
    products = _stacked(tables, y.reshape((*shape[:d], w.classes, modes, -1)))
    parts = [lax.index_in_dim(products, k, d, keepdims=False) for k in range(w.classes)]
    return _unfold(w, parts, d).reshape((*shape[:d], w.samples, *shape[d + 1 :]))


def _fold(w: Waves, y: Array, d: int) -> list[Array]:
    """Return for each class of modes the sum or the difference of parts of an array that it needs."""
    folds = [y]
    if w.by_parity:
        half = w.folded_samples
        folds = _halves(lax.slice_in_dim(y, 0, half, axis=d), lax.slice_in_dim(y, half, 2 * half, axis=d))
    return [part for fold in folds for part in _mirrored(fold, d)] if w.by_symmetry else folds


def _mirrored(y: Array, d: int) -> list[Array]:
    """Return the sum and the difference of the first half and the mirror image of the second; both halves
    have the middle of an odd number of samples.
    """
    n = y.shape[d]
    half = (n + 1) // 2
    image = lax.rev(lax.slice_in_dim(y, n - half, n, axis=d), (d,))
    return _halves(lax.slice_in_dim(y, 0, half, axis=d), image)


def _unfold(w: Waves, parts: Sequence[Array], d: int) -> Array:
    """Return the array along axis d from what each class of modes adds to it."""
    if w.by_symmetry:
        pairs = zip(parts[::2], parts[1::2], strict=True)
        parts = [
            _unmirrored(symmetric, antisymmetric, w.folded_samples, d) for symmetric, antisymmetric in pairs
        ]
        if w.by_parity:  # XLA would join the parts again for each half
            parts = lax.optimization_barrier(parts)
    return lax.concatenate(_halves(*parts), d) if w.by_parity else parts[0]


def _unmirrored(symmetric: Array, antisymmetric: Array, samples: int, d: int) -> Array:
    image = lax.slice_in_dim(symmetric - antisymmetric, 0, samples // 2, axis=d)
    return lax.concatenate([symmetric + antisymmetric, lax.rev(image, (d,))], d)


def _halves(a: Array, b: Array) -> list[Array]:
    return [a + b, a - b]


def _right(y: Array, m: Array) -> Array:
    """Return the product of an array along its last axis with a matrix."""
    return lax.dot_general(y, m, (((y.ndim - 1,), (0,)), ((), ())), precision="highest")


@custom_vmap
def _stacked(m: Array, y: Array) -> Array:
    """Return the products of matrices, shape (classes, ., rows), with those of a stack, shape (..., classes,
    rows, columns).

    Under `vmap` the copies become part of the stack. The rule of JAX would move them between rows and
    columns, and transpose the array twice in each product, which takes longer than folding saves.
    """
    stack = tuple(range(y.ndim - 2))
    copies = jnp.broadcast_to(m, (*y.shape[:-3], *m.shape))
    pairs = (((y.ndim - 1,), (y.ndim - 2,)), (stack, stack))
    return lax.dot_general(copies, y, pairs, precision="highest")


@_stacked.def_vmap
def _(_size: int, _batched: Sequence[bool], m: Array, y: Array) -> tuple[Array, bool]:
    return _stacked(m, y), True
