"""Fields, memory traces, and the codes between space and rate.

A matrix of rates has a code in space, too: a third dimension whose bins stand for ranges of the rate.
"""

from __future__ import annotations

import dataclasses as dc

import numpy as np

from deodar.couplings.positions import RateCode, SpaceCode
from deodar.elements.field import Field
from deodar.elements.memories import MemoryTrace
from deodar.elements.stimuli import Pattern
from deodar.elements.variables import Attractor
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import TruncatedGaussian
from deodar.numerics.sigmoids import Absolute, Linear
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.convolution_kernels import CedarBorder, border, kernels, too_long
from deodar_interop.importers.cedar.piece import Refused, sizes
from deodar_interop.importers.cedar.transfer import sigmoid, special, transferred
from deodar_interop.importers.cedar.values import StepValues
from deodar_interop.importers.cedar.wiring import BUFFER

MOST_DIMENSIONS = 4
LEAST = 1e-9
"""Sum of an input up to which there is no peak: cedar divides by any sum above 0."""

DEFAULT_KERNEL = ("cedar.aux.kernel.Gauss", {"amplitude": "1"})
"""The kernel of a field whose file states none: amplitude 1, width 3."""


@step("cedar.dynamics.NeuralField", sized=True, looped=True)
def neural_field(s: SourceStep) -> None:
    """Translate NeuralField, with its kernels and its noise."""
    values = s.values
    dims = sizes(values, 50, MOST_DIMENSIONS)
    axes = s.axes(dims)
    ends = border(values, "lateral kernel convolution", len(dims))
    listed = (
        values.objects("lateral kernels")
        if "lateral kernels" in values.body
        else [(DEFAULT_KERNEL[0], StepValues(DEFAULT_KERNEL[1], values.where))]
    )
    apart = special(values, "sigmoid")
    field = Field(
        s.label,
        axes,
        tau=_tau(s, "time scale", 100.0),
        resting_level=values.number("resting level", -5.0),
        sigmoid=Linear(1.0) if apart else sigmoid(values, "sigmoid", Absolute(100.0, 0.0)),
        kernel=kernels(listed, axes, ends),
        global_inhibition=-values.number("global inhibition", -0.01) + 0.0,
        noise=values.number("input noise gain", 0.1, 0.0),
    )
    if apart == "Logarithm":
        values.say("sigmoid", "approximated", "of 0 and less it is -69 here, undefined in cedar")
    if ends.type == "Cyclic" and not ends.fourier and _unequal(field):
        s.bug("a cyclic convolution in two dimensions mixes up the widths of its two factors at the border")
    for name in ("multiplicative noise (input)", "multiplicative noise (activation)"):
        if values.flag(name, False):
            values.say(name, "approximated", "the noise here does not depend on input or activation")
    _correlation(values)
    for name in (
        "discrete metric (workaround)",
        "update stepIcon according to output",
        "threshold for updating the stepIcon",
    ):
        if name in values.body:
            values.say(name, "carried", "only a matter of cedar's plots and icons")
    shows_activation = values.flag("activation as output", False)
    field_output = s.add(dc.replace(field, kernel=[], global_inhibition=0.0) if apart else field)
    activation = dc.replace(field_output, port="activation")
    s.outlet("sigmoided activation", _own_output(s, field, activation) if apart else field_output)
    s.outlet(f"{BUFFER}activation", activation, state=True)
    if shows_activation:
        s.outlet("activation", activation, state=True)
    s.connect(s.slot("input", dims, sums=True), field_output)
    s.piece.fails = too_long(listed, axes, ends)


def _own_output(s: SourceStep, field: Field, activation: StepSignal) -> StepSignal:
    """Return the output of a field whose kernels and global inhibition are couplings of its activation."""
    output = transferred(s, "output", "sigmoid", Absolute(100.0, 0.0), activation)
    if field.kernel:
        s.connect(s.convolved("lateral interaction", field.kernel, output), activation)
    if field.global_inhibition:
        total = s.reduced("total", output) if output.dims else output
        s.connect(s.gain("global inhibition", -field.global_inhibition, total), activation)
    s.explain("Field, with its output function and interaction as couplings")
    return output


def _unequal(field: Field) -> bool:
    """Return whether a kernel over two dimensions has two widths."""
    return len(field.axes) == 2 and any(
        isinstance(k, TruncatedGaussian) and isinstance(k.sigma, tuple) and len(set(k.sigma)) > 1
        for k in field.kernel
    )


