"""Kernels and couplings."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from deodar.couplings.arithmetic import Gain
from deodar.couplings.convolutions import Interaction
from deodar.couplings.weights import Weights
from deodar.elements.stimuli import Pattern
from deodar.errors import DeodarError
from deodar.importers._beside import is_plain
from deodar.importers.report import Line
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import TruncatedGaussian
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Dims, Unfit, axes
from deodar_interop.importers._values import LARGEST
from deodar_interop.importers.dnf_composer import sample_values
from deodar_interop.importers.dnf_composer.classes.stimuli import boundary
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.sample_values import CUTOFF, Taps
from deodar_interop.importers.dnf_composer.values import INPUT_LENGTH, input_length

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
    form.reserve(sample_values.oscillation_width(decay, crossings))
    profiles = [sample_values.oscillation(decay, crossings, count, form.circular) for count in b.counts]
    if form.normalized:
        profiles = [sample_values.per_sum(part) for part in profiles]
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
        turned = sample_values.shift(width, bell.left, bell.right, form.normalized)
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
        reaches = (sample_values.reaches(width, count, self.circular) for count in self.b.counts)
        self.b.budget.take(math.prod(2 * max(sides) + 1 for sides in reaches))

    def gaussian(self, d: int, width: float, reaching: float = 0.0) -> Taps:
        """Return the Gaussian of one dimension, with the reach of another width."""
        left, right = sample_values.reaches(reaching or width, self.b.counts[d], self.circular)
        return sample_values.gaussian(width, left, right, self.normalized)

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


MOST_PRODUCTS = 500_000_000
"""Largest number of weights times peaks (a guess; they take seconds)."""

LEARNING = ("learningRule", "learningRate", "decayRate")


@translates("field coupling")
def field_coupling(b: StoredElement) -> ElementSignal:
    """Translate `field coupling`: weights from the file beside the simulation, times `scalar`."""
    came = _input(b)
    weights = stored_weights(b, came)
    scalar = b.values.number("scalar", 1)
    for name in LEARNING:
        if name in b.element.values:
            b.values.say(name, "dropped", "learning is off when a file is opened, and weights are fixed here")
    return _weighted(b, weights, scalar)


@translates("gauss field coupling")
def gauss_field_coupling(b: StoredElement) -> ElementSignal:
    """Translate `gauss field coupling`: a sum of Gaussian peaks, whose samples are counted from 0."""
    came = _input(b)
    b.values.optional |= {"couplings"}
    normalized, circular = b.values.flag("normalized", True), b.values.flag("circular", False)
    count, peaks = b.counts[1], b.values.rows("couplings", 4)
    b.budget.take(came * count)
    if len(peaks) * came * count > MOST_PRODUCTS:
        raise Unfit(f"its {len(peaks)} peaks over {came} x {count} samples take too long to add")
    weights = np.zeros((came, count))
    source = b.source()
    spacing = b.spacing("input_d_x") if source is None else _spacing(source.values.get("d_x", 1.0))
    good = [peak for peak in peaks if min(peak) > 0]
    for x, y, amplitude, width in good:
        height = amplitude / (math.sqrt(2 * math.pi) * width) if normalized else amplitude
        a, z = (
            _bell(n, position, width, circular)
            for n, position in ((came, x / spacing), (count, y / b.spacing("d_x")))
        )
        weights += height * np.outer(a, z)
    if not np.isfinite(weights).all() or np.abs(weights).max(initial=0.0) > LARGEST:
        raise Unfit("its weights are not finite")
    if len(good) < len(peaks):
        why = f"{len(peaks) - len(good)} of {len(peaks)} entries are not above 0, and are left out"
        b.values.say("couplings", "approximated", why)
    elif "couplings" in b.element.values and b.values.lines["couplings"].verdict == "carried":
        b.values.say("couplings", "carried", "as weights")
    return _weighted(b, weights, 1.0)


def stored_weights(b: StoredElement, came: int) -> np.ndarray:
    """Return the weights of the file NAME_weights.txt, one row for each input sample; else zeros."""
    name, count = f"{b.label}_weights.txt", b.counts[1]
    b.budget.take(came * count)
    nothing = np.zeros((came, count))
    try:
        content = b.beside(name) if is_plain(name) else None
    except DeodarError as error:
        return _no_weights(b, name, error.problems[0].what, nothing)
    if content is None:
        fault = "there is no such file" if is_plain(name) else "this name leads to another folder"
        return _no_weights(b, name, fault, nothing)
    words = content.split(maxsplit=came * count)
    try:
        weights = np.array([float(word) for word in words[: came * count]])
    except ValueError:
        return _no_weights(b, name, "it holds more than numbers", nothing)
    if len(words) != came * count:
        fault = f"it does not hold {came} x {count} numbers"
        return _no_weights(b, name, fault, nothing)
    if not np.isfinite(weights).all() or np.abs(weights).max(initial=0.0) > LARGEST:
        return _no_weights(b, name, "some of its numbers are not finite", nothing)
    b.extra.append(Line(b.label, "file", name, "carried"))
    return weights.reshape(came, count)


def _no_weights(b: StoredElement, name: str, fault: str, nothing: np.ndarray) -> np.ndarray:
    why = f"{fault}; weights of 0 are used, as in dnf-composer"
    b.extra.append(Line(b.label, "file", name, "approximated", why))
    return nothing


def _input(b: StoredElement) -> int:
    """Return the number of input samples, and report the parameters that state it."""
    b.dims()
    came, values = input_length(b.element), b.element.values
    pair = [name for name in ("input_x_max", "input_d_x") if name in values]
    for name in pair:
        if len(pair) == 2:
            b.values.say(name, "carried", f"as {came} samples")
        else:
            b.values.say(name, "dropped", f"it has a meaning only with the other; {came} samples are used")
    if "inputFieldSize" in values:
        if pair:
            b.values.say("inputFieldSize", "dropped", "replaced by input_x_max and input_d_x")
        else:
            why = f"as {came} samples; today's dnf-composer ignores it and takes {INPUT_LENGTH}"
            b.values.say("inputFieldSize", "approximated", why)
    elif not pair:
        why = f"it is not in the file; {INPUT_LENGTH} samples are used, dnf-composer's default"
        b.values.say("input_x_max", "approximated", why)
    b.of((1, came))
    return came


def _weighted(b: StoredElement, weights: np.ndarray, scalar: float) -> ElementSignal:
    dims, came = b.of(b.counts), b.of((1, weights.shape[0]))
    ours = weights.T.reshape(shape(axes(dims)) + shape(axes(came)))
    element = Weights(ours, axes(dims), name=b.named("" if scalar == 1 else "weights"))
    b.piece.elsewhere = {
        "weights": f"the parameter {display((element.name, 'weights'))}, output samples first"
    }
    weighted = b.add(element, dims, input=b.input(came, sums=True))
    if scalar == 1:
        return weighted
    b.explain("Gain and Weights")
    return b.add(Gain(scalar, name=b.label), input=weighted)


def _spacing(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) and value > 0 else 1.0


def _bell(count: int, position: float, width: float, circular: bool) -> np.ndarray:
    """Return exp(-d^2 / (2 width^2)) at the samples 0, 1, ..., count - 1."""
    d = np.abs(np.arange(count) - position)
    return np.exp(-0.5 * ((np.minimum(d, count - d) if circular else d) / width) ** 2)
