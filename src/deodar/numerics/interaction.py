"""A sum of interaction kernels convolved with an output: the lateral interaction of a field, the kernel of a coupling."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import jax.numpy as jnp

from deodar.numerics import convolution
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.kernels._base import Kernel, Term

Weights = list[Any]
"""For each kernel: its terms' matrices (one for each axis), or its spectrum."""


def prepare(kernels: Sequence[Kernel], axes: Axes, dtype: Any) -> Weights:
    """What convolution needs and what depends on widths only."""
    return [_weights(kernel, axes, dtype) for kernel in kernels] if axes else []


def _weights(kernel: Kernel, axes: Axes, dtype: Any) -> Any:
    bounds = convolution.boundaries(kernel.boundary, axes)
    samples = kernel.samples(axes, dtype)
    if samples is not None:
        return convolution.spectrum(samples, axes, bounds, dtype)
    return [[_matrix(t, d, a, b, dtype) for d, (a, b) in enumerate(zip(axes, bounds, strict=True))] for t in kernel.terms()]


def _matrix(term: Term, d: int, axis: Axis, boundary: str, dtype: Any) -> Any:
    return convolution.matrix(axis, boundary, lambda lag, period: term.along(d, lag, period, axis.step), dtype)


def apply(kernels: Sequence[Kernel], axes: Axes, weights: Weights, y: Any) -> Any:
    """Sum over kernels of the integral k(x - x') y(x') dx'; on a node the sum of amplitudes times y."""
    total = jnp.zeros_like(y)
    if not axes:
        return total + sum((t.amplitude for kernel in kernels for t in kernel.terms()), 0.0) * y
    for kernel, w in zip(kernels, weights, strict=True):
        if isinstance(w, list):
            for term, matrices in zip(kernel.terms(), w, strict=True):
                total = total + term.amplitude * convolution.separable(matrices, y)
        else:
            bounds = convolution.boundaries(kernel.boundary, axes)
            total = total + kernel.amplitude * convolution.spectral(w, y, axes, bounds)  # type: ignore[attr-defined]
    return total
