"""A sum of interaction kernels convolved with an output: the lateral interaction of a field, the kernel of a coupling.

In three steps, each as seldom as it may be: `prepare` makes weights from widths, `mix` puts amplitudes to them and adds up what can be
added, `apply` is all that is left for every step. Kernels that are sums of Gaussians may share one transform (`choice`, `waves`); all
others, and all where results are to be exact, are matrices or spectra of their own.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Any

import jax.numpy as jnp

from deodar.leaves import per_axis
from deodar.numerics import convolution
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.choice import MANY, Choice, bounds, bucket, choose
from deodar.numerics.kernels._base import Kernel, Term
from deodar.numerics.waves import Waves

Weights = list[Any]
"""For each kernel: `spectrum`, or for each of its terms `matrices` (one an axis), `waves` or `spectra` (one vector an axis), or `taps`."""

Mixture = dict[str, Any]
"""What is applied: `gain` on a node; else `terms` (for each its matrices, one an axis), `spectra`, `waves` and `taps` (by boundaries)."""

Bucket = tuple[tuple[tuple[int, ...], ...], ...]
"""For each kernel, for each of its Gaussians, the bucket of its width on each axis."""


def buckets(kernels: Sequence[Kernel], axes: Axes) -> Hashable:
    """What of the widths a program is built for; None where none matters."""
    if not axes:
        return None
    found = tuple(tuple(tuple(bucket(float(w)) for w in per_axis(width, axes)) for width in k.widths()) for k in kernels)
    return found if choices(kernels, axes, found) or choices(kernels, axes, found, MANY) else None


def choices(kernels: Sequence[Kernel], axes: Axes, found: Any, copies: int = 1) -> dict[str, Choice]:
    """For each kind of boundaries, how its Gaussian kernels are applied together, where not by matrices. Without buckets: always by matrices."""
    groups: dict[str, list[tuple[tuple[int, ...], ...]]] = {}
    for kernel, widths in zip(kernels, found or [()] * len(kernels), strict=True):
        if widths:
            groups.setdefault(_key(kernel, axes), []).append(widths)
    out: dict[str, Choice] = {}
    for key, members in groups.items():
        terms = [term for widths in members for term in widths]
        spans = tuple((min(bounds(t[d])[0] for t in terms), max(bounds(t[d])[1] for t in terms)) for d in range(len(axes)))
        choice = choose(axes, tuple(key.split()), spans, len(terms), copies)
        if choice.way != "matrices":
            out[key] = choice
    return out


def prepare(kernels: Sequence[Kernel], axes: Axes, dtype: Any, chosen: dict[str, Choice] | None = None) -> Weights:
    """What convolution needs and what depends on widths only. `chosen` are the choices; without them it is exact."""
    if not axes:
        return []
    return [_weights(kernel, axes, dtype, (chosen or {}).get(_key(kernel, axes)) if kernel.widths() else None) for kernel in kernels]


def mix(kernels: Sequence[Kernel], axes: Axes, weights: Weights) -> Mixture:
    """The sum of the kernels, amplitudes included. Over one axis it is a single matrix, however many kernels there are."""
    if not axes:
        return {"gain": sum((t.amplitude for kernel in kernels for t in kernel.terms()), 0.0)}
    out: Mixture = {"terms": [], "spectra": {}, "waves": {}, "taps": {}}
    for kernel, w in zip(kernels, weights, strict=True):
        key = _key(kernel, axes)
        if "spectrum" in w:
            out["spectra"][key] = out["spectra"].get(key, 0.0) + kernel.amplitude * w["spectrum"]  # type: ignore[attr-defined]
        for term, matrices in zip(kernel.terms(), w.get("matrices", ()), strict=False):
            out["terms"].append([term.amplitude * matrices[0], *matrices[1:]])
        for way in ("waves", "spectra", "taps"):
            for term, gains in zip(kernel.terms(), w.get(way, ()), strict=False):
                out[way][key] = out[way].get(key, 0.0) + term.amplitude * _product(gains)
    if len(axes) == 1 and out["terms"]:
        out["terms"] = [[sum((t[0] for t in out["terms"][1:]), out["terms"][0][0])]]
    return out


def apply(mixture: Mixture, axes: Axes, y: Any, chosen: dict[str, Choice] | None = None) -> Any:
    """The integral k(x - x') y(x') dx' of the mixed kernels; on a node the sum of amplitudes times y. `chosen`: the choices they were made for."""
    if not axes:
        return mixture["gain"] * y
    parts = [convolution.separable(matrices, y) for matrices in mixture["terms"]]
    for key, spectrum in mixture["spectra"].items():
        sizes = [w.length for w in chosen[key].waves] if chosen and key in chosen else convolution.extended(axes, key.split())
        parts.append(convolution.spectral(spectrum, y, axes, key.split(), sizes))
    parts += [convolution.tapped(taps, y, key) for key, taps in mixture["taps"].items()]
    for key, gains in mixture["waves"].items():
        assert chosen is not None
        parts.append(_through(chosen[key].waves, gains, y))
    return sum(parts[1:], parts[0]) if parts else jnp.zeros_like(y)


def _through(waves: Sequence[Waves], gains: Any, y: Any) -> Any:
    """Into the space of waves, times what becomes of each, and back."""
    tables = [jnp.asarray(w.basis(), y.dtype) for w in waves]
    return convolution.separable(tables, gains * convolution.separable([t.T for t in tables], y))


def _key(kernel: Kernel, axes: Axes) -> str:
    return " ".join(convolution.boundaries(kernel.boundary, axes))


def _product(gains: Sequence[Any]) -> Any:
    """The outer product of one vector an axis."""
    out = gains[0]
    for g in gains[1:]:
        out = out[..., None] * g
    return out


def _weights(kernel: Kernel, axes: Axes, dtype: Any, choice: Choice | None) -> dict[str, Any]:
    ends = convolution.boundaries(kernel.boundary, axes)
    samples = kernel.samples(axes, dtype)
    if samples is not None:
        return {"spectrum": convolution.spectrum(samples, axes, ends, dtype)}
    if choice is None:
        return {"matrices": [[_matrix(t, d, a, b, dtype) for d, (a, b) in enumerate(zip(axes, ends, strict=True))] for t in kernel.terms()]}
    if choice.way == "taps":
        return {"taps": [[convolution.taps(axes[0], ends[0], _profile(t, 0, axes[0]), choice.reach, dtype)] for t in kernel.terms()]}
    if choice.way == "waves":
        return {
            "waves": [[w.gains(a, _profile(t, d, a), dtype) for d, (a, w) in enumerate(zip(axes, choice.waves, strict=True))] for t in kernel.terms()]
        }
    return {
        "spectra": [
            _half([w.spectrum(a, _profile(t, d, a), dtype) for d, (a, w) in enumerate(zip(axes, choice.waves, strict=True))]) for t in kernel.terms()
        ]
    }


def _half(gains: list[Any]) -> list[Any]:
    """The last axis of a real Fourier transform holds the first half of the waves only."""
    return [*gains[:-1], gains[-1][: gains[-1].shape[0] // 2 + 1]]


def _profile(term: Term, d: int, axis: Axis) -> Any:
    return lambda lag, period: term.along(d, lag, period, axis.step)


def _matrix(term: Term, d: int, axis: Axis, boundary: str, dtype: Any) -> Any:
    return convolution.matrix(axis, boundary, _profile(term, d, axis), dtype)
