"""Stimuli and noise."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.arithmetic import Gain, Product, Sum
from deodar.couplings.positions import SpaceCode
from deodar.elements.changing_stimuli import Noise, TimeSeries
from deodar.elements.stimuli import Boost, GaussianStimulus, Pattern
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar.numerics.windows import FOR_EVER, Window
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Dims, Unfit, axes
from deodar_interop.importers.cosivina.element import SourceElement
from deodar_interop.importers.cosivina.file import empty
from deodar_interop.importers.cosivina.values import ticks

LETTERS = "YXZ"


@translates(
    *(f"GaussStimulus{count}D" for count in (1, 2, 3)), "TimedGaussStimulus1D", "TimedGaussStimulus2D"
)
def gauss_stimulus(b: SourceElement) -> None:
    """Translate GaussStimulus1D, 2D and 3D, and their timed forms."""
    dims = b.sized()
    many = not b.element.kind.endswith("1D")
    centers, sigmas, ends, factor = list[float](), list[float](), list[str](), 1.0
    normalized = b.values.flag("normalized", False)
    for d, axis in enumerate(dims if many else dims[-1:]):
        letter = LETTERS[d] if many else ""
        center, sigma = b.values.number(f"position{letter}", 1), b.values.width(f"sigma{letter}")
        circular = b.values.flag(f"circular{letter}", True)
        if axis is not None:
            centers.append(center)
            sigmas.append(sigma)
            ends.append("periodic" if circular else "zero")
        elif not circular and not normalized:  # one sample off the centre
            factor *= math.exp(-0.5 * ((1 - center) / sigma) ** 2)
    timed = b.element.kind.startswith("Timed")
    if timed and normalized and b.bug("'normalized' of a timed stimulus has no effect in cosivina"):
        normalized = False
    stimulus = GaussianStimulus(
        b.label,
        axes(dims),
        center=centers or 1.0,
        sigma=sigmas or 1.0,
        amplitude=factor * b.values.number("amplitude", 0),
        normalized=normalized,
        boundary=boundary(dims, ends),
        windows=windows(b) if timed else None,
    )
    b.outlet("output", b.add(stimulus, dims), still=not timed)


@translates("BoostStimulus")
def boost(b: SourceElement) -> None:
    """Translate BoostStimulus."""
    element = Boost(b.label, (), b.values.number("amplitude", 0))
    b.outlet("output", b.add(element, (None, None)), still=True)


@translates("TimedBoost")
def timed_boost(b: SourceElement) -> ElementSignal:
    """Translate TimedBoost; with an amplitude per period, one Boost for each, and their sum."""
    periods = b.values.periods()
    stated = b.values.matrix("amplitude")
    amplitudes = (
        [float(v) for v in stated.reshape(-1)] if stated is not None else [b.values.number("amplitude", 0)]
    )
    number: Dims = (None, None)
    if len(amplitudes) == 1:
        spans = ticks(periods, b.simulator.start, b.step)
        return b.add(Boost(b.label, (), amplitudes[0], windows=_windows(b, spans)), number)
    parts: list[ElementSignal] = []
    earlier: list[tuple[int, int]] = []
    for amplitude, period in zip(amplitudes, periods, strict=False):  # where periods overlap the first counts
        on_ticks = ticks([period], b.simulator.start, b.step)
        spans = _without(on_ticks, earlier)
        parts.append(b.add(Boost(b.named("period"), (), amplitude, windows=_windows(b, spans)), number))
        earlier += on_ticks
    if not parts:
        b.explain("Boost that is never on")
        return b.add(Boost(b.label, (), 0.0), number)
    b.explain("Sum of Boosts")
    return b.add(Sum(name=b.label), input=parts)


@translates("CustomStimulus", "TimedCustomStimulus")
def custom_stimulus(b: SourceElement) -> None:
    """Translate CustomStimulus and TimedCustomStimulus: any pattern."""
    size = b.values.size()
    dims = b.dims()
    pattern = next(
        (v for name in ("pattern", "stimulusPattern") if (v := b.values.matrix(name)) is not None), None
    )
    pattern_shape = shape(axes(dims))
    if pattern is not None and "size" not in b.element.values:
        size = (1, pattern.size) if pattern.ndim < 2 else pattern.shape
        dims = b.of(size)
        pattern_shape = shape(axes(dims))
    if pattern is None or pattern.size != math.prod(pattern_shape):
        raise Unfit(f"its pattern is not of the size {list(size)}")
    timed = b.element.kind.startswith("Timed")
    values, on = np.asarray(pattern).reshape(pattern_shape), windows(b) if timed else None
    b.outlet("output", b.add(Pattern(b.label, axes(dims), values, windows=on), dims), still=not timed)


@translates("CustomStimulusSequence")
def sequence(b: SourceElement) -> ElementSignal:
    """Translate CustomStimulusSequence: one pattern after another, and zero before the first."""
    patterns, dims = _patterns(b)
    times = _start_times(b, len(patterns))
    rows = {
        max(first, 1): pattern
        for t, pattern in zip(times, patterns, strict=True)
        for first, _ in ticks([(t, math.inf)], b.simulator.start, b.step)
    }
    if not rows or min(rows) > 1:
        rows[min(rows, default=2) - 1] = np.zeros(patterns.shape[1:])
    order = sorted(rows)
    if "startTimes" in b.element.values:
        b.values.say(
            "startTimes", "carried", "moved by one step, since cosivina counts the time before it computes"
        )
    moments = [b.simulator.start + (tick - 1) * b.step for tick in order]
    values = np.stack([rows[tick] for tick in order]).reshape(len(order), *shape(axes(dims)))
    return b.add(TimeSeries(b.label, axes(dims), moments, values, interpolation="hold"), dims)


def _patterns(b: SourceElement) -> tuple[np.ndarray, Dims]:
    """Return the patterns of a sequence, one after another, and their dimensions."""
    stated = b.values.matrix("stimulusPatterns")
    if stated is None or stated.ndim > 3:
        raise Unfit("its stimulusPatterns are not patterns")
    patterns = stated.reshape(1, -1) if stated.ndim < 2 else stated
    if stated.ndim == 3:
        patterns = np.moveaxis(stated, -1, 0)
    size = (1, patterns.shape[1]) if patterns.ndim == 2 else patterns.shape[1:]
    if "stimulusSize" in b.element.values and b.values.size("stimulusSize") != size:
        raise Unfit(f"its patterns have the size {list(size)}, which is not its stimulusSize")
    if patterns.ndim == 3 and b.bug(
        "CustomStimulusSequence forgets, when it is read from a file, that its patterns are planes"
    ):
        raise Unfit("cosivina cannot show patterns that are planes after it has read them from a file")
    return patterns, b.of(size)


def _start_times(b: SourceElement, count: int) -> np.ndarray:
    starts = b.values.matrix("startTimes")
    if starts is None and not empty(b.element.values.get("startTimes")):
        raise Unfit("its startTimes are not times")
    times = np.arange(1.0, count + 1) if starts is None else starts.reshape(-1)
    if times.size != count or (np.diff(times) < 0).any():
        raise Unfit(f"its startTimes are not {count} rising numbers")
    return times


@translates("ScalarToGaussian")
def scalar_to_gaussian(b: SourceElement) -> None:
    """Translate ScalarToGaussian: a peak at the position that a number gives."""
    columns = b.values.size()[1]
    dims = b.of((1, columns))
    if columns == 1:
        raise Unfit("a peak needs more than one sample")
    sigma, amplitude = b.values.width("sigma"), b.values.number("amplitude", 0)
    gain, offset = b.values.number("inputScale", 1), b.values.number("inputOffset", 0)
    ends = boundary(dims, ["periodic" if b.values.flag("circular", True) else "zero"])
    code = SpaceCode(
        axes(dims),
        sigma,
        amplitude,
        gain,
        offset,
        normalized=b.values.flag("normalized", False),
        boundary=ends,
        name=b.label,
    )
    seen = b.input((None, None))
    b.outlet("output", b.add(code, dims, input=seen))
    place = f"its input times the parameter {display((b.label, 'gain'))} plus {display((b.label, 'offset'))}"
    b.piece.elsewhere = {"position": place}
    if "position" in b.components_read:
        scaled = b.add(Gain(gain, name=b.named("scaled")), input=seen)
        moved = b.add(Boost(b.named("offset"), (), offset), (None, None))
        b.outlet("position", b.add(Sum(name=b.named("position")), input=(scaled, moved)))


@translates("TimedSwitch")
def timed_switch(b: SourceElement) -> ElementSignal:
    """Translate TimedSwitch: a product with a factor that is 1 while the switch is on."""
    dims = b.sized()
    gate = b.add(Boost(b.named("on"), (), 1.0, windows=windows(b)), (None, None))
    return b.add(Product(name=b.label), input=b.input(dims), factor=gate)


@translates("NormalNoise")
def noise(b: SourceElement) -> None:
    """Translate NormalNoise: the step of 1 makes its strength the same here."""
    dims = b.sized()
    amplitude = b.values.number("amplitude", 0)
    b.outlet("output", b.add(Noise(b.label, axes(dims), abs(amplitude)), dims), noise=True)


def windows(b: SourceElement) -> list[Window]:
    """Return the windows of closed periods.

    cosivina advances the time first, so that the value for t is used in the step that leads to t.
    """
    return _windows(b, ticks(b.values.periods(), b.simulator.start, b.step))


def boundary(dims: Dims, ends: list[str]) -> list[str] | None:
    """Return boundaries that differ from those of the axes, else None."""
    axis_ends = ["periodic" if a.periodic else "zero" for a in axes(dims)]
    return None if ends == axis_ends else ends


def _windows(b: SourceElement, spans: list[tuple[int, int]]) -> list[Window]:
    start, step = b.simulator.start, b.step
    return [
        Window(start + (a - 1) * step, min(start + z * step, FOR_EVER) if z < 1e14 else FOR_EVER)
        for a, z in spans
    ]


def _without(spans: list[tuple[int, int]], taken: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Yield spans of steps without those of others."""
    for a, z in taken:
        spans = [
            part for s, e in spans for part in ((s, min(e, a - 1)), (max(s, z + 1), e)) if part[0] <= part[1]
        ]
    return spans
