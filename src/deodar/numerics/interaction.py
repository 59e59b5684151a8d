"""A sum of interaction kernels convolved with an output: the lateral interaction of a field, the kernel of a coupling.

In three steps, each as seldom as it may be: `prepare` makes weights from widths, `mix` puts amplitudes to them and adds up what can be
added, `apply` is all that is left for every step.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import jax.numpy as jnp

from deodar.numerics import convolution
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.kernels._base import Kernel, Term

Weights = list[Any]
"""For each kernel: its terms' matrices (one for each axis), or its spectrum."""

Mixture = dict[str, Any]
"""What is applied: `gain` on a node; else `terms` (for each its matrices, one an axis) and `spectra` (by boundaries)."""


def prepare(kernels: Sequence[Kernel], axes: Axes, dtype: Any) -> Weights:
    """What convolution needs and what depends on widths only."""
    return [_weights(kernel, axes, dtype) for kernel in kernels] if axes else []


def mix(kernels: Sequence[Kernel], axes: Axes, weights: Weights) -> Mixture:
    """The sum of the kernels, amplitudes included. Over one axis it is a single matrix, however many kernels there are."""
    if not axes:
        return {"gain": sum((t.amplitude for kernel in kernels for t in kernel.terms()), 0.0)}
    terms: list[list[Any]] = []
    spectra: dict[str, Any] = {}
    for kernel, w in zip(kernels, weights, strict=True):
        if isinstance(w, list):
            pairs: list[tuple[Term, list[Any]]] = list(zip(kernel.terms(), w, strict=True))
            terms += [[term.amplitude * matrices[0], *matrices[1:]] for term, matrices in pairs]
        else:
            key = " ".join(convolution.boundaries(kernel.boundary, axes))
            spectra[key] = spectra.get(key, 0.0) + kernel.amplitude * w  # type: ignore[attr-defined]
    if len(axes) == 1 and terms:
        terms = [[sum((t[0] for t in terms[1:]), terms[0][0])]]
    return {"terms": terms, "spectra": spectra}


def apply(mixture: Mixture, axes: Axes, y: Any) -> Any:
    """The integral k(x - x') y(x') dx' of the mixed kernels; on a node the sum of amplitudes times y."""
    if not axes:
        return mixture["gain"] * y
    total = jnp.zeros_like(y)
    for matrices in mixture["terms"]:
        total = total + convolution.separable(matrices, y)
    for bounds, spectrum in mixture["spectra"].items():
        total = total + convolution.spectral(spectrum, y, axes, bounds.split())
    return total


def _weights(kernel: Kernel, axes: Axes, dtype: Any) -> Any:
    bounds = convolution.boundaries(kernel.boundary, axes)
    samples = kernel.samples(axes, dtype)
    if samples is not None:
        return convolution.spectrum(samples, axes, bounds, dtype)
    return [[_matrix(t, d, a, b, dtype) for d, (a, b) in enumerate(zip(axes, bounds, strict=True))] for t in kernel.terms()]


def _matrix(term: Term, d: int, axis: Axis, boundary: str, dtype: Any) -> Any:
    return convolution.matrix(axis, boundary, lambda lag, period: term.along(d, lag, period, axis.step), dtype)
