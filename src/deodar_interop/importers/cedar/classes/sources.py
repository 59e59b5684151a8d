"""Sources: stimuli that are computed when the file is loaded, and those that change with time."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.sum import Sum
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.box_stimulus import BoxStimulus
from deodar.elements.gaussian_stimulus import GaussianStimulus
from deodar.elements.noise import Noise
from deodar.elements.pattern import Pattern
from deodar.numerics.axes import Axis
from deodar_interop.importers.cedar.file import items
from deodar_interop.importers.cedar.piece import OutputSlot, SourceStep, StepPiece, sizes

MOST_DIMENSIONS = 4


def boost(b: SourceStep) -> StepPiece:
    """Translate Boost; the strength of an inactive one is the end of its switch in the panel of sliders."""
    strength, active = b.values.number("strength", 1.0), b.values.flag("active", False)
    if not active:
        b.values.say("active", "carried", f"as an amplitude of 0; the switch gives {strength:g}")
    if b.values.flag("deactivate on reset", False):
        b.values.say("deactivate on reset", "dropped", "a reset keeps the values of parameters")
    element = Boost(b.label, (), strength if active else 0.0)
    return _source(b, element, "boost", (), "Boost")


def gauss(b: SourceStep) -> StepPiece:
    """Translate GaussInput; a cyclic one takes the shorter distance."""
    dims = sizes(b.values, 50, MOST_DIMENSIONS)
    axes = b.axes(dims)
    amplitude, wraps = b.values.number("amplitude", 1.0), b.values.flag("cyclic", False)
    if not dims:
        wide, at = b.values.numbers("sigma", 3.0, 1, 1e-6)[0], b.values.numbers("centers", 24.0, 1)[0]
        b.values.say("amplitude", "carried", "its value at the only sample")
        lone = Boost(b.label, (), amplitude * math.exp(-0.5 * (at / wide) ** 2))
        return _source(b, lone, "Gauss input", (), "Boost")
    sigmas = b.values.numbers("sigma", 3.0, len(dims), 1e-6)
    centers = b.values.numbers("centers", 24.0, len(dims))
    element = GaussianStimulus(
        b.label,
        axes,
        center=centers or 0.0,
        sigma=_same(sigmas),
        amplitude=amplitude,
        boundary=_boundary(axes, wraps),
    )
    return _source(b, element, "Gauss input", dims, "GaussianStimulus")


def box(b: SourceStep) -> StepPiece:
    """Translate BoxInput; the box is cut at the ends."""
    dims = sizes(b.values, 50, MOST_DIMENSIONS)
    axes = b.axes(dims)
    widths = [round(w) for w in b.values.numbers("widths", 10.0, len(dims), 0.0, 1e6)]
    lefts = [round(v) for v in b.values.numbers("left bounds", 0.0, len(dims), -1e6, 1e6)]
    level, amplitude = b.values.number("reference level", 0.0), b.values.number("amplitude", 1.0)
    outside = any(
        lower < 0 or lower + w > n for lower, w, n in zip(lefts, widths, dims, strict=True)
    ) and any(a.periodic for a in axes)
    if level or outside or not all(widths):
        inside = np.ones(dims, bool)
        for d, (lower, w) in enumerate(zip(lefts, widths, strict=True)):
            place = np.arange(dims[d]).reshape([-1 if k == d else 1 for k in range(len(dims))])
            inside &= (place >= lower) & (place < lower + w)
        b.values.say("amplitude", "carried", "as an array of values")
        return _source(
            b, Pattern(b.label, axes, np.where(inside, amplitude, level)), "box input", dims, "Pattern"
        )
    centers = [lower + (w - 1) / 2 for lower, w in zip(lefts, widths, strict=True)]
    element = BoxStimulus(
        b.label, axes, center=centers, width=[float(w) for w in widths], amplitude=amplitude
    )
    return _source(b, element, "box input", dims, "BoxStimulus")


def constant(b: SourceStep) -> StepPiece:
    """Translate ConstMatrix."""
    dims = _matrix(b)
    element = Boost(b.label, b.axes(dims), b.values.number("value", 1.0))
    return _source(b, element, "matrix", dims, "Boost")


def diagonal(b: SourceStep) -> StepPiece:
    """Translate ConstDiagonalMatrix."""
    dims = _matrix(b)
    values = np.zeros(dims)
    values[tuple(np.arange(min(dims, default=1)) for _ in dims)] = b.values.number("value", 1.0)
    return _source(b, Pattern(b.label, b.axes(dims), values), "matrix", dims, "Pattern")


def vector(b: SourceStep) -> StepPiece:
    """Translate ConstVector."""
    count = b.values.whole("number of vector entries", 1, 1, 1000)
    entries = b.values.numbers("entries", 0.0, count)
    if count == 1:
        return _source(b, Boost(b.label, (), entries[0]), "vector", (), "Boost")
    return _source(b, Pattern(b.label, b.axes((count,)), np.array(entries)), "vector", (count,), "Pattern")


def linear_template(b: SourceStep) -> StepPiece:
    """Translate LinearSpatialTemplate: a ramp along the diagonal."""
    dims = b.values.whole("size x", 50, 1, 5000), b.values.whole("size y", 50, 1, 5000)
    low, high = b.values.number("lowest", 0.0), b.values.number("upmost", 1.0)
    i, j = np.indices(dims)
    values = low + (high - low) * (i + j) / max(sum(dims) - 2, 1)
    return _source(b, Pattern(b.label, b.axes(dims), values), "spatial pattern", dims, "Pattern")


def spatial_template(b: SourceStep) -> StepPiece:
    """Translate SpatialTemplate: a Gaussian of the angle and of the logarithm of the radius."""
    dims = b.values.whole("size x", 50, 1, 5000), b.values.whole("size y", 50, 1, 5000)
    angle, wide = b.values.number("mu th", 0.0), b.values.number("sigma th hor", 0.25, 1e-6)
    radius, spread = b.values.number("mu r", 15.0), b.values.number("sigma r", 100.0, 1e-6)
    i, j = np.indices(dims) - (np.array(dims) // 2)[:, None, None]
    distance = np.hypot(i, j)
    # the logarithm of a distance of 0 is infinitely far from the radius
    r = np.log(np.where(distance > 0, distance, 1.0))
    values = np.exp(-0.5 * ((np.arctan2(j, i) - angle) / wide) ** 2 - 0.5 * ((r - radius) / spread) ** 2)
    values = np.where(distance > 0, values, 0.0)
    piece = _source(b, Pattern(b.label, b.axes(dims), values), "spatial pattern", dims, "Pattern")
    piece.verdict = "approximated"
    piece.why = "Pattern; the centre, and that the angle begins along the first dimension, are a guess"
    return piece


def noise(b: SourceStep) -> StepPiece:
    """Translate Noise: new numbers of a fixed spread in every step, whatever its length."""
    dims = sizes(b.values, 50, MOST_DIMENSIONS)
    spread = b.values.number("standard deviation", 1.0, 0.0)
    b.values.say("standard deviation", "carried", f"times the root of the step of {b.dt:g} ms")
    mean, axes = b.values.number("mean", 0.0), b.axes(dims)
    if not mean:
        return _source(b, Noise(b.label, axes, spread * math.sqrt(b.dt)), "random", dims, "Noise")
    alone = Noise(b.named("noise"), axes, spread * math.sqrt(b.dt))
    offset = Boost(b.named("mean"), (), mean)
    piece = _source(b, Sum(name=b.label), "random", dims, "Noise, and Sum with a Boost for its mean")
    piece.elements += [alone, offset]
    piece.inner += [(alone.name, b.label), (offset.name, b.label)]
    return piece


def _matrix(b: SourceStep) -> tuple[int, ...]:
    """Return the size of a matrix; without a third dimension a row or a column counts as one dimension."""
    count = len(items(b.values.body.get("sizes"))) or 2
    dims = tuple(int(n) for n in b.values.numbers("sizes", 50, min(count, MOST_DIMENSIONS), 1, 1e6))
    return tuple(n for n in dims if n > 1) if len(dims) <= 2 else dims


def _source(b: SourceStep, element: Element, slot: str, dims: tuple[int, ...], why: str) -> StepPiece:
    return StepPiece([element], outlets={slot: OutputSlot(b.label, dims)}, why=why)


def _same(values: list[float]) -> float | list[float]:
    return values[0] if values and len(set(values)) == 1 else values or 1.0


def _boundary(axes: tuple[Axis, ...], wraps: bool) -> list[str] | None:
    axis_ends = ["periodic" if a.periodic else "zero" for a in axes]
    ends = ["periodic" if wraps else "zero"] * len(axes)
    return None if axis_ends == ends else ends


CLASSES = {
    "cedar.processing.sources.Boost": boost,
    "cedar.processing.sources.GaussInput": gauss,
    "cedar.processing.sources.BoxInput": box,
    "cedar.processing.sources.ConstMatrix": constant,
    "cedar.processing.sources.ConstDiagonalMatrix": diagonal,
    "cedar.processing.ConstVector": vector,
    "cedar.processing.sources.LinearSpatialTemplate": linear_template,
    "cedar.processing.sources.SpatialTemplate": spatial_template,
    "cedar.processing.sources.Noise": noise,
}

DECLARED = frozenset(CLASSES)

LOOPED = frozenset({"cedar.processing.sources.Noise"})
