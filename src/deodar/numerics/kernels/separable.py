"""Kernels that are sums of separable terms."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.leaves import is_neutral, on_axis, per_axis
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, hull, signed
from deodar.numerics.kernels._base import Kernel, Term, is_sampled
from deodar.numerics.scalar import Scalar
from deodar.parameters import Live, PerAxis, Rebuild
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
        amplitude: weight at the centre; per unit of the axes; if normalized, the integral over all distances.
            On a node the self-excitation.
        sigma: width; in axis units, one value or one for each axis, > 0.
        normalized: whether the amplitude is the integral.
        boundary: what lies beyond the border; `periodic`, `zero`, `reflect` or `replicate`, one value or one
            for each axis; none: `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 2; Lomp et al. (2016), Front. Neurorobot. 10:14,
        eqs. 1 and 10.
    """

    amplitude: Annotated[float, Live("activation")] = 1.0
    sigma: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST)] = 5.0
    normalized: bool = False

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


ROUNDING = 1e-5
"""Tolerance for rounding in single precision of a whole number of steps, as a share of a step."""


@register
@dataclass(frozen=True)
class TruncatedGaussian(Kernel):
    r"""A Gaussian kernel of finite reach, normalised over its samples, as in many published simulations.

    The reach is rounded up to whole steps and limited to the length of the axis. If normalized, each factor
    is divided by its sum over these samples times the step. On a periodic axis d_i is the shorter distance.

    Equation:
        k(d) = \begin{cases} \mathrm{amplitude} \prod_i e^{-d_i^2 / (2 \sigma_i^2)} & |d_i| \le
            \mathrm{reach}_i \\ 0 & \text{else} \end{cases}
        \mathrm{reach}_i = \max(\mathrm{cutoff}\, \sigma_i, \mathrm{least}_i)

    Parameters:
        amplitude: weight at the centre; per unit of the axes; if normalized, the sum over all samples reached
            times the steps. On a node the self-excitation.
        sigma: width; in axis units, one value or one for each axis, > 0. Far below the step the kernel acts
            within one cell.
        cutoff: reach as a multiple of the width; >= 0.
        least: smallest reach; in axis units, one value or one for each axis: for a narrow Gaussian with the
            reach of a wider one.
        normalized: whether the amplitude is the kernel's integral.
        boundary: what lies beyond the border; `periodic`, `zero`, `reflect` or `replicate`, one value or one
            for each axis; none: `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 2, sampled and truncated.
    """

    amplitude: Annotated[float, Live("activation", neutral=0.0)] = 1.0
    sigma: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST)] = 5.0
    cutoff: Annotated[float, Rebuild(lower=0)] = 5.0
    least: Annotated[PerAxis, Rebuild("axis", lower=0)] = 0.0
    normalized: bool = False

    def bounds(self, axes: Axes) -> Interval:
        wide = math.prod(
            math.sqrt(2 * math.pi) * float(s) + a.step
            for s, a in zip(per_axis(self.sigma, axes), axes, strict=True)
        )
        return signed(self.amplitude * (1.0 if self.normalized else wide))

    def terms(self) -> Sequence[Term]:
        return () if is_neutral(self.amplitude) else (Term(self.amplitude, self._along),)

    def _along(self, d: int, lag: Array, period: float | None, step: float) -> Array:
        sigma, least = on_axis(self.sigma, d), on_axis(self.least, d)
        slack = ROUNDING if lag.dtype == jnp.float32 else 0.0
        reach = jnp.ceil(jnp.maximum(self.cutoff * sigma, least) / step - slack) + 0.5

        def weight(distance: Array) -> Array:
            return jnp.where(distance / step <= reach, jnp.exp(-0.5 * (distance / sigma) ** 2), 0.0)

        distance = jnp.abs(lag if period is None else lag - period * jnp.round(lag / period))
        if not self.normalized:
            return weight(distance)
        # the distances that occur: one period, or the length of the axis on either side
        count = lag.shape[0] if period is None else round(period / step)
        lags = np.arange(count)
        lags = np.minimum(lags, count - lags) if period is not None else np.concatenate([lags[:0:-1], lags])
        return weight(distance) / (jnp.sum(weight(jnp.asarray(lags * step, lag.dtype))) * step)


