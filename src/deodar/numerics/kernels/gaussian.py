"""The Gaussian kernel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
from jax import Array

from deodar.leaves import on_axis, per_axis
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, signed
from deodar.numerics.kernels._base import Kernel, Term
from deodar.numerics.scalar import Scalar
from deodar.parameters import Live, PerAxis, Rebuild, Recompile
from deodar.registry import register

NARROWEST = 1e-6
"""Smallest width, in axis units; far below any grid step, so that the kernel acts within one cell."""


@register
@dataclass(frozen=True)
class Gaussian(Kernel):
    r"""A Gaussian kernel: local excitation (positive amplitude) or inhibition (negative amplitude).

    If normalized, the kernel is divided by its integral. If sigma is below the grid step, the samples are
    scaled so that their sum is the integral amplitude * prod_i sqrt(2 pi) sigma_i (without the scaling it
    would be 4 times too large at a tenth of a step).

    Equation:
        k(d) = \mathrm{amplitude} \prod_i \exp\!\left( -\frac{d_i^2}{2 \sigma_i^2} \right)

    Parameters:
        amplitude: weight at the centre, per unit of the axes; if normalized, the integral over all distances.
            On a node the self-excitation.
        sigma: width in axis units, one value or one for each axis; > 0.
        normalized: whether the amplitude is the integral.
        boundary: `periodic`, `zero`, `reflect` or `replicate`, one value or one for each axis; none:
            `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 2; Lomp et al. (2016), Front. Neurorobot. 10:14,
        eqs. 1 and 10.
    """

    amplitude: Annotated[
        float, Live("activation", meaning="weight at the centre, or the integral if normalized")
    ] = 1.0
    sigma: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST, meaning="width")] = 5.0
    normalized: Annotated[bool, Recompile(meaning="whether the amplitude is the kernel's integral")] = False

    def bounds(self, axes: Axes) -> Interval:
        return signed(self.amplitude * (1.0 if self.normalized else volume(self.sigma, axes)))

    def terms(self) -> Sequence[Term]:
        return (gaussian_term(self.amplitude, self.sigma, self.normalized),)

    def widths(self) -> Sequence[PerAxis]:
        return (self.sigma,)


def gaussian_term(amplitude: Scalar, sigma: PerAxis, normalized: bool) -> Term:
    """Return a Gaussian as one separable term."""

    def along(d: int, lag: Array, period: float | None, step: float) -> Array:
        s = on_axis(sigma, d)
        weight = profile(lag, s, period)
        return weight / integral(s, step) if normalized else weight * unresolved(s, step)

    return Term(amplitude, along)


def profile(lag: Array, sigma: Scalar, period: float | None) -> Array:
    """Return exp(-lag^2 / (2 sigma^2)); on a periodic axis the sum over all images, exact at every width."""
    if period is None:
        return jnp.exp(-0.5 * (lag / sigma) ** 2)
    folded_lag = (lag - period * jnp.round(lag / period))[..., None]
    images = jnp.sum(jnp.exp(-0.5 * ((folded_lag + period * jnp.arange(-4, 5)) / sigma) ** 2), axis=-1)
    # wide kernels: the same sum as a Fourier series, whose terms vanish where those of the images do not
    # (Poisson)
    turns = 2 * math.pi / period * jnp.arange(1, 5)
    waves = jnp.sum(jnp.exp(-0.5 * (turns * sigma) ** 2) * jnp.cos(turns * folded_lag), axis=-1)
    series = math.sqrt(2 * math.pi) * sigma / period * (1 + 2 * waves)
    return jnp.where(sigma < period / 2, images, series)


def integral(sigma: Scalar, step: float) -> Array:
    """Return the sum over an infinite grid times its step: sqrt(2 pi) sigma if the grid resolves the
    Gaussian, else the step.
    """
    ratio = step / sigma
    # below two steps the sum is computed directly (20 terms cover ten widths), above it equals the integral
    # to 1e-34
    lattice = jnp.sum(jnp.exp(-0.5 * (jnp.arange(1, 21) * ratio) ** 2))
    return jnp.where(ratio > 0.5, step * (1 + 2 * lattice), math.sqrt(2 * math.pi) * sigma)


def unresolved(sigma: Scalar, step: float) -> Array:
    """Return the factor that scales the samples of a Gaussian to its integral: 1 (to 5e-9) from a sigma of
    one step.
    """
    return jnp.where(sigma < step, math.sqrt(2 * math.pi) * sigma / integral(sigma, step), 1.0)


def volume(sigma: PerAxis, axes: Axes) -> float:
    """Return the integral of a Gaussian of height 1 over the axes; 1 on a node."""
    return math.prod(math.sqrt(2 * math.pi) * float(s) for s in per_axis(sigma, axes))
