"""Sources: stimuli that are computed when the file is loaded, and those that change with time."""

from __future__ import annotations

import math

import numpy as np

from deodar.elements.changing_stimuli import Noise
from deodar.elements.stimuli import BoxStimulus, GaussianStimulus, Pattern
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.convolution_kernels import CedarBorder
from deodar_interop.importers.cedar.file import items
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import sizes

MOST_DIMENSIONS = 4


@step("cedar.processing.sources.Boost", gives="boost", sized=True)
def boost(s: SourceStep) -> StepSignal:
    """Translate Boost; the strength of an inactive one is the end of its switch in the panel of sliders."""
    strength, active = s.values.number("strength", 1.0), s.values.flag("active", False)
    if not active:
        s.values.say("active", "carried", f"as an amplitude of 0; the switch gives {strength:g}")
    if s.values.flag("deactivate on reset", False):
        s.values.say("deactivate on reset", "dropped", "a reset keeps the values of parameters")
    return s.constant("", strength if active else 0.0)


@step("cedar.processing.sources.GaussInput", gives="Gauss input", sized=True)
def gauss(s: SourceStep) -> StepSignal:
    """Translate GaussInput; a cyclic one takes the shorter distance."""
    axes = s.axes(sizes(s.values, 50, MOST_DIMENSIONS))
    amplitude, wraps = s.values.number("amplitude", 1.0), s.values.flag("cyclic", False)
    sigmas = s.values.numbers("sigma", 3.0, max(len(axes), 1), 1e-6)
    centers = s.values.numbers("centers", 24.0, max(len(axes), 1))
    if not axes:
        s.values.say("amplitude", "carried", "its value at the only sample")
        return s.constant("", amplitude * math.exp(-0.5 * (centers[0] / sigmas[0]) ** 2))
    sigma = sigmas[0] if len(set(sigmas)) == 1 else sigmas
    ends = CedarBorder("Cyclic" if wraps else "Zero").ends(axes)
    element = GaussianStimulus(s.label, axes, center=centers, sigma=sigma, amplitude=amplitude, boundary=ends)
    return s.add(element)


@step("cedar.processing.sources.BoxInput", gives="box input", sized=True)
def box(s: SourceStep) -> StepSignal:
    """Translate BoxInput; the box is cut at the ends."""
    dims = sizes(s.values, 50, MOST_DIMENSIONS)
    axes = s.axes(dims)
    widths = [round(w) for w in s.values.numbers("widths", 10.0, len(dims), 0.0, 1e6)]
    lefts = [round(v) for v in s.values.numbers("left bounds", 0.0, len(dims), -1e6, 1e6)]
    level, amplitude = s.values.number("reference level", 0.0), s.values.number("amplitude", 1.0)
    outside = any(
        lower < 0 or lower + w > n for lower, w, n in zip(lefts, widths, dims, strict=True)
    ) and any(a.periodic for a in axes)
    if level or outside or not all(widths):
        inside = np.ones(dims, bool)
        for d, (lower, w) in enumerate(zip(lefts, widths, strict=True)):
            place = np.arange(dims[d]).reshape([-1 if k == d else 1 for k in range(len(dims))])
            inside &= (place >= lower) & (place < lower + w)
        s.values.say("amplitude", "carried", "as an array of values")
        return s.add(Pattern(s.label, axes, np.where(inside, amplitude, level)))
    centers = [lower + (w - 1) / 2 for lower, w in zip(lefts, widths, strict=True)]
    spans = [float(w) for w in widths]
    return s.add(BoxStimulus(s.label, axes, center=centers, width=spans, amplitude=amplitude))


@step("cedar.processing.sources.ConstMatrix", gives="matrix", sized=True)
def constant(s: SourceStep) -> StepSignal:
    """Translate ConstMatrix."""
    axes = s.axes(_matrix(s))
    return s.constant("", s.values.number("value", 1.0), axes)


