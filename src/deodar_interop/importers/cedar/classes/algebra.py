"""Algebra: sums, products, gains, convolutions and projections."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

from deodar.couplings.convolve import Convolve
from deodar.couplings.gain import Gain
from deodar.couplings.product import Product
from deodar.couplings.project import Project
from deodar.couplings.steered_convolve import SteeredConvolve
from deodar.couplings.sum import Sum
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.numerics.sigmoids.absolute import Absolute
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.border import border
from deodar_interop.importers.cedar.composition import Composition
from deodar_interop.importers.cedar.convolution_kernels import kernels, too_long
from deodar_interop.importers.cedar.file import members, text
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, Refused, SourceStep, StepPiece
from deodar_interop.importers.cedar.transfer import transferred
from deodar_interop.importers.cedar.values import StepValues, number

DROPPED = 4_294_967_295
"""The target of a dropped dimension in a projection's mapping: the largest number of 32 bits."""

REDUCTIONS = {"SUM": "sum", "AVERAGE": "mean", "MAXIMUM": "max", "MINIMUM": "min"}


def one_to_one(element: Element, slot: str, out: str, dims: Counts, why: str = "") -> StepPiece:
    """Return the translation of a step with one input and one output of the same element."""
    return StepPiece(
        [element],
        {slot: [[InputSlot(element.name)]]},
        {out: OutputSlot(element.name, dims)},
        needs=(slot,),
        why=why or type(element).__name__,
    )


def largest(inputs: Sequence[Counts], slot: str) -> Counts:
    """Return the size of several inputs; each is of that size, or one number.

    Raises:
        Refused: two sizes differ.
    """
    sizes = {dims for dims in inputs if dims}
    if len(sizes) > 1:
        raise Refused(f"the inputs at {slot!r} have different sizes: {', '.join(map(str, map(list, sizes)))}")
    return next(iter(sizes), ())


def gain(b: SourceStep) -> StepPiece:
    """Translate StaticGain."""
    element = Gain(b.values.number("gain factor", 1.0), name=b.label)
    return one_to_one(element, "input", "output", b.first("input"))


def add_constant(b: SourceStep) -> StepPiece:
    """Translate AddConstant: a sum with a boost."""
    dims = b.first("input")
    offset = Boost(b.named("constant"), (), b.values.number("constant", 0.0))
    piece = one_to_one(Sum(name=b.label), "input", "output", dims, why="Sum with a Boost")
    piece.elements.append(offset)
    piece.inner.append((offset.name, b.label))
    return piece


def convert_range(b: SourceStep) -> StepPiece:
    """Translate ConvertToValueRange: a linear map without limits."""
    dims = b.first("input")
    low, high = b.values.number("input lower bound", 0.0), b.values.number("input upper bound", 1.0)
    bottom, top = b.values.number("output lower bound", 0.0), b.values.number("output upper bound", 1.0)
    if high == low:
        raise Refused("its input bounds are equal")
    slope = (top - bottom) / (high - low)
    scaled = Gain(slope, name=b.named("slope"))
    offset = Boost(b.named("offset"), (), bottom - slope * low)
    return StepPiece(
        [Sum(name=b.label), scaled, offset],
        {"input": [[InputSlot(scaled.name)]]},
        {"converted output": OutputSlot(b.label, dims)},
        [(scaled.name, b.label), (offset.name, b.label)],
        needs=("input",),
        why="Gain, and Sum with a Boost",
    )


def total(b: SourceStep) -> StepPiece:
    """Translate Sum."""
    dims = largest(b.all("terms"), "terms")
    return StepPiece(
        [Sum(name=b.label)],
        {"terms": [[InputSlot(b.label)]]},
        {"sum": OutputSlot(b.label, dims)},
        sums=frozenset({"terms"}),
        wanted={"terms": dims},
        needs=("terms",),
        why="Sum",
    )


