"""Stimuli and noise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, cast

import jax
import numpy as np

from deodar.couplings.arithmetic import Gain, Sum
from deodar.couplings.positions import SpaceCode
from deodar.element import Setting
from deodar.elements.changing_stimuli import Noise, TimeSeries
from deodar.elements.stimuli import Boost, BoxStimulus, GaussianStimulus, Pattern, Stimulus
from deodar.leaves import per_axis
from deodar.model.document import Entry
from deodar.numerics.axes import Axes, cell, shape
from deodar.numerics.windows import FOR_EVER, Window
from deodar.parameters import FrozenArray, PerAxis
from deodar_interop.exporters.cosivina.draft import FilePart, Given, Unwritable
from deodar_interop.exporters.cosivina.layout import (
    circular,
    is_row,
    layout,
    position,
    positions,
    size,
    width,
    widths,
)
from deodar_interop.importers._piece import Dims
from deodar_interop.importers.cosivina.classes.stimuli import LETTERS

MOST_TIMED = 2
"""Number of dimensions up to which cosivina has timed Gaussian stimuli."""


def gaussian(b: Given, element: GaussianStimulus) -> None:
    """Write GaussStimulus1D, 2D or 3D, and their timed forms."""
    axes, dims = tuple(element.axes), b.dims()
    rank = 1 if is_row(dims) else len(dims)
    timed = element.windows is not None
    if rank > (MOST_TIMED if timed else len(LETTERS)):
        return sampled(b, element)
    amplitude = element.amplitude / (cell(axes) if element.normalized else 1)
    values: dict[str, Any] = {"amplitude": amplitude, "normalized": element.normalized}
    places = dict(zip([a.name for a in axes], positions(axes, element.center), strict=True))
    broad = dict(zip([a.name for a in axes], widths(axes, element.sigma), strict=True))
    rings = dict(zip([a.name for a in axes], circular(axes, element.boundary), strict=True))
    for d, axis in enumerate(dims if rank > 1 else dims[-1:]):
        letter = LETTERS[d] if rank > 1 else ""
        values[f"position{letter}"] = 1 if axis is None else places[axis.name]
        values[f"sigma{letter}"] = 1 if axis is None else broad[axis.name]
        values[f"circular{letter}"] = True if axis is None else rings[axis.name]
    if element.windows is not None:
        values["onTimes"] = periods(b, element.windows)
    part = b.sized(f"{'Timed' * timed}GaussStimulus{rank}D", values)
    b.show(part, free=not timed)


def boost(b: Given, element: Boost) -> None:
    """Write BoostStimulus or TimedBoost; over axes a CustomStimulus, which has a size."""
    if element.axes:
        return _pattern(b, np.full(shape(element.axes), element.amplitude), element.windows)
    late = any(c.reads == "delayed" for c in b.draft.wires.out.get(b.id, []))
    if element.windows is not None:
        part = b.part("TimedBoost", {"amplitude": element.amplitude, "onTimes": periods(b, element.windows)})
    elif late and not element.amplitude:  # several amplitudes without a period: never on
        part = b.part("TimedBoost", {"amplitude": [[0], [0]], "onTimes": []})
    else:
        part = b.part("BoostStimulus", {"amplitude": element.amplitude})
        if late:
            b.approximate("cosivina has it from the first step on, deodar from the second")
    b.show(part, free=part.kind == "BoostStimulus")


def timed_boosts(b: Given, boosts: Sequence[Entry]) -> None:
    """Write one TimedBoost for a sum of boosts, each with its period."""
    b.claim(boosts)
    amplitudes, times = list[list[float]](), list[list[float]]()
    for e in boosts:
        element = cast(Boost, e.element)
        found = periods(b, element.windows or ())
        amplitudes.append([element.amplitude])
        # periods before it that overlap take precedence, so one that is interrupted is written whole
        times.append([found[0][0], found[-1][1]] if found else [b.draft.start, b.draft.start])
    part = b.part("TimedBoost", {"amplitude": amplitudes, "onTimes": times})
    b.show(part)


def pattern(b: Given, element: Pattern) -> None:
    """Write CustomStimulus or TimedCustomStimulus."""
    _pattern(b, element.amplitude * _data(element.values), element.windows)


def sampled(b: Given, element: Stimulus) -> None:
    """Write the samples of a stimulus that cosivina does not have as a CustomStimulus."""
    axes = tuple(element.axes)
    with jax.enable_x64(True):
        values = np.asarray(element.pattern(Setting({}, {"output": axes}, "float64")))
    b.reasons.append(f"the samples of the {type(element).__name__}")
    _pattern(b, np.broadcast_to(values, shape(axes)), element.windows)


def series(b: Given, element: TimeSeries) -> None:
    """Write CustomStimulusSequence: patterns that are each shown until the next."""
    dims = b.dims()
    if element.interpolation != "hold" or element.period or element.windows is not None:
        raise Unwritable("cosivina shows one pattern after another, without interpolation, period or windows")
    values = element.amplitude * _data(element.values)
    moments = _data(element.times).reshape(-1)
    ticks = [round((t - b.draft.start) / b.draft.step) + 1 for t in moments]
    first_is_nothing = not values[0].any() and len(ticks) > 1 and ticks[1] == ticks[0] + 1
    if first_is_nothing:
        values, ticks = values[1:], ticks[1:]
    elif ticks[0] > 1:
        ticks[0] = 1
    if len(dims) > 2:
        raise Unwritable("cosivina shows patterns that are rows or planes")
    given = values.reshape(len(ticks), *size(dims))
    patterns: Any = given[:, 0].tolist() if is_row(dims) else array(np.moveaxis(given, 0, -1))
    if not is_row(dims):
        b.approximate("cosivina forgets, when it reads a file, that the patterns are planes")
    part = b.part(
        "CustomStimulusSequence",
        {
            "stimulusSize": size(dims),
            "stimulusPatterns": patterns,
            "startTimes": [b.draft.start + tick * b.draft.step for tick in ticks],
        },
    )
    b.say("times", "carried", "moved by one step, since cosivina counts the time before it computes")
    b.show(part)


def space_code(b: Given, element: SpaceCode) -> None:
    """Write ScalarToGaussian, with its position if elements read that."""
    dims = b.dims()
    if not is_row(dims):
        raise Unwritable("cosivina has a peak for a number on a row alone")
    (axis,) = element.axes
    gain, offset, sigma = (
        per_axis(value, element.axes)[0] for value in (element.gain, element.offset, element.sigma)
    )
    values = {
        "inputScale": gain if axis.step == 1 else gain / axis.step,
        "inputOffset": position(axis, offset),
        "sigma": width(axis, sigma),
        "amplitude": element.amplitude / (axis.step if element.normalized else 1),
        "circular": circular((axis,), element.boundary)[0],
        "normalized": element.normalized,
    }
    part = b.sized("ScalarToGaussian", values)
    place, scaled, moved = (b.draft.followers(b.id, what) for what in ("position", "scaled", "offset"))
    kinds = [type(e.element) for found in (place, scaled, moved) for e in found]
    if kinds == [Sum, Gain, Boost]:
        b.claim([*place, *scaled, *moved])
        b.show(part, "output", "position", of=place[0].id)
    b.carry(part)


def noise(b: Given, element: Noise) -> None:
    """Write NormalNoise; correlated noise has a kernel behind it."""
    part = noise_part(b, tuple(element.axes), element.amplitude, element.length)
    b.show(part, free=True)


def noise_part(b: Given, axes: Axes, strength: float, length: PerAxis, label: str = "") -> FilePart:
    """Add noise of a strength to the file, and its correlation in space; return the last part."""
    lengths = per_axis(length, axes)
    dims = layout(axes)
    if not any(lengths):
        amplitude = strength / math.sqrt(cell(axes))
        return b.sized("NormalNoise", {"amplitude": amplitude}, dims, label=label, beside=-2)
    white = b.sized(
        "NormalNoise", {"amplitude": strength}, dims, label=f"white {label or b.label}", beside=-2
    )
    sigmas = {a.name: v / a.step / math.sqrt(2) for a, v in zip(axes, lengths, strict=True)}
    scale = 1.0
    for a in axes:
        lags = np.arange(a.samples)
        lags = np.minimum(lags, a.samples - lags) if a.periodic else np.concatenate([-lags[:0:-1], lags])
        scale /= math.sqrt(float(np.sum(np.exp(-((lags / sigmas[a.name]) ** 2)))))
    values = kernel_values(dims, sigmas, {a.name: a.periodic for a in axes})
    rank = 1 if is_row(dims) else len(dims)
    if rank > len(LETTERS):
        raise Unwritable("cosivina has no kernel over four dimensions for correlated noise")
    if not all(a.periodic for a in axes):
        b.approximate("near the ends of a line its correlated noise is weaker in cosivina")
    part = b.sized(
        f"GaussKernel{rank}D",
        {**values, "amplitude": scale, "normalized": False, "cutoffFactor": 10},
        dims,
        label=label,
        beside=-1,
    )
    b.inner(part, white, dims=dims)
    return part


def kernel_values(
    dims: Dims, sigmas: dict[str, float], rings: dict[str, bool], part: str = ""
) -> dict[str, Any]:
    """Return the widths of a kernel, and whether it wraps, under cosivina's names."""
    rank = 1 if is_row(dims) else len(dims)
    out: dict[str, Any] = {}
    for d, axis in enumerate(dims if rank > 1 else dims[-1:]):
        letter = LETTERS[d] if rank > 1 else ""
        out[f"sigma{part}{letter}"] = 1 if axis is None else sigmas[axis.name]
        out[f"circular{letter}"] = True if axis is None else rings[axis.name]
    return out