@step("cedar.processing.sources.ConstDiagonalMatrix", gives="matrix", sized=True)
def diagonal(s: SourceStep) -> StepSignal:
    """Translate ConstDiagonalMatrix."""
    dims = _matrix(s)
    values = np.zeros(dims)
    values[tuple(np.arange(min(dims, default=1)) for _ in dims)] = s.values.number("value", 1.0)
    return s.add(Pattern(s.label, s.axes(dims), values))


@step("cedar.processing.ConstVector", gives="vector", sized=True)
def vector(s: SourceStep) -> StepSignal:
    """Translate ConstVector."""
    count = s.values.whole("number of vector entries", 1, 1, 1000)
    entries = s.values.numbers("entries", 0.0, count)
    if count == 1:
        return s.constant("", entries[0])
    return s.add(Pattern(s.label, s.axes((count,)), np.array(entries)))


@step("cedar.processing.sources.LinearSpatialTemplate", gives="spatial pattern", sized=True)
def linear_template(s: SourceStep) -> StepSignal:
    """Translate LinearSpatialTemplate: a ramp along the diagonal."""
    dims = s.values.whole("size x", 50, 1, 5000), s.values.whole("size y", 50, 1, 5000)
    low, high = s.values.number("lowest", 0.0), s.values.number("upmost", 1.0)
    i, j = np.indices(dims)
    values = low + (high - low) * (i + j) / max(sum(dims) - 2, 1)
    return s.add(Pattern(s.label, s.axes(dims), values))


@step("cedar.processing.sources.SpatialTemplate", gives="spatial pattern", sized=True)
def spatial_template(s: SourceStep) -> StepSignal:
    """Translate SpatialTemplate: a Gaussian of the angle and of the logarithm of the radius."""
    dims = s.values.whole("size x", 50, 1, 5000), s.values.whole("size y", 50, 1, 5000)
    angle, wide = s.values.number("mu th", 0.0), s.values.number("sigma th hor", 0.25, 1e-6)
    radius, spread = s.values.number("mu r", 15.0), s.values.number("sigma r", 100.0, 1e-6)
    i, j = np.indices(dims) - (np.array(dims) // 2)[:, None, None]
    distance = np.hypot(i, j)
    # the logarithm of a distance of 0 is infinitely far from the radius
    r = np.log(np.where(distance > 0, distance, 1.0))
    values = np.exp(-0.5 * ((np.arctan2(j, i) - angle) / wide) ** 2 - 0.5 * ((r - radius) / spread) ** 2)
    values = np.where(distance > 0, values, 0.0)
    why = "Pattern; the centre, and that the angle begins along the first dimension, are a guess"
    s.explain(why, "approximated")
    return s.add(Pattern(s.label, s.axes(dims), values))


@step("cedar.processing.sources.Noise", gives="random", sized=True, looped=True)
def noise(s: SourceStep) -> StepSignal:
    """Translate Noise: new numbers of a fixed spread in every step, whatever its length."""
    axes = s.axes(sizes(s.values, 50, MOST_DIMENSIONS))
    spread = s.values.number("standard deviation", 1.0, 0.0)
    s.values.say("standard deviation", "carried", f"times the root of the step of {s.dt:g} ms")
    mean = s.values.number("mean", 0.0)
    alone = s.add(Noise(s.named("noise" if mean else ""), axes, spread * math.sqrt(s.dt)))
    if not mean:
        return alone
    s.explain("Noise, and Sum with a Boost for its mean")
    return s.total("", alone, s.constant("mean", mean))


def _matrix(s: SourceStep) -> Counts:
    """Return the size of a matrix; without a third dimension a row or a column counts as one dimension."""
    count = len(items(s.values.body.get("sizes"))) or 2
    dims = tuple(int(n) for n in s.values.numbers("sizes", 50, min(count, MOST_DIMENSIONS), 1, 1e6))
    return tuple(n for n in dims if n > 1) if len(dims) <= 2 else dims
