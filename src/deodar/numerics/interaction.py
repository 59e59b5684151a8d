"""A sum of interaction kernels convolved with an output: the lateral interaction of a field, the kernel of a
coupling.

It has three stages, each run as rarely as possible: `prepare` computes weights from widths, `mix` multiplies
them by amplitudes and sums them where possible, `apply` runs in every step. Kernels that are sums of
Gaussians may share one transform (`choice`, `waves`); all others, and all kernels in exact mode, have their
own matrices or spectra.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import NamedTuple, TypeAlias, TypedDict

import jax.numpy as jnp
from jax import Array
from jax.typing import DTypeLike

from deodar.leaves import per_axis
from deodar.numerics import convolution
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.choice import Choice, Shards, bounds, bucket, choose
from deodar.numerics.kernels._base import Kernel, Term, sampled, samples_amplitude
from deodar.numerics.native import Kernels
from deodar.numerics.scalar import Scalar
from deodar.numerics.transforms import from_waves, to_waves


class KernelWeights(TypedDict, total=False):
    """The weights of one kernel, in one of these forms.

    Attributes:
        spectrum: of a sampled kernel.
        matrices: for each term one matrix per axis.
        waves, spectra: for each term one vector per axis.
        taps: for each term the weights of its lags, one vector per axis.
    """

    spectrum: Array
    matrices: list[list[Array]]
    waves: list[list[Array]]
    spectra: list[list[Array]]
    taps: list[list[Array]]


class NodeMixture(TypedDict):
    """The mixed weights on a node: the sum of the amplitudes."""

    gain: Scalar


class FieldMixture(TypedDict):
    """The mixed weights over axes.

    Attributes:
        terms: for each term one matrix per axis.
        amplitudes: for each term its amplitude, where the matrices are not multiplied by it; else empty.
        spectra, waves: the sum for each kind of boundaries.
        taps: for each kind of boundaries and each term one vector per axis; over one axis the sum.
    """

    terms: list[list[Array]]
    amplitudes: list[Scalar]
    spectra: dict[str, Array]
    waves: dict[str, Array]
    taps: dict[str, list[list[Array]]]


class SharedModes(NamedTuple):
    """What an array shares with others as spectral modes.

    Attributes:
        key: the boundaries of the kernels with these modes.
        own: the array as modes.
        arriving: modes that are added before the inverse transform.
    """

    key: str
    own: Array | None
    arriving: Array | None


Tapped: TypeAlias = Callable[[Array, Array, str, int], Array]
"""A convolution by lags along one axis: weights, array, boundary and axis, as `convolution.tapped`."""

Mixture: TypeAlias = NodeMixture | FieldMixture
"""The mixed weights of several kernels."""


def buckets(kernels: Sequence[Kernel]) -> Hashable:
    """Return the buckets of the widths; widths may change without recompiling while it is equal."""
    return tuple(
        tuple(
            tuple(bucket(float(w)) for w in (width if isinstance(width, Sequence) else (width,)))
            for width in k.widths()
        )
        for k in kernels
    )


def spans(kernels: Sequence[Kernel], axes: Axes) -> dict[str, list[tuple[tuple[float, float], ...]]]:
    """Return, for each kind of boundaries and each of its Gaussians, the smallest and largest width of its
    bucket along each axis.

    Kernels with a replicated end have matrices only: no transform continues a field with its last value.
    """
    out: dict[str, list[tuple[tuple[float, float], ...]]] = {}
    for kernel in kernels if axes else ():
        ends = boundaries(kernel, axes)
        for width in kernel.widths() if "replicate" not in ends.split() else ():
            out.setdefault(ends, []).append(tuple(bounds(bucket(float(w))) for w in per_axis(width, axes)))
    return out


def covering(widths: Sequence[tuple[tuple[float, float], ...]]) -> tuple[tuple[float, float], ...]:
    """Return the smallest and the largest width of all Gaussians along each axis."""
    return tuple(
        (min(low for low, _ in axis), max(high for _, high in axis)) for axis in zip(*widths, strict=True)
    )


def choices(
    kernels: Sequence[Kernel], axes: Axes, copies: int = 1, shards: Shards | None = None
) -> dict[str, Choice]:
    """Return, for each kind of boundaries, the joint strategy of its Gaussian kernels, if not matrices;
    `shards` is an axis that devices divide.
    """
    strategies = {
        key: choose(axes, tuple(key.split()), covering(terms), len(terms), copies, shards)
        for key, terms in spans(kernels, axes).items()
    }
    return {key: choice for key, choice in strategies.items() if choice.method != "matrices"}


def prepare(
    kernels: Sequence[Kernel], axes: Axes, dtype: DTypeLike, chosen: Mapping[str, Choice] | None = None
) -> list[KernelWeights]:
    """Return the weights of the convolution that depend on widths only, for each kernel.

    `chosen` are the choices; without them the convolution is exact.
    """
    if not axes:
        return []
    return [
        _weights(
            kernel, axes, dtype, (chosen or {}).get(boundaries(kernel, axes)) if kernel.widths() else None
        )
        for kernel in kernels
    ]


def mix(
    kernels: Sequence[Kernel], axes: Axes, weights: Sequence[KernelWeights], apart: bool = False
) -> Mixture:
    """Return the sum of the kernels, multiplied by their amplitudes.

    Over one axis it is a single matrix, whatever the number of kernels. With `apart` matrices stay as they
    are, so that copies that differ by amplitudes alone share them.
    """
    if not axes:
        return {"gain": sum((t.amplitude for kernel in kernels for t in kernel.terms()), 0.0)}
    out: FieldMixture = {"terms": [], "amplitudes": [], "spectra": {}, "waves": {}, "taps": {}}
    for kernel, w in zip(kernels, weights, strict=True):
        key = boundaries(kernel, axes)
        if "spectrum" in w:
            scaled = samples_amplitude(kernel) * w["spectrum"]
            out["spectra"][key] = out["spectra"].get(key, 0.0) + scaled
        for term, matrices in zip(kernel.terms(), w.get("matrices", ()), strict=False):
            if apart:
                out["terms"].append(matrices)
                out["amplitudes"].append(term.amplitude)
            else:
                out["terms"].append([term.amplitude * matrices[0], *matrices[1:]])
        for method in ("waves", "spectra"):
            for term, gains in zip(kernel.terms(), w.get(method, ()), strict=False):
                out[method][key] = out[method].get(key, 0.0) + term.amplitude * _product(gains)
        for term, taps in zip(kernel.terms(), w.get("taps", ()), strict=False):
            out["taps"].setdefault(key, []).append([term.amplitude * taps[0], *taps[1:]])
    if len(axes) == 1:
        if out["terms"] and not apart:
            out["terms"] = _summed(out["terms"])
        out["taps"] = {key: _summed(terms) for key, terms in out["taps"].items()}
    return out


def _summed(terms: Sequence[Sequence[Array]]) -> list[list[Array]]:
    """Return the sum of terms over one axis, as a single term."""
    return [[sum((t[0] for t in terms[1:]), terms[0][0])]]


def apply(
    mixture: Mixture,
    axes: Axes,
    y: Array,
    chosen: Mapping[str, Choice] | None = None,
    shared: SharedModes | None = None,
    kernels: Kernels | None = None,
    tapped: Tapped | None = None,
) -> Array:
    """Return the integral k(x - x') y(x') dx' of the mixed kernels; on a node the sum of amplitudes times y.

    `chosen` are the choices with which the kernels were prepared, `shared` the modes that this array shares
    with others. `kernels` are compiled kernels for what is expensive, if there are any. `tapped` convolves
    along one axis by lags.
    """
    key, own_modes, arriving = shared or ("", None, None)
    if "gain" in mixture:
        return mixture["gain"] * y
    parts = [convolution.separable(matrices, y) for matrices in mixture["terms"]]
    if mixture["amplitudes"]:
        parts = [a * part for a, part in zip(mixture["amplitudes"], parts, strict=True)]
    for ends, spectrum in mixture["spectra"].items():
        sizes = (
            [w.length for w in chosen[ends].waves]
            if chosen and ends in chosen
            else convolution.extended(axes, ends.split())
        )
        parts.append(convolution.spectral(spectrum, y, axes, ends.split(), sizes))
    parts += [
        _tapped(taps, y, ends.split(), tapped or functools.partial(convolution.tapped, kernels=kernels))
        for ends, terms in mixture["taps"].items()
        for taps in terms
    ]
    for ends, gains in mixture["waves"].items():
        assert chosen is not None
        waves = gains * (
            own_modes if own_modes is not None and ends == key else to_waves(chosen[ends].waves, y, kernels)
        )
        if arriving is not None and ends == key:
            waves, arriving = waves + arriving, None
        parts.append(from_waves(chosen[ends].waves, waves, kernels))
    if arriving is not None:
        assert chosen is not None
        parts.append(from_waves(chosen[key].waves, arriving, kernels))
    return sum(parts[1:], parts[0]) if parts else jnp.zeros_like(y)


def boundaries(kernel: Kernel, axes: Axes) -> str:
    """Return the kind of boundaries of a kernel, one word per axis."""
    return " ".join(convolution.boundaries(kernel.boundary, axes))


def _tapped(taps: Sequence[Array], y: Array, ends: Sequence[str], along: Tapped) -> Array:
    """Convolve along each axis in turn, the first one last: its rows have no padding, so that XLA fuses the
    sum with what reads it.
    """
    for d in reversed(range(len(taps))):
        y = along(taps[d], y, ends[d], d)
    return y


def _product(gains: Sequence[Array]) -> Array:
    """Return the outer product of one vector per axis."""
    out = gains[0]
    for g in gains[1:]:
        out = out[..., None] * g
    return out


def _weights(kernel: Kernel, axes: Axes, dtype: DTypeLike, choice: Choice | None) -> KernelWeights:
    ends = convolution.boundaries(kernel.boundary, axes)
    samples = sampled(kernel, axes, dtype)
    if samples is not None:
        return {"spectrum": convolution.spectrum(samples, axes, ends, dtype)}
    if choice is None:
        return {
            "matrices": [
                [_matrix(t, d, a, b, dtype) for d, (a, b) in enumerate(zip(axes, ends, strict=True))]
                for t in kernel.terms()
            ]
        }
    if choice.method == "taps":
        return {
            "taps": [
                [
                    convolution.taps(a, end, _profile(t, d, a), reach, dtype)
                    for d, (a, end, reach) in enumerate(zip(axes, ends, choice.reaches, strict=True))
                ]
                for t in kernel.terms()
            ]
        }
    if choice.method == "waves":
        return {
            "waves": [
                [
                    w.gains(a, _profile(t, d, a), dtype)
                    for d, (a, w) in enumerate(zip(axes, choice.waves, strict=True))
                ]
                for t in kernel.terms()
            ]
        }
    return {
        "spectra": [
            _half(
                [
                    w.spectrum(a, _profile(t, d, a), dtype)
                    for d, (a, w) in enumerate(zip(axes, choice.waves, strict=True))
                ]
            )
            for t in kernel.terms()
        ]
    }


def _half(gains: list[Array]) -> list[Array]:
    """Keep the first half of the modes along the last axis, as in a real Fourier transform."""
    return [*gains[:-1], gains[-1][: gains[-1].shape[0] // 2 + 1]]


def _profile(term: Term, d: int, axis: Axis) -> convolution.Profile:
    return lambda lag, period: term.along(d, lag, period, axis.step)


def _matrix(term: Term, d: int, axis: Axis, boundary: str, dtype: DTypeLike) -> Array:
    return convolution.matrix(axis, boundary, _profile(term, d, axis), dtype)
