"""Stimuli and noise."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.gain import Gain
from deodar.couplings.product import Product
from deodar.couplings.space_code import SpaceCode
from deodar.couplings.sum import Sum
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.gaussian_stimulus import GaussianStimulus
from deodar.elements.noise import Noise
from deodar.elements.pattern import Pattern
from deodar.elements.time_series import TimeSeries
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar.numerics.windows import FOR_EVER, Window
from deodar_interop.importers._piece import Dims, Inlet, Outlet, Piece, Unfit, axes
from deodar_interop.importers.cosivina.element import SourceElement
from deodar_interop.importers.cosivina.file import empty
from deodar_interop.importers.cosivina.values import ticks

LETTERS = "YXZ"


def gauss_stimulus(b: SourceElement) -> Piece:
    """Translate GaussStimulus1D, 2D and 3D, and their timed forms."""
    b.values.size()
    dims = b.dims()
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
        windows=windows(b) if timed else (),
    )
    return Piece([stimulus], [], {"output": Outlet(b.label, dims, still=not timed)}, why="GaussianStimulus")


def boost(b: SourceElement) -> Piece:
    """Translate BoostStimulus."""
    element = Boost(b.label, (), b.values.number("amplitude", 0))
    return Piece([element], [], {"output": Outlet(b.label, (None, None), still=True)}, why="Boost")


def timed_boost(b: SourceElement) -> Piece:
    """Translate TimedBoost; with an amplitude per period, one Boost for each, and their sum."""
    periods = b.values.periods()
    stated = b.values.matrix("amplitude")
    amplitudes = (
        [float(v) for v in stated.reshape(-1)] if stated is not None else [b.values.number("amplitude", 0)]
    )
    outlet = {"output": Outlet(b.label, (None, None))}
    if len(amplitudes) == 1:
        return Piece(
            [
                Boost(
                    b.label, (), amplitudes[0], windows=_windows(b, ticks(periods, b.simulator.start, b.step))
                )
            ],
            [],
            outlet,
            why="Boost",
        )
    parts: list[Element] = [Sum(name=b.label)]
    earlier: list[tuple[int, int]] = []
    for amplitude, period in zip(amplitudes, periods, strict=False):  # where periods overlap the first counts
        on_ticks = ticks([period], b.simulator.start, b.step)
        parts.append(
            Boost(b.named("period"), (), amplitude, windows=_windows(b, _without(on_ticks, earlier)))
        )
        earlier += on_ticks
    if len(parts) == 1:
        return Piece([Boost(b.label, (), 0.0)], [], outlet, why="Boost that is never on")
    return Piece(parts, [], outlet, [(part.name, b.label) for part in parts[1:]], why="Sum of Boosts")


def custom_stimulus(b: SourceElement) -> Piece:
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
    element = Pattern(
        b.label, axes(dims), np.asarray(pattern).reshape(pattern_shape), windows=windows(b) if timed else ()
    )
    return Piece([element], [], {"output": Outlet(b.label, dims, still=not timed)}, why="Pattern")


def sequence(b: SourceElement) -> Piece:
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
    element = TimeSeries(b.label, axes(dims), moments, values, interpolation="hold")
    return Piece([element], [], {"output": Outlet(b.label, dims)}, why="TimeSeries")


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


def scalar_to_gaussian(b: SourceElement) -> Piece:
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
    elements, inlets, inner = (
        list[Element]([code]),
        [Inlet(b.label, (None, None), whole=True)],
        list[tuple[str, ...]](),
    )
    outlets = {"output": Outlet(b.label, dims)}
    elsewhere = {
        "position": (
            f"its input times the parameter {display((b.label, 'gain'))} plus {display((b.label, 'offset'))}"
        )
    }
    if "position" in b.components_read:
        place, scaled, moved = b.named("position"), b.named("scaled"), b.named("offset")
        elements += [Sum(name=place), Gain(gain, name=scaled), Boost(moved, (), offset)]
        inlets.append(Inlet(scaled, (None, None), whole=True))
        inner += [(scaled, place), (moved, place)]
        outlets["position"] = Outlet(place, (None, None))
    return Piece(elements, [inlets], outlets, inner, elsewhere=elsewhere, needs=1, why="SpaceCode")


def timed_switch(b: SourceElement) -> Piece:
    """Translate TimedSwitch: a product with a factor that is 1 while the switch is on."""
    b.values.size()
    dims = b.dims()
    gate = Boost(b.named("on"), (), 1.0, windows=windows(b))
    inlets = [[Inlet(b.label, dims, whole=True)]]
    return Piece(
        [Product(name=b.label), gate],
        inlets,
        {"output": Outlet(b.label, dims)},
        [(gate.name, b.label, "factor")],
        needs=1,
        why="Product",
    )


def noise(b: SourceElement) -> Piece:
    """Translate NormalNoise: the step of 1 makes its strength the same here."""
    b.values.size()
    dims = b.dims()
    amplitude = b.values.number("amplitude", 0)
    return Piece(
        [Noise(b.label, axes(dims), abs(amplitude))],
        [],
        {"output": Outlet(b.label, dims, noise=True)},
        why="Noise",
    )


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
    listed = [
        Window(start + (a - 1) * step, min(start + z * step, FOR_EVER) if z < 1e14 else FOR_EVER)
        for a, z in spans
    ]
    return listed or [Window(start - 1, start - 1)]  # never


def _without(spans: list[tuple[int, int]], taken: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Yield spans of steps without those of others."""
    for a, z in taken:
        spans = [
            part for s, e in spans for part in ((s, min(e, a - 1)), (max(s, z + 1), e)) if part[0] <= part[1]
        ]
    return spans


CLASSES = {
    "GaussStimulus1D": gauss_stimulus,
    "GaussStimulus2D": gauss_stimulus,
    "GaussStimulus3D": gauss_stimulus,
    "TimedGaussStimulus1D": gauss_stimulus,
    "TimedGaussStimulus2D": gauss_stimulus,
    "BoostStimulus": boost,
    "TimedBoost": timed_boost,
    "CustomStimulus": custom_stimulus,
    "TimedCustomStimulus": custom_stimulus,
    "CustomStimulusSequence": sequence,
    "ScalarToGaussian": scalar_to_gaussian,
    "TimedSwitch": timed_switch,
    "NormalNoise": noise,
}
