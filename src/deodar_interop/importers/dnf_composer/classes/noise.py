"""Noise, white or correlated in space."""

from __future__ import annotations

import math

from deodar.couplings.convolutions import Convolve
from deodar.elements.changing_stimuli import Noise
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import TruncatedGaussian
from deodar_interop.importers._element import translates
from deodar_interop.importers._piece import axes
from deodar_interop.importers.dnf_composer import taps
from deodar_interop.importers.dnf_composer.classes.stimuli import boundary
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.taps import CUTOFF

NARROW = 0.001
"""Width below which the reach of correlated noise does not shrink."""


@translates("normal noise", "normal noise 2d")
def normal_noise(b: StoredElement) -> None:
    """Translate `normal noise` and its form over a plane: the same strength, since the step of axes is 1."""
    dims = b.dims()
    b.outlet("output", b.add(Noise(b.label, axes(dims), _strength(b, 0.2)), dims), noise=True)


@translates("correlated normal noise", "correlated normal noise 2d")
def correlated_noise(b: StoredElement) -> None:
    """Translate `correlated normal noise` and its form over a plane: white noise, convolved."""
    dims = b.dims()
    strength, width = _strength(b, 0.05), b.values.width("width", 1)
    circular = b.values.flag("circular", True)
    kernel: Kernel
    if b.plane:
        kernel = TruncatedGaussian(
            1.0, width, CUTOFF, normalized=True, boundary=boundary(axes(dims), circular)
        )
    else:
        half = max(1, int(min(CUTOFF * max(width, NARROW), 1e12)))
        count = b.counts[1]
        if circular and half > count:
            b.values.say("width", "carried", "longer than the axis; the output is 0, as in dnf-composer")
            strength = 0.0
        kernel = _line(b, width, min(half, 2 * count), circular)
        if not circular and half > 2 * count:
            b.values.say("width", "approximated", "normalised over twice the length of the axis on each side")
    white = b.add(Noise(b.named("white"), axes(dims), strength), dims)
    b.outlet("output", b.add(Convolve([kernel], name=b.label), input=white), noise=True)
    b.explain("Convolve and Noise")


def _line(b: StoredElement, width: float, half: int, circular: bool) -> Kernel:
    """Return the kernel of a line; it may be longer than the axis, and all its weights are normalised."""
    line_axes, count = axes(b.of(b.counts)), b.counts[1]
    ends = boundary(line_axes, circular)
    if not line_axes:
        return TruncatedGaussian(1.0, width, normalized=True)
    if half <= ((count - 1) // 2 if circular else count - 1):
        return TruncatedGaussian(1.0, width, 0.0, float(half), normalized=True, boundary=ends)
    b.budget.take(2 * half + 1)
    return Custom(taps.gaussian(width, half, half, True).weights, boundary=ends)


def _strength(b: StoredElement, default: float) -> float:
    """Return the amplitude; its sign has no effect on noise."""
    return math.fabs(b.values.number("amplitude", default))