@register
@dataclass(frozen=True)
class MexicanHat(Kernel):
    r"""A difference of two Gaussians: local excitation and wider inhibition.

    If normalized, each Gaussian is divided by its integral.

    Equation:
        k(d) = \mathrm{excitation} \exp\!\left( -\frac{d^2}{2 \sigma_{\mathrm{excitation}}^2}
            \right)
        \quad {} - \mathrm{inhibition} \exp\!\left( -\frac{d^2}{2 \sigma_{\mathrm{inhibition}}^2}
            \right)

    Parameters:
        excitation: weight of the excitation at the centre; its integral if normalized.
        sigma_excitation: width of the excitation; in axis units, one value or one for each axis, > 0.
        inhibition: weight of the inhibition at the centre, counted positive; its integral if normalized.
        sigma_inhibition: width of the inhibition; in axis units, one value or one for each axis, > 0.
        normalized: whether the weights are integrals.
        boundary: what lies beyond the border; `periodic`, `zero`, `reflect` or `replicate`, one value or one
            for each axis; none: `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 2.
    """

    excitation: Annotated[float, Live("activation")] = 15.0
    sigma_excitation: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST)] = 5.0
    inhibition: Annotated[float, Live("activation")] = 8.0
    sigma_inhibition: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST)] = 10.0
    normalized: bool = False

    def bounds(self, axes: Axes) -> Interval:
        up, down = (
            1.0 if self.normalized else volume(s, axes)
            for s in (self.sigma_excitation, self.sigma_inhibition)
        )
        return hull(signed(self.excitation * up), signed(-self.inhibition * down))

    def terms(self) -> Sequence[Term]:
        return (
            gaussian_term(self.excitation, self.sigma_excitation, self.normalized),
            gaussian_term(-self.inhibition, self.sigma_inhibition, self.normalized),
        )

    def widths(self) -> Sequence[PerAxis]:
        return (self.sigma_excitation, self.sigma_inhibition)


@register
@dataclass(frozen=True)
class Box(Kernel):
    r"""A kernel of constant weight for distances up to half its width.

    A cell that is partly inside the box counts with the part of its width that is inside.

    Equation:
        k(d) = \begin{cases} \mathrm{amplitude} & |d_i| < \frac{\mathrm{width}_i}{2} \ \forall i \\ 0 &
            \text{else} \end{cases}

    Parameters:
        amplitude: weight inside; per unit of the axes; if normalized, the integral over all distances.
        width: full width; in axis units, one value or one for each axis, > 0.
        normalized: whether the amplitude is the integral.
        boundary: what lies beyond the border; `periodic`, `zero`, `reflect` or `replicate`, one value or one
            for each axis; none: `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        no reference
    """

    amplitude: Annotated[float, Live("activation")] = 1.0
    width: Annotated[PerAxis, Rebuild("axis", lower=NARROWEST)] = 10.0
    normalized: bool = False

    def bounds(self, axes: Axes) -> Interval:
        return signed(
            self.amplitude
            * (1.0 if self.normalized else math.prod(float(w) for w in per_axis(self.width, axes)))
        )

    def terms(self) -> Sequence[Term]:
        def along(d: int, lag: Array, period: float | None, step: float) -> Array:
            w = on_axis(self.width, d)
            weight = _covered(lag, w, period, step)
            return weight / w if self.normalized else weight

        return (Term(self.amplitude, along),)


def _covered(lag: Array, width: float, period: float | None, step: float) -> Array:
    """Return the share of the cell around `lag` that is inside the box; on a periodic axis the box may
    overlap itself.
    """
    if period is None:
        return _overlap(lag, width, step)
    turns = jnp.floor(width / period)
    # after an odd number of turns the ends meet opposite the centre
    lag = lag - jnp.mod(turns, 2) * period / 2
    folded_lag = lag - period * jnp.round(lag / period)
    remainder = width - turns * period
    return turns + sum(_overlap(folded_lag + k * period, remainder, step) for k in (-1, 0, 1))


def _overlap(lag: Array, width: Scalar, step: float) -> Array:
    upper = jnp.minimum(lag + step / 2, width / 2)
    lower = jnp.maximum(lag - step / 2, -width / 2)
    return jnp.maximum(0.0, upper - lower) / step


@register
@dataclass(frozen=True)
class Shifted(Kernel):
    r"""A kernel shifted by a fixed amount: a peak at x acts around x + shift.

    Equation:
        k(d) = \mathrm{inner}(d - \mathrm{shift})

    Parameters:
        kernel: the inner kernel; a sum of separable terms (not a custom array).
        shift: the shift; in axis units, one value or one for each axis.
        boundary: what lies beyond the border; `periodic`, `zero`, `reflect` or `replicate`, one value or one
            for each axis; none: `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), appendix
        A (the shifts between its fields).
    """

    kernel: Kernel = Gaussian()
    shift: Annotated[PerAxis, Rebuild("axis")] = 0.0

    def bounds(self, axes: Axes) -> Interval:
        return self.kernel.bounds(axes)

    def terms(self) -> Sequence[Term]:
        return [Term(t.amplitude, self._moved(t)) for t in self.kernel.terms()]

    def _moved(self, term: Term) -> Callable[[int, Array, float | None, float], Array]:
        def along(d: int, lag: Array, period: float | None, step: float) -> Array:
            return term.along(d, lag - on_axis(self.shift, d), period, step)

        return along

    def validate(self) -> Iterator[tuple[str, str]]:
        if is_sampled(self.kernel):
            yield "kernel", "an array of weights cannot be shifted; shift the array itself"
        if self.kernel.boundary is not None:
            yield (
                "kernel.boundary",
                "belongs to the shifted kernel: give it to Shifted itself",
            )

    def validate_axes(self, axes: Axes) -> Iterator[str]:
        yield from super().validate_axes(axes)
        yield from self.kernel.validate_axes(axes)