def _correlation(values: StepValues) -> None:
    """Report the kernel that correlates noise inside cedar's output function."""
    name = "noise correlation kernel"
    if name not in values.body:
        return
    inside = values.inside(name)
    if inside.number("amplitude", 0.0) == 0:
        for key in (*inside.body, ""):
            if key:
                inside.say(key, "carried", "without effect, since its amplitude is 0")
        values.say(name, "carried", "without effect, since its amplitude is 0")
    else:
        for key in inside.body:
            inside.say(key, "dropped", "cedar adds this noise inside the output function")
        values.say(name, "dropped", "cedar adds this noise inside the output function; deodar does not")


def _tau(s: SourceStep, name: str, default: float) -> float:
    """Return a time constant, at least the step."""
    tau = s.values.time(name, default)
    if tau < s.dt:
        s.values.say(name, "approximated", f"{tau:g} ms is below the step; {s.dt:g} ms is used")
        return s.dt
    return tau


@step("cedar.dynamics.Preshape", sized=True, looped=True)
def preshape(s: SourceStep) -> None:
    """Translate Preshape, cedar's memory trace: it builds up towards its input, weighted by f(input)."""
    values = s.values
    dims = sizes(values, 50, MOST_DIMENSIONS)
    peak = s.optional("peak detector", ())
    trace = MemoryTrace(
        s.label,
        s.axes(dims),
        tau_build=_tau(s, "time scale build up", 100.0),
        tau_decay=_tau(s, "time scale decay", 1000.0),
        activity=sigmoid(values, "sigmoid", Absolute(1000.0, 0.5)),
        fades=True,
        gated=peak is not None,
        start=s.stored("activation", dims),
    )
    activation = s.add(trace, input=s.slot("input", dims))
    if peak is not None:
        s.connect(peak, activation, "gate")
    s.outlet("activation", activation, state=True)


@step("cedar.dynamics.SpaceToRateCode", "input", looped=True)
def space_to_rate(s: SourceStep, seen: StepSignal) -> None:
    """Translate SpaceToRateCode: a read-out that relaxes to the position of a peak."""
    values = s.values
    if len(seen.dims) != 1:
        raise Unfit(f"its input has {len(seen.dims)} dimensions; it reads one")
    axis, count = seen.axes[0], seen.dims[0]
    lower, upper = values.number("lowerLimit", 0.0), values.number("upperLimit", 1.0)
    gain = (upper - lower) / max(count - 1, 1)
    tau = _tau(s, "tau", 100.0)
    cyclic, jumps = values.flag("use cyclic mean", False), values.flag("jump to fixed point", False)
    if values.flag("NaN if no peak", False):
        values.say(
            "NaN if no peak", "approximated", "the last position remains" if not jumps else "0 is given"
        )
    if not cyclic and not jumps:
        s.outlet(
            "output",
            s.add(Attractor(s.label, axis, tau, gain=gain, offset=lower), (), input=seen),
            state=True,
        )
        return
    if gain == 0:
        raise Unfit("its limits are equal")
    if cyclic:
        # cedar spreads the samples over a whole turn, whatever the field's own border
        axis = Axis("turn", 0, count, count, periodic=True)
        seen = s.turned("ring", np.eye(count), axis, seen, 0)
        gain = (upper - lower) / count
    if "tau" in values.body:
        values.say("tau", "carried", "without effect: the output jumps to the position")
    # cedar gives the position; deodar's gain is in axis units per unit of the output
    code = RateCode([axis], gain=1 / gain, offset=-lower / gain, least=LEAST, absent=lower, name=s.label)
    s.outlet("output", s.add(code, (), input=seen))


@step("cedar.dynamics.RateToSpaceCode", "input", gives="output")
def rate_to_space(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate RateToSpaceCode: a Gaussian whose place is the input."""
    values = s.values
    count = max(seen.dims[0] if seen.dims else 0, 1)
    dims = tuple(int(n) for n in values.numbers("output sizes", 50, count, 1, 1e6))
    lower, upper = values.numbers("lower limits", 0.0, count), values.numbers("upper limits", 1.0, count)
    if any(high == low for low, high in zip(lower, upper, strict=True)):
        raise Unfit("its limits are equal")
    gains = [n / (high - low) for n, low, high in zip(dims, lower, upper, strict=True)]
    offsets = [-low * gain for low, gain in zip(lower, gains, strict=True)]
    axes = s.axes(dims)
    ends = CedarBorder("Cyclic" if values.flag("cyclic", False) else "Zero").ends(axes)
    sigmas, amplitude = values.numbers("sigma", 3.0, count, 1e-6), values.number("amplitude", 1.0)
    s.piece.wanted["input"] = () if count == 1 else (count,)
    return s.add(
        SpaceCode(axes, sigmas, amplitude, gains, offsets, boundary=ends, name=s.label), axes, input=seen
    )


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
