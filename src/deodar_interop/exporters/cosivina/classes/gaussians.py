"""Kernels of the document as the Gaussians of samples that cosivina has."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Sequence

from deodar.leaves import per_axis
from deodar.numerics.axes import Axes, cell
from deodar.numerics.convolution import boundaries
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.separable import (
    NARROWEST,
    Gaussian,
    MexicanHat,
    Shifted,
    TruncatedGaussian,
    integral,
    unresolved,
)
from deodar_interop.exporters.cosivina.draft import Given
from deodar_interop.exporters.cosivina.layout import circular, is_row, widths
from deodar_interop.importers._piece import Dims

REACH = 10.0
"""Cutoff, in widths, at which a Gaussian is 2e-22 of its height: nothing is lost."""

ALONE = 7.5
"""Half a ring, in widths, from which the images of a Gaussian have no effect (6e-13 of its height)."""

NEAR = 4.0
"""Half a ring, in widths, from which a Gaussian without its images is an approximation (3e-4 of its height);
below, a matrix holds its weights.
"""


@dc.dataclass(frozen=True)
class Bell:
    """A Gaussian as cosivina has it, in samples.

    Attributes:
        amplitude: of one sample, or the sum over all samples if normalized.
        sigmas, rings: width and whether the space wraps, for each axis.
        normalized, cutoff: as in cosivina.
        least: smallest reach in samples, for each axis.
        shift: how far it is moved, in samples; None: it is not.
        paired: whether it comes from a file, which has two of them in one element.
    """

    amplitude: float
    sigmas: tuple[float, ...]
    rings: tuple[bool, ...]
    normalized: bool
    cutoff: float
    least: tuple[float, ...] = ()
    shift: float | None = None
    paired: bool = False

    @property
    def form(self) -> tuple[object, ...]:
        """What two Gaussians of one element share."""
        return self.rings, self.normalized, self.cutoff, self.shift

    @classmethod
    def nothing(cls, axes: Axes, normalized: bool) -> Bell:
        """Return a Gaussian without an amplitude."""
        return cls(0.0, (1.0,) * len(axes), tuple(circular(axes, None)), normalized, 5.0)

    def common(self, other: Bell) -> bool:
        """Return whether two Gaussians have the reach of the wider one with an amplitude, as in a row."""
        if not self.least:
            return True
        reach = self.cutoff * max(
            (bell.amplitude != 0) * max(*bell.sigmas[-1:], NARROWEST) for bell in (self, other)
        )
        return self.least[-1] == other.least[-1] == reach


@dc.dataclass(frozen=True)
class Bells:
    """The Gaussians among several kernels, whether they are normalized, and the other kernels."""

    bells: list[Bell]
    others: list[Kernel]
    normalized: bool


def bells(b: Given, axes: Axes, dims: Dims, kernels: Sequence[Kernel]) -> Bells:
    """Return kernels as Gaussians of samples, and those that are none."""
    found: list[tuple[Kernel, list[TruncatedGaussian | Gaussian]]] = []
    others: list[Kernel] = []
    for kernel in kernels:
        parts = _gaussians(kernel)
        ends = boundaries(kernel.boundary, axes)
        half = min((_half(p, axes, ends) for p in parts if isinstance(p, Gaussian)), default=math.inf)
        if not parts or "reflect" in ends or (is_row(dims) and half < NEAR):
            others.append(kernel)
            continue
        if half < ALONE:
            b.approximate(f"a kernel has no images on its ring, {math.exp(-0.5 * half**2):.0e} of its height")
        found.append((kernel, parts))
    exact = all(_normalizable(p, axes, boundaries(k.boundary, axes)) for k, ps in found for p in ps)
    out = [_bell(p, k, axes, exact) for k, ps in found for p in ps]
    return Bells(out, others, exact)


def _gaussians(kernel: Kernel) -> list[TruncatedGaussian | Gaussian]:
    """Return the Gaussians that a kernel is a sum of; none if it is no such sum."""
    if isinstance(kernel, (Gaussian, TruncatedGaussian)):
        return [kernel]
    if isinstance(kernel, MexicanHat):
        return [
            Gaussian(kernel.excitation, kernel.sigma_excitation, kernel.normalized),
            Gaussian(-kernel.inhibition, kernel.sigma_inhibition, kernel.normalized),
        ]
    if isinstance(kernel, Shifted) and isinstance(kernel.kernel, TruncatedGaussian):
        return [kernel.kernel]
    return []


def _half(part: Gaussian, axes: Axes, ends: Sequence[str]) -> float:
    """Return half of the ring on which a Gaussian is widest, in widths; infinite without a ring."""
    return min(
        (
            a.samples / (2 * max(s, NARROWEST))
            for a, end, s in zip(axes, ends, widths(axes, part.sigma), strict=True)
            if end == "periodic"
        ),
        default=math.inf,
    )


def _normalizable(part: TruncatedGaussian | Gaussian, axes: Axes, ends: Sequence[str]) -> bool:
    """Return whether cosivina's sum over the samples that are reached is the one that normalizes it here."""
    if isinstance(part, TruncatedGaussian):
        return part.normalized
    return part.normalized and all(
        a.samples - 1 >= (2 * NEAR if end == "periodic" else ALONE) * s
        for a, end, s in zip(axes, ends, widths(axes, part.sigma), strict=True)
    )


def _bell(part: TruncatedGaussian | Gaussian, kernel: Kernel, axes: Axes, exact: bool) -> Bell:
    sigmas = tuple(widths(axes, part.sigma))
    rings = tuple(circular(axes, kernel.boundary))
    shift = None
    if isinstance(kernel, Shifted):
        shift = per_axis(kernel.shift, axes)[0] / axes[0].step
    if isinstance(part, TruncatedGaussian):
        steps = [a.step for a in axes] or [1.0]
        least = tuple(v / step for step, v in zip(steps, per_axis(part.least, steps), strict=True))
        amplitude = part.amplitude if part.normalized else part.amplitude * cell(axes)
        return Bell(amplitude, sigmas, rings, part.normalized, part.cutoff, least, shift, True)
    if part.normalized and exact:
        return Bell(part.amplitude, sigmas, rings, True, REACH)
    amplitude = part.amplitude * cell(axes)
    for a, s in zip(axes, per_axis(part.sigma, axes), strict=True):
        amplitude *= 1 / float(integral(s, a.step)) if part.normalized else float(unresolved(s, a.step))
    return Bell(amplitude, sigmas, rings, False, REACH)
