"""Matrices of rates, and their code in space: a third dimension whose bins stand for ranges of the rate."""

from __future__ import annotations

import numpy as np

from deodar.elements.pattern import Pattern
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.piece import Refused

MOST_BINS = 10_000

MOST_COMPARED = 4_000_000
"""Most comparisons of rates with edges of bins (a guess)."""

EDGE = 1e-6
"""By how much a rate between two bins counts as larger, in bins: it is in the upper one. A sample that is
smaller than the largest one by less than this counts as equal, because the last digit may differ.
"""


@step("cedar.dynamics.RateMatrixToSpaceCode", "bin map", "values?", gives="output")
def rates_to_space(s: SourceStep, rates: StepSignal, bin_values: StepSignal | None) -> StepSignal:
    """Translate RateMatrixToSpaceCode: each rate makes one bin along the third dimension 1, or a value.

    The rates above each edge of a bin are 1; the difference of two edges is the bin between them.
    """
    dims, values = rates.dims, s.values
    if len(dims) != 2:
        raise Unfit(f"what it gives for rates of {len(dims)} dimensions is not documented")
    bins = values.whole("number of bins", 10, 1, MOST_BINS)
    lower, upper = values.number("lower limit", 0.0), values.number("upper limit", 1.0)
    if upper == lower or bins == 1:
        raise Unfit("its limits are equal" if upper == lower else "it has one bin, whose range is unknown")
    if dims[0] * dims[1] * (bins + 1) > MOST_COMPARED:
        raise Unfit(f"it compares {dims[0] * dims[1]} rates with {bins + 1} edges")
    slope, out, edge = (bins - 1) / (upper - lower), s.axes((*dims, bins)), Axis("edge", 0, bins, bins + 1)
    places = s.gain("in bins", slope, rates)
    wide = s.projected("at every edge", places, (*rates.axes, edge), rates.axes)
    edges = s.add(Pattern(s.named("edges"), [edge], -slope * lower - np.arange(bins + 1) + 0.5))
    above = s.above("above", -EDGE, s.total("distance", wide, edges))
    between = np.eye(bins, bins + 1) - np.eye(bins, bins + 1, 1)
    why = "a comparison with every edge; the bins of rates between two and beyond the limits are a guess"
    s.explain(why, "approximated")
    if bin_values is None:
        return s.turned("", between, out[2], above, 2)
    if bin_values.dims != dims:
        raise Refused(f"its values have the size {list(bin_values.dims)}, and its rates {list(dims)}")
    spread = s.projected("values in bins", bin_values, out, out[:2])
    return s.product("", s.turned("bins", between, out[2], above, 2), spread)


@step("cedar.dynamics.SpaceCodeToRateMatrix", "input", gives="output")
def space_to_rates(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate SpaceCodeToRateMatrix: the rate of the largest bin along the third dimension.

    The largest samples have distance 0 from the maximum. The smallest index is that of the first of them
    after the indices of all others were moved beyond the last bin.
    """
    if len(seen.dims) != 3:
        raise Refused(f"its input has {len(seen.dims)} dimensions, not three")
    lower, upper = s.values.number("lower limit", 0.0), s.values.number("upper limit", 1.0)
    every, bins = seen.axes, seen.dims[2]
    out = s.axes(tuple(n for n in seen.dims[:2] if n > 1))
    remaining = iter(out)
    places = [next(remaining) if n > 1 else None for n in seen.dims[:2]] + [None]
    top = s.projected("largest", seen, every[:2], [*every[:2], None], "max")
    wide = s.projected("largest at every bin", top, every, every[:2])
    others = s.above("not largest", EDGE, s.total("distance", wide, s.gain("minus", -1.0, seen)))
    index = s.add(Pattern(s.named("bins"), [every[2]], np.arange(float(bins))))
    moved = s.total("bins of the largest", s.gain("beyond", float(bins), others), index)
    first = s.projected("first", moved, out, places, "min")
    why = "the first of the largest samples; the rates of the bins, and of equal samples, are a guess"
    s.explain(why, "approximated")
    rate = s.gain("above the lower limit", (upper - lower) / max(bins - 1, 1), first)
    return s.total("", rate, s.constant("lower limit", lower))
