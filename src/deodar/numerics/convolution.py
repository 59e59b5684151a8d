"""Convolution of a field's output with interaction kernels, for any width and boundary.

A separable kernel is one matrix per axis, exact at every width, rebuilt without recompiling. A sampled kernel
is a product of spectra on the extended grid. Integrals are sums times the grid step (rectangle rule); the
matrices include this factor.

Boundaries: `periodic` wraps with a period of N steps, `zero` pads the field with 0, `reflect` mirrors the
field at the outer edge of its last cell, `replicate` continues the field with its outermost values.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.typing import DTypeLike

from deodar.numerics import native
from deodar.numerics.axes import Axes, Axis, cell, shape
from deodar.numerics.native import Kernels

BOUNDARIES = ("periodic", "zero", "reflect", "replicate")

BEYOND = 4
"""Lengths of an axis beyond each end that `replicate` counts; 0 is assumed farther away."""

TINY = 1e-20
"""Smallest weight that is used; smaller weights have no effect, and denormal numbers are slow."""

Profile = Callable[[Array, float | None], Array]
"""Weight as a function of the lag; the second argument is the period if the lag wraps, else None."""


def boundaries(given: Sequence[str] | None, axes: Axes) -> tuple[str, ...]:
    """Return the boundary of each axis; the default is periodic on periodic axes and zero on others."""
    if given is None:
        return tuple("periodic" if a.periodic else "zero" for a in axes)
    return tuple(given) if len(given) == len(axes) else tuple(given) * len(axes)


def matrix(axis: Axis, boundary: str, profile: Profile, dtype: DTypeLike) -> Array:
    """Return the weights between all pairs of samples of one axis, times the grid step, (samples,
    samples).
    """
    x = axis.points
    lag = jnp.asarray(x[:, None] - x[None, :], dtype)
    if boundary == "periodic":
        weights = profile(lag, axis.step * axis.samples)
    elif boundary == "reflect":
        period = 2 * axis.step * axis.samples
        mirrored = jnp.asarray(x[:, None] + x[None, :] - 2 * axis.lower + axis.step, dtype)
        weights = profile(lag, period) + profile(mirrored, period)
    elif boundary == "replicate":
        outside = axis.step * np.arange(1, BEYOND * axis.samples + 1)
        before = jnp.asarray((x - x[0])[:, None] + outside[None, :], dtype)
        after = jnp.asarray((x - x[-1])[:, None] - outside[None, :], dtype)
        weights = profile(lag, None)
        weights = weights.at[:, 0].add(jnp.sum(profile(before, None), axis=1))
        weights = weights.at[:, -1].add(jnp.sum(profile(after, None), axis=1))
    else:
        weights = profile(lag, None)
    return jnp.where(jnp.abs(weights) < TINY, 0.0, weights) * jnp.asarray(axis.step, dtype)


def taps(axis: Axis, boundary: str, profile: Profile, reach: int, dtype: DTypeLike) -> Array:
    """Return the weights of a symmetric kernel at lags of 0 to `reach` samples, times the grid step."""
    lag = jnp.asarray(np.arange(reach + 1) * axis.step, dtype)
    weights = profile(lag, axis.step * axis.samples if boundary == "periodic" else None)
    return weights * jnp.asarray(axis.step, dtype)


def tapped(weights: Array, y: Array, boundary: str, axis: int = 0, kernels: Kernels | None = None) -> Array:
    """Convolve along one axis by a sum of shifted copies; both copies of equal distance share a product."""
    reach, n = weights.shape[0] - 1, y.shape[axis]
    if kernels is not None and y.ndim == 1 and reach * n >= native.LEAST_LINE:
        return kernels.line(weights, y, boundary)
    first, last = lax.slice_in_dim(y, 0, reach, axis=axis), lax.slice_in_dim(y, n - reach, n, axis=axis)
    nothing = jnp.zeros_like(first)
    sides = {"periodic": (last, first), "reflect": (lax.rev(first, (axis,)), lax.rev(last, (axis,)))}
    return lagged(weights, *sides.get(boundary, (nothing, nothing)), y, axis)


def lagged(weights: Array, before: Array, after: Array, y: Array, axis: int) -> Array:
    """Return the sum of shifted copies of an array along one axis, which continues `before` and `after`."""
    reach, n = weights.shape[0] - 1, y.shape[axis]
    wide = lax.concatenate([before, y, after], axis)
    # XLA uses vectors where all copies are parts of one long line, in which rows keep their padding until the
    # sum is complete. Zeros at the end of the line cost less than a longer sum, which has a branch per sample
    step = math.prod(y.shape[axis + 1 :])
    line, count = wide.reshape(-1), y.size if axis == 0 else wide.size
    if axis:
        line = lax.pad(line, jnp.zeros((), y.dtype), [(0, 2 * reach * step, 0)])
    elif y.ndim > 1:  # otherwise every copy would be computed again from what it is a copy of
        line = lax.optimization_barrier(line)

    def shifted(k: int) -> Array:
        return lax.slice_in_dim(line, (reach + k) * step, (reach + k) * step + count)

    total = weights[0] * shifted(0)
    for k in range(1, reach + 1):
        total = total + weights[k] * (shifted(-k) + shifted(k))
    if axis == 0:
        return total.reshape(y.shape)
    return lax.slice_in_dim(total.reshape(wide.shape), 0, n, axis=axis)


def along(m: Array, y: Array, d: int) -> Array:
    """Apply a matrix along axis d."""
    if d == 0:
        return jnp.tensordot(m, y, axes=(1, 0), precision="highest")
    if d == y.ndim - 1:
        return jnp.tensordot(y, m, axes=(d, 1), precision="highest")
    return jnp.moveaxis(jnp.tensordot(m, y, axes=(1, d), precision="highest"), 0, d)


def separable(matrices: Sequence[Array], y: Array, order: Sequence[int] | None = None) -> Array:
    """Apply one matrix along each axis, in ascending order or in `order`."""
    for d in range(len(matrices)) if order is None else order:
        y = along(matrices[d], y, d)
    return y


def extended(axes: Axes, bounds: Sequence[str]) -> tuple[int, ...]:
    """Return the number of samples along each axis for a circular convolution with these boundaries."""
    lengths = {"periodic": 1, "replicate": 3}
    return tuple(lengths.get(b, 2) * n for n, b in zip(shape(axes), bounds, strict=True))


def spectrum(samples: Array | np.ndarray, axes: Axes, bounds: Sequence[str], dtype: DTypeLike) -> Array:
    """Return the spectrum of a sampled kernel (odd counts: index (n - 1) / 2 is lag zero)."""
    sizes = extended(axes, bounds)
    kernel = jnp.asarray(samples, dtype)
    for d, (size, count) in enumerate(zip(sizes, kernel.shape, strict=True)):
        lags = np.arange(count) - (count - 1) // 2
        if bounds[d] == "zero":  # lags longer than the field have no effect
            keep = np.abs(lags) < axes[d].samples
            kernel, lags = jnp.take(kernel, np.flatnonzero(keep), axis=d), lags[keep]
        elif bounds[d] == "replicate":  # one length beyond an end all values are the outermost one
            lags = np.clip(lags, -axes[d].samples, axes[d].samples)
        wrap = np.zeros((size, len(lags)))
        np.add.at(wrap, (lags % size, np.arange(len(lags))), 1.0)
        kernel = along(jnp.asarray(wrap, dtype), kernel, d)
    return jnp.fft.rfftn(kernel * jnp.asarray(cell(axes), dtype))


def spectral(kernel: Array, y: Array, axes: Axes, bounds: Sequence[str], sizes: Sequence[int]) -> Array:
    """Convolve y with a kernel given by its spectrum on a periodic grid that is large enough to avoid
    overlap.
    """
    n = shape(axes)
    for d, b in enumerate(bounds):
        if b == "reflect":
            y = jnp.concatenate([y, jnp.flip(y, d)], axis=d)
        elif b == "replicate":
            sides = [(n[d], n[d]) if k == d else (0, 0) for k in range(y.ndim)]
            y = jnp.pad(y, sides, mode="edge")
    full = jnp.fft.irfftn(jnp.fft.rfftn(y, sizes) * kernel, sizes)
    starts = [k if b == "replicate" else 0 for k, b in zip(n, bounds, strict=True)]
    return full[tuple(slice(a, a + k) for a, k in zip(starts, n, strict=True))].astype(y.dtype)