def subtract(b: SourceStep) -> StepPiece:
    """Translate SubtractElementwise; cedar raises an exception unless both sizes are equal."""
    first, second = b.first("minuend"), b.first("subtrahend")
    if first != second:
        raise Refused(f"the sizes {list(first)} and {list(second)} differ")
    minus = Gain(-1.0, name=b.named("minus"))
    return StepPiece(
        [Sum(name=b.label), minus],
        {"minuend": [[InputSlot(b.label)]], "subtrahend": [[InputSlot(minus.name)]]},
        {"result": OutputSlot(b.label, first)},
        [(minus.name, b.label)],
        needs=("minuend", "subtrahend"),
        why="Sum with a Gain of -1",
    )


def multiply(b: SourceStep) -> StepPiece:
    """Translate ComponentMultiply: a chain of products of two."""
    return chain(b, "operands", "product", lambda name: Product(name=name), "factor", "product {0}")


def chain(
    b: SourceStep, slot: str, out: str, of_two: Callable[[str], Element], port: str, called: str
) -> StepPiece:
    """Return a chain of couplings of two inputs, for a slot with any number of them.

    Args:
        b: the step.
        slot: its input slot.
        out: its output slot.
        of_two: creates the coupling of a name.
        port: the second port of the coupling.
        called: name of a coupling before the last, with its number {0}, or the number of its inputs {1}.
    """
    inputs = b.all(slot)
    dims = largest(inputs, slot)
    if len(inputs) == 1:
        return one_to_one(Sum(name=b.label), slot, out, dims, why="Sum, a copy of one input")
    # an array comes first, and single numbers at the second port
    order = sorted(range(len(inputs)), key=lambda k: not inputs[k])
    names = [b.named(called.format(k + 1, k + 2)) for k in range(len(inputs) - 2)] + [b.label]
    inlets: list[list[InputSlot]] = [[] for _ in inputs]
    inlets[order[0]] = [InputSlot(names[0])]
    for k, name in enumerate(names):
        inlets[order[k + 1]] = [InputSlot(name, port)]
    elements = [of_two(name) for name in reversed(names)]
    kind = type(elements[0]).__name__
    return StepPiece(
        elements,
        {slot: inlets},
        {out: OutputSlot(b.label, dims)},
        list(itertools.pairwise(names)),
        needs=(slot,),
        why=kind if len(names) == 1 else f"a chain of {len(names)} {kind}",
    )


def convolution(b: SourceStep) -> StepPiece:
    """Translate Convolution with a kernel that is an input, or a list of kernels; without kernels it copies
    its input.
    """
    dims = b.first("matrix")
    if "kernel" in b.ins:
        return _steered(b, dims)
    axes = b.axes(dims)
    ends = border(b.values, "convolution", len(dims))
    listed = b.values.objects("kernels")
    convolution_kernels = kernels(listed, axes, ends)
    if not convolution_kernels:
        return one_to_one(Sum(name=b.label), "matrix", "result", dims, why="Sum, a copy without kernels")
    if not dims:
        factor = sum(float(getattr(k, "amplitude", 0.0)) for k in convolution_kernels)
        return one_to_one(Gain(factor, name=b.label), "matrix", "result", dims)
    piece = one_to_one(Convolve(convolution_kernels, name=b.label), "matrix", "result", dims)
    piece.fails = too_long(listed, axes, ends)
    return piece


