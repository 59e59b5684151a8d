"""Algebra: sums, products, gains, convolutions, projections, and a whole connection of these."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from deodar.couplings.convolutions import SteeredConvolve
from deodar.elements.stimuli import Pattern
from deodar.numerics.sigmoids import Absolute
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.convolution_kernels import CedarBorder, border, kernels, too_long
from deodar_interop.importers.cedar.file import members, text
from deodar_interop.importers.cedar.piece import Refused
from deodar_interop.importers.cedar.transfer import transferred
from deodar_interop.importers.cedar.values import StepValues, number

DROPPED = 4_294_967_295
"""The target of a dropped dimension in a projection's mapping: the largest number of 32 bits."""

REDUCTIONS = {"SUM": "sum", "AVERAGE": "mean", "MAXIMUM": "max", "MINIMUM": "min"}


@step("cedar.processing.StaticGain", "input", gives="output")
def gain(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate StaticGain."""
    return s.gain("", s.values.number("gain factor", 1.0), seen)


@step("cedar.processing.steps.AddConstant", "input", gives="output", why="Sum with a Boost")
def add_constant(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate AddConstant: a sum with a boost."""
    return s.total("", seen, s.constant("constant", s.values.number("constant", 0.0)))


@step("cedar.processing.ConvertToValueRange", "input", gives="converted output")
def convert_range(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate ConvertToValueRange: a linear map without limits."""
    low, high = s.values.number("input lower bound", 0.0), s.values.number("input upper bound", 1.0)
    bottom, top = s.values.number("output lower bound", 0.0), s.values.number("output upper bound", 1.0)
    if high == low:
        raise Refused("its input bounds are equal")
    slope = (top - bottom) / (high - low)
    s.explain("Gain, and Sum with a Boost")
    return s.total("", s.gain("slope", slope, seen), s.constant("offset", bottom - slope * low))


@step("cedar.processing.steps.Sum", gives="sum")
def total(s: SourceStep) -> StepSignal:
    """Translate Sum."""
    return s.total("", s.added("terms"))


@step(
    "cedar.processing.SubtractElementwise",
    "minuend",
    "subtrahend",
    gives="result",
    why="Sum with a Gain of -1",
)
def subtract(s: SourceStep, first: StepSignal, second: StepSignal) -> StepSignal:
    """Translate SubtractElementwise; cedar raises an exception unless both sizes are equal."""
    s.require_equal(first, second)
    return s.total("", first, s.gain("minus", -1.0, second))


@step("cedar.processing.ComponentMultiply", gives="product")
def multiply(s: SourceStep) -> StepSignal:
    """Translate ComponentMultiply: a chain of products of two."""
    return chain(s, "operands", s.product, "product {0}")


def chain(
    s: SourceStep, slot: str, of_two: Callable[[str, StepSignal, StepSignal], StepSignal], called: str
) -> StepSignal:
    """Return a chain of couplings of two inputs, for a slot with any number of them.

    Args:
        s: the step.
        slot: its input slot.
        of_two: adds the coupling of a role, of an array and of another array or a number.
        called: role of a coupling before the last, with its number {0}, or the number of its inputs {1}.
    """
    combined, *others = sorted(s.all_at(slot), key=lambda signal: not signal.dims)
    if not others:
        return s.copy(combined, "Sum, a copy of one input")
    for k, signal in enumerate(others, 1):
        combined = of_two(called.format(k, k + 1) if k < len(others) else "", combined, signal)
    if len(others) > 1:
        s.explain(f"a chain of {len(others)} {type(s.piece.elements[-1]).__name__}")
    return combined


@step("cedar.processing.steps.Convolution", "matrix", "kernel?", gives="result")
def convolution(s: SourceStep, seen: StepSignal, by: StepSignal | None) -> StepSignal:
    """Translate Convolution with a kernel that is an input, or a list of kernels; without kernels it copies
    its input.
    """
    ends = border(s.values, "convolution", len(seen.dims))
    if by is not None:
        return _steered(s, ends, seen, by)
    listed = s.values.objects("kernels")
    convolution_kernels = kernels(listed, seen.axes, ends)
    if not convolution_kernels:
        return s.copy(seen, "Sum, a copy without kernels")
    s.piece.fails = too_long(listed, seen.axes, ends) if seen.dims else ""
    return s.convolved("", convolution_kernels, seen)


def _steered(s: SourceStep, ends: CedarBorder, seen: StepSignal, by: StepSignal) -> StepSignal:
    """Translate Convolution with a kernel that is an input, centred at its middle sample."""
    if "kernels" in s.values.body:
        s.values.say("kernels", "carried", "without effect beside a kernel that is an input")
    if not by.dims:
        s.explain("Product, since its kernel is one number")
        return s.product("", seen, by)
    if len(by.dims) != len(seen.dims):
        raise Unfit(
            f"what it gives for a kernel of {len(by.dims)} and an input of {len(seen.dims)} dimensions is not"
            " documented"
        )
    # cedar's centre of an even size is the earlier of both samples in the middle, or the later
    middle = [float(n // 2 if n % 2 or ends.later else n // 2 - 1) for n in by.dims]
    if ends.fourier and any(n > m for n, m in zip(by.dims, seen.dims, strict=True)):
        why = f"FFTW raises an exception for a kernel of {list(by.dims)} samples for {list(seen.dims)}"
        s.piece.fails = why
    element = SteeredConvolve(middle, boundary=ends.ends(seen.axes), name=s.label)
    return s.add(element, input=seen, kernel=by)


@step("cedar.processing.Projection", "input", gives="output")
def projection(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Projection, by cedar's rules for valid mappings."""
    return remapped(s, s.values, seen, tuple(REDUCTIONS))


def remapped(s: SourceStep, values: StepValues, seen: StepSignal, ways: Sequence[str]) -> StepSignal:
    """Return the projection of a signal that the parameters of an object describe.

    Args:
        s: the step.
        values: the object: the step itself, or an object inside it.
        seen: the input.
        ways: reductions that cedar offers.

    Raises:
        Refused: cedar does not accept the mapping.
    """
    counts = seen.dims
    count = values.whole("output dimensionality", 1, 0, 4)
    if count or "output dimension sizes" not in values.body:
        new = [int(n) for n in values.numbers("output dimension sizes", 50, count, 1, 1e6)]
    else:
        values.say("output dimension sizes", "carried", "none for one number")
        new = []
    reduction = values.word("compression type", "SUM", ways)
    mapping = _mapping(values, len(counts))
    _require_valid(mapping, len(counts), count)
    if len(counts) == 2 and count == 3 and (mapping[0], mapping[1]) == (2, 0) and new[0] != new[1]:
        s.bug("two dimensions into three with exchanged axes leave slices empty")
    for source, target in mapping.items():
        new[target] = counts[source]
    axes = s.axes(tuple(new))
    places = [axes[mapping[d]] if d in mapping else None for d in range(len(counts))]
    # one number fills all
    return s.projected("", seen, axes, places, REDUCTIONS[reduction] if counts else "integral")


def _mapping(values: StepValues, count: int) -> dict[int, int]:
    """Return the dimensions that remain, and their places in the output."""
    stated = members(values.body.get("dimension mapping"))
    values.say("dimension mapping")
    out: dict[int, int] = {}
    for key, value in stated.items():
        source, target = number(key), number(value)
        if source is None or (target is None and text(value)):
            raise Refused(f"its mapping of dimension {key!r} to {value!r} is not a number")
        if target is not None and target != DROPPED and int(source) < count:
            out[int(source)] = int(target)
    return out


def _require_valid(mapping: dict[int, int], dimensions: int, count: int) -> None:
    """Raise unless cedar accepts a mapping from `given` to `count` dimensions.

    Raises:
        Refused: it does not.
    """
    if any(not 0 <= target < count for target in mapping.values()):
        raise Refused(f"its mapping leads to a dimension that an output of {count} dimensions does not have")
    if len(set(mapping.values())) < len(mapping):
        raise Refused("two dimensions are mapped to one")
    dropped = dimensions - len(mapping)
    if not count:
        return
    if dimensions and not mapping:
        raise Refused("all dimensions are dropped, and the output has some")
    if dropped and count >= dimensions:
        raise Refused("a dimension is dropped, and the output has no fewer dimensions than the input")
    if dimensions > count and len(mapping) != count:
        raise Refused(
            f"{dimensions - len(mapping)} of {dimensions} dimensions are dropped for an output of {count}"
        )


@step("cedar.processing.TransferFunction", "input", gives="sigmoided output")
def transfer(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate TransferFunction."""
    return transferred(s, "", "function", Absolute(100.0, 0.0), seen)


@step("cedar.processing.Transpose", "matrix", gives="transposed")
def transpose(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Transpose; a vector remains a vector."""
    if len(seen.dims) > 2:
        raise Refused(f"its input has {len(seen.dims)} dimensions")
    if len(seen.dims) < 2:
        return s.copy(seen)
    axes = s.axes(seen.dims[::-1])
    return s.projected("", seen, axes, axes[::-1])


CONNECTION_REDUCTIONS = ("SUM", "MAXIMUM")
"""Reductions that SynapticConnection offers."""


@step("cedar.processing.SynapticConnection", gives="result")
def synaptic(s: SourceStep) -> StepSignal:
    """Translate SynapticConnection: the inputs are added up, convolved, multiplied by point-wise weights and
    by one weight, and projected.
    """
    signal = s.added("matrix")
    if len(s.ins["matrix"]) > 1:
        signal = s.total("inputs", signal)
    convolved = _convolved(s, signal)
    signal = _weighted(s, convolved)
    is_weighted = signal is not convolved
    inside = s.values.inside("projection")
    enabled = inside.flag("enabled", False)
    if "static gain" in s.values.body:
        s.values.say("static gain")
    weight = s.values.inside("static gain").number("Synapse Weight", 1.0)
    signal = s.gain("weight" if enabled else "", weight, signal)
    if enabled:
        signal = remapped(s, inside, signal, CONNECTION_REDUCTIONS)
    else:
        for key in inside.body:
            if key != "enabled":
                inside.say(key, "carried", "without effect: the projection is not enabled")
    if "projection" in s.values.body:
        s.values.say("projection")
    why = ", ".join(dict.fromkeys(type(element).__name__ for element in s.piece.elements))
    if is_weighted:
        s.explain(f"{why}; that point-wise weights lie around the middle is a guess", "approximated")
    else:
        s.explain(why)
    return signal


def _convolved(s: SourceStep, signal: StepSignal) -> StepSignal:
    """Return a signal convolved with the kernels of the object `convolution`; without kernels itself."""
    ends = border(s.values, "convolution", len(signal.dims))
    listed = s.values.inside("convolution").objects("kernels")
    s.piece.fails = too_long(listed, signal.axes, ends) if signal.dims else ""
    convolution = kernels(listed, signal.axes, ends)
    return s.convolved("convolved", convolution, signal) if convolution else signal


def _weighted(s: SourceStep, signal: StepSignal) -> StepSignal:
    """Return a signal multiplied by the kernels of the object `PointWiseWeight`; without kernels itself.

    The kernels lie around the middle sample: the weights are what they make of one active sample there.
    """
    if "PointWiseWeight" in s.values.body:
        s.values.say("PointWiseWeight")
    listed = s.values.inside("PointWiseWeight").objects("kernels")
    point_kernels = kernels(listed, signal.axes, CedarBorder())
    if not point_kernels:
        return signal
    if not signal.dims:
        return s.convolved("point-wise weight", point_kernels, signal)
    impulse = np.zeros(signal.dims)
    impulse[tuple(n // 2 for n in signal.dims)] = 1.0
    middle = s.add(Pattern(s.named("middle"), signal.axes, impulse))
    return s.product("weighted", signal, s.convolved("point-wise weights", point_kernels, middle))
