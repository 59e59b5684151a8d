"""Kernels: convolutions of the input, plus its sum times a constant."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from deodar.couplings.convolutions import Interaction
from deodar.elements.stimuli import Pattern
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import TruncatedGaussian
from deodar_interop.importers._element import translates
from deodar_interop.importers._piece import Dims, axes
from deodar_interop.importers.dnf_composer import taps
from deodar_interop.importers.dnf_composer.classes.stimuli import boundary
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.taps import CUTOFF, Taps

SLOWEST = 0.01
"""Decay in place of one that is not above 0."""


@translates("gauss kernel", "gauss kernel 2d")
def gauss(b: StoredElement) -> None:
    """Translate `gauss kernel` and its form over a plane."""
    form = StoredKernel(b)
    amplitude, width = b.values.number("amplitude", 3), b.values.width("width", 3)
    form.add(
        [form.truncated(amplitude, width)],
        lambda: amplitude * outer([form.gaussian(d, width).weights for d in (0, 1)]),
    )


@translates("mexican hat kernel", "mexican hat kernel 2d")
def mexican_hat(b: StoredElement) -> None:
    """Translate `mexican hat kernel`: over a line both Gaussians have the reach of the wider one with an
    amplitude, over a plane each has its own.
    """
    form = StoredKernel(b)
    up, down = b.values.number("amplitudeExc", 11), b.values.number("amplitudeInh", 15)
    narrow, wide = b.values.width("widthExc", 2.5), b.values.width("widthInh", 5)
    common = 0.0 if b.plane else max((up != 0) * narrow, (down != 0) * wide)
    least = CUTOFF * common

    def weights_of_form() -> np.ndarray:
        pairs = ((up, narrow), (-down, wide))
        parts = [
            amplitude * outer([form.gaussian(d, width, common or width).weights for d in (0, 1)])
            for amplitude, width in pairs
        ]
        return parts[0] + parts[1] if parts[0].shape == parts[1].shape else parts[0]

    form.add([form.truncated(up, narrow, least), form.truncated(-down, wide, least)], weights_of_form)


@translates("oscillatory kernel", "oscillatory kernel 2d")
def oscillatory(b: StoredElement) -> None:
    """Translate `oscillatory kernel`; over a line its sum is divided out with its amplitude if normalized."""
    form = StoredKernel(b)
    amplitude = b.values.number("amplitude", 1)
    decay, crossings = b.values.number("decay", 0.08), b.values.number("zeroCrossings", 0.3, 0, 1)
    if decay <= 0:
        b.values.say("decay", "carried", f"{SLOWEST:g} in place of {decay:g}, as in dnf-composer")
        decay = SLOWEST
    form.reserve(taps.oscillation_width(decay, crossings))
    profiles = [taps.oscillation(decay, crossings, count, form.circular) for count in b.counts]
    if form.normalized:
        profiles = [taps.per_sum(part) for part in profiles]
        if not b.plane and amplitude:
            if "amplitude" in b.element.values:
                b.values.say(
                    "amplitude", "carried", "without effect in a normalized kernel, as in dnf-composer"
                )
            amplitude = 1.0
    form.add_custom(amplitude, profiles)


@translates("asymmetric gauss kernel", "asymmetric gauss kernel 2d")
def asymmetric(b: StoredElement) -> None:
    """Translate `asymmetric gauss kernel`: a Gaussian plus its derivative times `timeShift`."""
    form = StoredKernel(b)
    amplitude, width = b.values.number("amplitude", 3), b.values.width("width", 3)
    names = ("timeShift_y", "timeShift_x") if b.plane else ("", "timeShift")
    shifts = [b.values.number(name, 0) if name else 0.0 for name in names]
    if form.normalized and not b.plane:
        shifts = [v / abs(amplitude) if amplitude else 0.0 for v in shifts]  # the amplitude is applied below
    form.reserve(width)
    profiles = list[Taps]()
    for d, amount in enumerate(shifts):
        bell = form.gaussian(d, width)
        turned = taps.shift(width, bell.left, bell.right, form.normalized)
        profiles.append(Taps(bell.left, bell.right, bell.weights + amount * turned))
    form.add_custom(amplitude, profiles)


class StoredKernel:
    """The common properties of a kernel: dimensions, boundary, whether it is normalised, and the factor of
    the sum of the input.

    Without a value in the file they are those of the programs that did not write them.
    """

    def __init__(self, b: StoredElement) -> None:
        self.b = b
        self.dims: Dims = b.dims()
        self.circular = b.values.flag("circular", True)
        self.normalized = b.values.flag("normalized", True)
        self.overall = b.values.number("amplitudeGlobal", 0.0)

    def reserve(self, width: float) -> None:
        """Count the values of a kernel that is stored as an array, before it is computed."""
        reaches = (taps.reaches(width, count, self.circular) for count in self.b.counts)
        self.b.budget.take(math.prod(2 * max(sides) + 1 for sides in reaches))

    def gaussian(self, d: int, width: float, reaching: float = 0.0) -> Taps:
        """Return the Gaussian of one dimension, with the reach of another width."""
        left, right = taps.reaches(reaching or width, self.b.counts[d], self.circular)
        return taps.gaussian(width, left, right, self.normalized)

    def truncated(self, amplitude: float, width: float, least: float = 0.0) -> TruncatedGaussian:
        """Return the Gaussian as a kernel."""
        ends = boundary(axes(self.dims), self.circular)
        return TruncatedGaussian(amplitude + 0.0, width, CUTOFF, least, self.normalized, boundary=ends)

    def add_custom(self, amplitude: float, profiles: list[Taps]) -> None:
        """Add a kernel of any shape, as the product of one array for each dimension."""
        height = amplitude
        along_axes = [part for part, axis in zip(profiles, self.dims, strict=True) if axis is not None]
        for part, axis in zip(profiles, self.dims, strict=True):
            if axis is None:
                amplitude *= float(part.weights[part.left])

        def full_weights() -> np.ndarray:
            return height * outer([part.weights for part in profiles])

        ends = boundary(axes(self.dims), self.circular)
        if not along_axes:
            self.add([TruncatedGaussian(amplitude, normalized=True)], full_weights)
            return
        arrays = [part.centred(mirrored=not self.circular) for part in along_axes]
        weights = arrays[0] if len(arrays) == 1 else np.outer(arrays[0], arrays[1])
        self.add([Custom(weights, amplitude, boundary=ends)], full_weights)

    def add(self, kernels: Sequence[Kernel], full_weights: Callable[[], np.ndarray]) -> None:
        """Add the kernels; `full_weights` computes their weights, for elements that read them."""
        b, dims = self.b, self.dims
        interaction = Interaction(kernels, -self.overall + 0.0, name=b.label)
        b.outlet("output", b.add(interaction, input=b.input(dims, sums=True)))
        b.piece.elsewhere = {"kernel": f"computed from the parameter {display((b.label, 'kernel'))}"}
        if "kernel" in b.components_read:
            count = math.prod(b.counts)
            b.budget.take(count)
            weights = full_weights()
            if weights.size <= count:
                values = np.pad(weights, (0, count - weights.size)).reshape(shape(axes(dims)))
                b.outlet("kernel", b.add(Pattern(b.named("kernel"), axes(dims), values), dims), still=True)


def outer(factors: list[np.ndarray]) -> np.ndarray:
    """Return the product of the weights of both dimensions, flat."""
    return np.outer(factors[0], factors[1]).reshape(-1)