def periods(b: Given, windows: Sequence[Window]) -> list[list[float]]:
    """Return the closed periods of windows; the time has advanced when cosivina computes."""
    start, step = b.draft.start, b.draft.step
    out: list[list[float]] = []
    for w in windows:  # a step counts if its time is in the window to half a step
        first = math.ceil((w.start - start) / step - 0.5) if w.start < FOR_EVER else math.inf
        last = math.ceil((w.stop - start) / step - 0.5) if w.stop < FOR_EVER else math.inf
        if last > max(first, 0):
            out.append([start + (first + 1) * step, start + last * step])
    return out


def array(values: np.ndarray) -> Any:
    """Return an array of three dimensions or more as JSONLab writes it."""
    return {
        "_ArrayType_": "double",
        "_ArraySize_": list(values.shape),
        "_ArrayData_": values.ravel(order="F").tolist(),
    }


def _pattern(b: Given, values: np.ndarray, windows: Sequence[Window] | None) -> None:
    dims = b.dims()
    given = values.reshape(size(dims))
    data = array(given) if given.ndim > 2 else given[0].tolist() if len(given) == 1 else given.tolist()
    if windows is not None:
        part = b.sized("TimedCustomStimulus", {"stimulusPattern": data, "onTimes": periods(b, windows)})
    else:
        part = b.sized("CustomStimulus", {"pattern": data})
    b.show(part, free=windows is None)


def _data(values: Any) -> np.ndarray:
    if not isinstance(values, FrozenArray):
        raise Unwritable("its values are in another file, which is not loaded")
    return np.asarray(values.data, np.float64)


KINDS = {
    GaussianStimulus: gaussian,
    BoxStimulus: sampled,
    Boost: boost,
    Pattern: pattern,
    TimeSeries: series,
    SpaceCode: space_code,
    Noise: noise,
}
