"""Stimuli and noise."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.convolutions import Convolve
from deodar.couplings.delays import Delay
from deodar.elements.changing_stimuli import Noise
from deodar.elements.stimuli import Boost, GaussianStimulus, Pattern
from deodar.numerics.axes import Axis, shape
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import TruncatedGaussian
from deodar.numerics.windows import Window
from deodar_interop.importers._element import translates
from deodar_interop.importers._piece import Dims, axes
from deodar_interop.importers.dnf_composer import sample_values
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.file import number
from deodar_interop.importers.dnf_composer.sample_values import CUTOFF, spans

EXACT = 1e-12
"""Largest difference, as a share, between the extent of an axis and its samples times its step."""

NOTHING = 1e-12
"""Sum of a pattern below which dnf-composer does not normalise it."""


@translates("gauss stimulus", "timed gauss stimulus")
def gauss_stimulus(b: StoredElement) -> None:
    """Translate `gauss stimulus`, whose width is in samples, and its timed form."""
    dims = b.dims()
    count = b.counts[1]
    position = _position(b, "position", "x_max", 50) / b.spacing("d_x")
    width, circular = b.values.width("width", 5), b.values.flag("circular", True)
    amplitude, normalized = b.values.number("amplitude", 15), b.values.flag("normalized", False)

    def pattern() -> np.ndarray:
        factor = sample_values.line(count, position, width, circular)
        total = factor.sum() if normalized else 1.0
        return amplitude * (factor / total if total > 0 else factor)

    b.start = pattern
    if dims[1] is None:
        _stimulate(b, dims, Boost(b.label, axes(dims), float(pattern()[0])))
        return
    ends = boundary(axes(dims), circular)
    bell = GaussianStimulus(
        b.label, axes(dims), position, width, amplitude, normalized=normalized, boundary=ends
    )
    _stimulate(b, dims, bell)


@translates("gauss stimulus 2d", "timed gauss stimulus 2d")
def gauss_stimulus_2d(b: StoredElement) -> None:
    """Translate `gauss stimulus 2d`, whose width is in units, and its timed form.

    Where a circular axis is no whole number of steps, no stimulus of deodar has its distances, and the
    pattern is stored.
    """
    dims = b.dims()
    width, circular = b.values.width("width", 5), b.values.flag("circular", True)
    amplitude, normalized = b.values.number("amplitude", 15), b.values.flag("normalized", False)
    sides = [_side(b, letter, circular) for letter in "yx"]

    def factors() -> list[np.ndarray]:
        return [sample_values.along(side.points, side.period, side.position, width) for side in sides]

    total = math.prod(float(factor.sum()) for factor in factors()) if normalized else 1.0
    normalized = normalized and total > NOTHING

    def pattern() -> np.ndarray:
        return (amplitude / (total if normalized else 1.0) * np.outer(*factors())).reshape(-1)

    b.start, stimulus_axes = pattern, axes(dims)
    if not stimulus_axes:
        _stimulate(b, dims, Boost(b.label, stimulus_axes, float(pattern()[0])))
        return
    if len(stimulus_axes) < 2 or not all(side.whole for side in sides):
        b.budget.take(math.prod(b.counts))
        _stimulate(b, dims, Pattern(b.label, stimulus_axes, pattern().reshape(shape(stimulus_axes))))
        return
    bell = GaussianStimulus(
        b.label,
        stimulus_axes,
        center=[side.position / side.step for side in sides],
        sigma=[width / side.step for side in sides],
        amplitude=amplitude,
        normalized=normalized,
        boundary=boundary(stimulus_axes, circular),
    )
    _stimulate(b, dims, bell)


@translates("boost stimulus", "boost stimulus 2d")
def boost(b: StoredElement) -> None:
    """Translate `boost stimulus` and its form over a plane; one that is not active keeps its amplitude."""
    dims = b.dims()
    amplitude, active = b.values.number("amplitude", 5), b.values.flag("isActive", True)
    b.start = amplitude if active else 0.0
    element = Boost(b.label, axes(dims), amplitude, windows=None if active else [])
    if not active:
        b.values.say("isActive", "carried", "as a list without windows: it is never on")
    b.outlet("output", b.add(element, dims), still=True)


# ----------------------------------------------------------------------------------------------------- inside


@dc.dataclass(frozen=True)
class Side:
    """One axis of a plane, in units: samples, step, extent, the position of a peak, and whether it wraps."""

    count: int
    step: float
    extent: float
    position: float
    circular: bool

    @property
    def points(self) -> np.ndarray:
        """The positions of the samples."""
        return np.arange(1.0, self.count + 1) * self.step

    @property
    def period(self) -> float | None:
        """The extent after which it wraps; None if it does not."""
        return self.extent if self.circular else None

    @property
    def whole(self) -> bool:
        """Whether the samples fill the extent, so that deodar has the same distances."""
        return not self.circular or abs(self.count * self.step - self.extent) <= EXACT * self.extent


def _side(b: StoredElement, letter: str, circular: bool) -> Side:
    extent = number(b.element.values.get(f"{letter}_max")) or 1.0
    position = _position(b, f"position_{letter}", f"{letter}_max", 50)
    return Side(b.counts["yx".index(letter)], b.spacing(f"d_{letter}"), extent, position, circular)


def _position(b: StoredElement, name: str, extent: str, default: float) -> float:
    place = b.values.number(name, default)
    longest = number(b.element.values.get(extent, 1.0)) or 1.0
    if name in b.element.values and not 0 <= place < longest:
        b.values.say(
            name, "approximated", f"{place:g} is outside 0..{longest:g}, where dnf-composer refuses the file"
        )
    return place


def _stimulate(b: StoredElement, dims: Dims, element: GaussianStimulus | Pattern | Boost) -> None:
    """Add a stimulus; one that is timed passes a register, so that its name shows at t what led to t."""
    if not b.element.kind.startswith("timed"):
        b.outlet("output", b.add(element, dims), still=True)
        return
    b.start = 0.0
    stimulus = b.add(dc.replace(element, name=b.named("stimulus"), windows=_windows(b)), dims)
    b.outlet("output", b.add(Delay(axes(dims), 0.0, name=b.label), input=stimulus), state=True)
    b.explain(f"{type(element).__name__} and Delay")


def boundary(stimulus_axes: tuple[Axis, ...], circular: bool) -> list[str] | None:
    """Return boundaries that differ from those of the axes, else None."""
    ends = ["periodic" if circular else "zero"] * len(stimulus_axes)
    return None if ends == ["periodic" if a.periodic else "zero" for a in stimulus_axes] else ends


def _windows(b: StoredElement) -> list[Window]:
    """Return the windows of a timed stimulus.

    dnf-composer counts the time first, so that the value for t is used in the step that leads to t.
    """
    b.values.optional.add("onTimes")
    periods = [(a, z) for a, z in b.values.rows("onTimes", 2)]
    if periods and b.values.lines["onTimes"].verdict == "carried":
        b.values.say("onTimes", "carried", "moved by one step, since dnf-composer counts the time first")
    return [Window((a - 1) * b.step, z * b.step) for a, z in spans(periods, b.step)]


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
    return Custom(sample_values.gaussian(width, half, half, True).weights, boundary=ends)


def _strength(b: StoredElement, default: float) -> float:
    """Return the amplitude; its sign has no effect on noise."""
    return math.fabs(b.values.number("amplitude", default))
