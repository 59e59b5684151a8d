"""Matrices of rates, and their code in space: a third dimension whose bins stand for ranges of the rate."""

from __future__ import annotations

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.elements.pattern import Pattern
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import Composition
from deodar_interop.importers.cedar.piece import Refused, SourceStep, StepPiece

MOST_BINS = 10_000

MOST_COMPARED = 4_000_000
"""Most comparisons of rates with edges of bins (a guess)."""

EDGE = 1e-6
"""By how much a rate between two bins counts as larger, in bins: it is in the upper one. A sample that is
smaller than the largest one by less than this counts as equal, because the last digit may differ.
"""


def rates_to_space(b: SourceStep) -> StepPiece:
    """Translate RateMatrixToSpaceCode: each rate makes one bin along the third dimension 1, or a value.

    The rates above each edge of a bin are 1; the difference of two edges is the bin between them.
    """
    dims, values = b.first("bin map"), b.values
    if len(dims) != 2:
        raise Unfit(f"what it gives for rates of {len(dims)} dimensions is not documented")
    bins = values.whole("number of bins", 10, 1, MOST_BINS)
    lower, upper = values.number("lower limit", 0.0), values.number("upper limit", 1.0)
    if upper == lower or bins == 1:
        raise Unfit("its limits are equal" if upper == lower else "it has one bin, whose range is unknown")
    if dims[0] * dims[1] * (bins + 1) > MOST_COMPARED:
        raise Unfit(f"it compares {dims[0] * dims[1]} rates with {bins + 1} edges")
    slope, flat, out = (bins - 1) / (upper - lower), b.axes(dims), b.axes((*dims, bins))
    edge = Axis("edge", 0, bins, bins + 1)
    every, c = (*flat, edge), Composition(b)
    places = c.gain("in bins", slope, c.slot("bin map"))
    wide = c.projected("at every edge", places, flat, every, list(flat))
    edges = Pattern(b.named("edges"), [edge], -slope * lower - np.arange(bins + 1) + 0.5)
    above = c.above("above", -EDGE, c.total("distance", wide, c.add(edges)))
    between = np.eye(bins, bins + 1) - np.eye(bins, bins + 1, 1)
    has_values = "values" in b.ins
    if has_values and b.first("values") != dims:
        raise Refused(f"its values have the size {list(b.first('values'))}, and its rates {list(dims)}")
    name = c.named("bins" if has_values else "")
    binned = c.add(AxisWeights(between, out[2], "edge", name=name), input=above)
    if has_values:
        binned = c.product("", binned, c.projected("values in bins", c.slot("values"), flat, out, out[:2]))
    c.outlet("output", binned, (*dims, bins))
    why = "a comparison with every edge; the bins of rates between two and beyond the limits are a guess"
    return c.done(why, "approximated")


def space_to_rates(b: SourceStep) -> StepPiece:
    """Translate SpaceCodeToRateMatrix: the rate of the largest bin along the third dimension.

    The largest samples have distance 0 from the maximum. The smallest index is that of the first of them
    after the indices of all others were moved beyond the last bin.
    """
    dims, values = b.first("input"), b.values
    if len(dims) != 3:
        raise Refused(f"its input has {len(dims)} dimensions, not three")
    lower, upper = values.number("lower limit", 0.0), values.number("upper limit", 1.0)
    every, bins, c = b.axes(dims), dims[2], Composition(b)
    flat = tuple(n for n in dims[:2] if n > 1)
    out_axes, remaining = b.axes(flat), iter(b.axes(flat))
    places = [next(remaining) if n > 1 else None for n in dims[:2]] + [None]
    seen = c.slot("input")
    top = c.projected("largest", seen, every, every[:2], [*every[:2], None], "max")
    wide = c.projected("largest at every bin", top, every[:2], every, every[:2])
    others = c.above("not largest", EDGE, c.total("distance", wide, c.gain("minus", -1.0, seen)))
    index = c.add(Pattern(c.named("bins"), [every[2]], np.arange(float(bins))))
    moved = c.total("bins of the largest", c.gain("beyond", float(bins), others), index)
    first = c.projected("first", moved, every, out_axes, places, "min")
    rate = c.gain("above the lower limit", (upper - lower) / max(bins - 1, 1), first)
    c.outlet("output", c.total("", rate, c.constant("lower limit", lower)), flat)
    why = "the first of the largest samples; the rates of the bins, and of equal samples, are a guess"
    return c.done(why, "approximated")


CLASSES = {
    "cedar.dynamics.RateMatrixToSpaceCode": rates_to_space,
    "cedar.dynamics.SpaceCodeToRateMatrix": space_to_rates,
}