def _steered(b: SourceStep, dims: Counts) -> StepPiece:
    """Translate Convolution with a kernel that is an input, centred at its middle sample."""
    kernel, ends = b.first("kernel"), border(b.values, "convolution", len(dims))
    if "kernels" in b.values.body:
        b.values.say("kernels", "carried", "without effect beside a kernel that is an input")
    c = Composition(b)
    seen, by = c.slot("matrix"), c.slot("kernel")
    if not kernel:
        c.outlet("result", c.product("", seen, by), dims)
        return c.done("Product, since its kernel is one number")
    if len(kernel) != len(dims):
        raise Unfit(
            f"what it gives for a kernel of {len(kernel)} and an input of {len(dims)} dimensions is not"
            " documented"
        )
    axes = b.axes(dims)
    # cedar's centre of an even size is the earlier of both samples in the middle, or the later
    middle = [float(n // 2 if n % 2 or ends.later else n // 2 - 1) for n in kernel]
    element = SteeredConvolve(middle, boundary=ends.ends(axes), name=b.label)
    c.outlet("result", c.add(element, input=seen, kernel=by), dims)
    piece = c.done("SteeredConvolve")
    if ends.fourier and any(n > m for n, m in zip(kernel, dims, strict=True)):
        piece.fails = f"FFTW raises an exception for a kernel of {list(kernel)} samples for {list(dims)}"
    return piece


def projection(b: SourceStep) -> StepPiece:
    """Translate Projection, by cedar's rules for valid mappings."""
    element, dims = projected(b, b.values, b.first("input"), b.label, tuple(REDUCTIONS))
    return one_to_one(element, "input", "output", dims)


def projected(
    b: SourceStep, values: StepValues, counts: Counts, name: str, ways: Sequence[str]
) -> tuple[Project, Counts]:
    """Return the projection that the parameters of an object describe, and the size of its output.

    Args:
        b: the step.
        values: the object: the step itself, or an object inside it.
        counts: size of the input.
        name: name of the element.
        ways: reductions that cedar offers.

    Raises:
        Refused: cedar does not accept the mapping.
    """
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
        b.bug("two dimensions into three with exchanged axes leave slices empty")
    for source, target in mapping.items():
        new[target] = counts[source]
    dims = tuple(new)
    if not counts:
        # one number fills all
        return Project(b.axes(dims), name=name), dims
    target_axes, source_axes = b.axes(dims), b.axes(counts)
    names = {
        source_axes[s].name: target_axes[t].name
        for s, t in mapping.items()
        if source_axes[s].name != target_axes[t].name
    }
    names |= {
        a.name: f"{a.name} added up"
        for s, a in enumerate(source_axes)
        if s not in mapping and a.name in [c.name for c in target_axes]
    }
    return Project(target_axes, REDUCTIONS[reduction], names, name=name), dims


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


def transfer(b: SourceStep) -> StepPiece:
    """Translate TransferFunction."""
    dims, c = b.first("input"), Composition(b)
    sigmoided = transferred(c, "", "function", Absolute(100.0, 0.0), c.slot("input"))
    c.outlet("sigmoided output", sigmoided, dims)
    return c.done(type(next(e for e in c.piece.elements if e.name == b.label)).__name__)


def transpose(b: SourceStep) -> StepPiece:
    """Translate Transpose; a vector remains a vector."""
    dims = b.first("matrix")
    if len(dims) > 2:
        raise Refused(f"its input has {len(dims)} dimensions")
    if len(dims) < 2:
        return one_to_one(Sum(name=b.label), "matrix", "transposed", dims, why="Sum, a copy")
    target_axes, source_axes = b.axes(dims[::-1]), b.axes(dims)
    names = {a.name: c.name for a, c in zip(source_axes, target_axes[::-1], strict=True) if a.name != c.name}
    return one_to_one(Project(target_axes, "sum", names, name=b.label), "matrix", "transposed", dims[::-1])


CLASSES = {
    "cedar.processing.StaticGain": gain,
    "cedar.processing.steps.AddConstant": add_constant,
    "cedar.processing.ConvertToValueRange": convert_range,
    "cedar.processing.steps.Sum": total,
    "cedar.processing.SubtractElementwise": subtract,
    "cedar.processing.ComponentMultiply": multiply,
    "cedar.processing.steps.Convolution": convolution,
    "cedar.processing.Projection": projection,
    "cedar.processing.TransferFunction": transfer,
    "cedar.processing.Transpose": transpose,
}
