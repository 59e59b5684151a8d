"""Arrays: resizing, cropping, padding, permuting, collecting and separating."""

from __future__ import annotations

import dataclasses as dc
import itertools
import math
from collections.abc import Sequence

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.gain import Gain
from deodar.couplings.pointwise import Pointwise
from deodar.couplings.product import Product
from deodar.couplings.project import Project
from deodar.couplings.sigmoid import Sigmoid
from deodar.couplings.space_code import SpaceCode
from deodar.couplings.sum import Sum
from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.pattern import Pattern
from deodar.numerics.axes import Axis
from deodar.numerics.sigmoids.step import Step
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.algebra import one_to_one
from deodar_interop.importers.cedar.composition import Composition
from deodar_interop.importers.cedar.file import items, text
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.interpolation import WAYS, matrix
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, Refused, SourceStep, StepPiece, sizes

MOST_SCALARS = 255
EDGE = 1e-6
"""By how much an edge lies before its sample: deodar's step is 1 only above its threshold."""


def along_axes(
    b: SourceStep,
    slot: str,
    out: str,
    matrices: Sequence[np.ndarray | None],
    dims: Counts,
    why: str,
) -> StepPiece:
    """Return a chain of weights along the axes of an input; None leaves an axis as it is.

    The last element has the step's name.
    """
    counts = b.first(slot)
    target_axes, source_axes = b.axes(dims), b.axes(counts)
    changed = {d: m for d, m in enumerate(matrices) if m is not None}
    if not changed:
        return one_to_one(Sum(name=b.label), slot, out, counts, why="Sum, a copy")
    last = max(changed)
    names = [b.label if d == last else b.named(f"along {target_axes[d].name}") for d in changed]
    elements = [
        AxisWeights(m, target_axes[d], source_axes[d].name, name=name)
        for (d, m), name in zip(changed.items(), names, strict=True)
    ]
    return StepPiece(
        [*elements[::-1]],
        {slot: [[InputSlot(names[0])]]},
        {out: OutputSlot(b.label, dims)},
        list(itertools.pairwise(names)),
        needs=(slot,),
        why=why,
    )


def resize(b: SourceStep) -> StepPiece:
    """Translate Resize: each axis of the input has another number of samples over the same extent."""
    counts = b.first("input")
    if not counts:
        raise Refused("its input is one number")
    dims = tuple(int(n) for n in b.values.numbers("output size", 50, len(counts), 1, 5000))
    interpolation = b.values.word("interpolation", "LINEAR", WAYS)
    if len(counts) > 2:
        if interpolation != "LINEAR":
            b.values.say("interpolation", "carried", "cedar resizes three dimensions linearly only")
        interpolation = "LINEAR"
        b.bug("resizing three dimensions mixes up the weights of neighbours")
    if interpolation == "LANCZOS4":
        b.values.say("interpolation", "approximated", "CUBIC is used")
    matrices = [None if n == m else matrix(n, m, interpolation) for n, m in zip(counts, dims, strict=True)]
    return along_axes(b, "input", "output", matrices, dims, "AxisWeights")


def flip(b: SourceStep) -> StepPiece:
    """Translate Flip."""
    counts = b.first("input")
    listed = [text(v) != "false" for v in items(b.values.body.get("flipped dimensions"))]
    b.values.say("flipped dimensions")
    flags = (listed + [True] * len(counts))[: len(counts)]
    matrices = [np.eye(n)[::-1] if f else None for n, f in zip(counts, flags, strict=True)]
    return along_axes(b, "input", "output", matrices, counts, "AxisWeights")


def cut(b: SourceStep) -> StepPiece:
    """Translate MatrixSlice: a part of each axis, its upper end excluded."""
    counts = b.first("matrix")
    count = len(counts)
    lower, upper = (
        b.values.numbers(f"range {end}", float(v), count) for end, v in (("lower", 0), ("upper", 1))
    )
    if b.values.word("anchor type", "Absolute", ("Absolute", "Center")) == "Center":
        half = [n // 2 for n in counts]
        lower = [v + h for v, h in zip(lower, half, strict=True)]
        upper = [v + h for v, h in zip(upper, half, strict=True)]
    spans = [(int(a), int(z)) for a, z in zip(lower, upper, strict=True)]
    if any(not 0 <= a < z <= n for (a, z), n in zip(spans, counts, strict=True)):
        raise Refused(f"its range {spans} is not inside an array of {list(counts)}")
    dims = tuple(z - a for a, z in spans)
    matrices = [np.eye(n)[a:z] if (a, z) != (0, n) else None for (a, z), n in zip(spans, counts, strict=True)]
    return _shrunk(along_axes(b, "matrix", "slice", matrices, dims, "AxisWeights"), b, "slice", dims)


def _shrunk(piece: StepPiece, b: SourceStep, slot: str, dims: Counts) -> StepPiece:
    """Drop the axes of one sample, which cedar does not count as dimensions."""
    remaining = tuple(n for n in dims if n > 1)
    if remaining == dims:
        return piece
    inside = b.named("with all axes")
    first = piece.elements[0]
    piece.elements[0] = dc.replace(first, name=inside)
    piece.inner = [tuple(inside if n == b.label else n for n in wire) for wire in piece.inner]
    piece.inlets = {
        key: [[InputSlot(inside if i.name == b.label else i.name, i.port) for i in slots] for slots in listed]
        for key, listed in piece.inlets.items()
    }
    axes = [a for a, n in zip(b.axes(dims), dims, strict=True) if n > 1]
    target_axes = b.axes(remaining)
    names = {a.name: c.name for a, c in zip(axes, target_axes, strict=True) if a.name != c.name}
    piece.elements.insert(0, Project(target_axes, "sum", names, name=b.label))
    piece.inner.append((inside, b.label))
    piece.outlets = {slot: OutputSlot(b.label, remaining)}
    return piece


def pad(b: SourceStep) -> StepPiece:
    """Translate MatrixPadding: more samples at both ends of each axis."""
    counts = b.first("input")
    border = b.values.numbers("border size", 0.0, len(counts), 0.0, 5000.0)
    mode = b.values.word("padding mode", "PadByBorder", ("PadByBorder", "PadToSize"))
    kind = b.values.word("border type", "Zero", ("Zero", "Cyclic", "Replicate", "Reflect"))
    pads: list[tuple[int, int]] = []
    for n, amount in zip(counts, border, strict=True):
        if mode == "PadByBorder":
            pads.append((int(amount), int(amount)))
        else:
            margin = max(int(amount) - n, 0)
            pads.append((margin // 2, margin - margin // 2))
    ways = {"Zero": "constant", "Cyclic": "wrap", "Replicate": "edge", "Reflect": "symmetric"}
    matrices = [
        np.pad(np.eye(n), (p, (0, 0)), mode=ways[kind]) if any(p) else None  # pyright: ignore
        for n, p in zip(counts, pads, strict=True)
    ]
    dims = tuple(n + sum(p) for n, p in zip(counts, pads, strict=True))
    return along_axes(b, "input", "padded", matrices, dims, "AxisWeights")


def concatenate(b: SourceStep) -> StepPiece:
    """Translate ConcatVertically: rows above rows."""
    above, below = b.first("input above"), b.first("input below")
    if above[1:] != below[1:] or not above or not below:
        raise Refused(f"the sizes {list(above)} and {list(below)} do not fit above each other")
    dims = (above[0] + below[0], *above[1:])
    axis = b.axes(dims)[0]
    names = b.named("above"), b.named("below")
    eye = np.eye(dims[0])
    elements: list[Element] = [
        Sum(name=b.label),
        AxisWeights(eye[:, : above[0]], axis, b.axes(above)[0].name, name=names[0]),
        AxisWeights(eye[:, above[0] :], axis, b.axes(below)[0].name, name=names[1]),
    ]
    return StepPiece(
        elements,
        {"input above": [[InputSlot(names[0])]], "input below": [[InputSlot(names[1])]]},
        {"output": OutputSlot(b.label, dims)},
        [(names[0], b.label), (names[1], b.label)],
        needs=("input above", "input below"),
        why="AxisWeights, and Sum",
    )


def stack(b: SourceStep) -> StepPiece:
    """Translate Stack: matrices become the layers of a volume."""
    count = b.values.whole("dimensionality", 1, 1, MOST_SCALARS)
    slots = [str(k) for k in range(count)]
    layers = {s: b.first(s) for s in slots if s in b.ins}
    if not layers:
        raise Refused("nothing is connected to it")
    flat = next(iter(layers.values()))
    if any(dims != flat for dims in layers.values()) or len(flat) != 2:
        raise Refused(
            f"it stacks matrices of one size, not {', '.join(str(list(d)) for d in layers.values())}"
        )
    return layered(b, [s if s in layers else "" for s in slots], "stack", flat)


def layered(b: SourceStep, slots: Sequence[str], out: str, flat: Counts) -> StepPiece:
    """Return matrices as the layers of a volume, one for each slot; a layer without a slot is 0."""
    count = len(slots)
    axes, flat_axis = b.axes((*flat, count)), Axis("layer", 0, 1, 1, periodic=True)
    piece = StepPiece(
        [Sum(name=b.label)],
        outlets={out: OutputSlot(b.label, (*flat, count))},
        needs=tuple(filter(None, slots)),
        why="AxisWeights, and Sum",
    )
    for k, slot in enumerate(slots):
        if slot:
            layer, placed = b.named(f"layer {k}"), b.named(f"at {k}")
            piece.elements += [
                Project([*axes[:2], flat_axis], "sum", name=layer),
                AxisWeights(np.eye(count)[:, k : k + 1], axes[2], "layer", name=placed),
            ]
            piece.inner += [(layer, placed), (placed, b.label)]
            piece.inlets[slot] = [[InputSlot(layer)]]
    return piece


def clamp(b: SourceStep) -> StepPiece:
    """Translate Clamp: what lies beyond a limit becomes the limit, or another value."""
    dims, values = b.first("input"), b.values
    limits: dict[str, float] = {}
    others: dict[str, float] = {}
    for name, default in (("lower", 0.0), ("upper", 1.0)):
        limit, replacement = (
            values.number(f"{name} limit", default),
            values.number(f"{name} replacement", default),
        )
        replaces = values.flag(f"replace {name} limit", False)
        if not values.flag(f"apply {name} limit", True):
            continue
        limits[name] = limit
        if replaces:
            others[name] = replacement
    if others and len(limits) == 2 and limits["lower"] > limits["upper"]:
        raise Unfit("which of its limits comes first is not documented, and the lower one is above the upper")
    c = Composition(b)
    seen = c.slot("input")
    limited, clamped = seen, [name for name in limits if name not in others]
    for name in clamped:
        limit = c.constant(f"{name} limit", limits[name])
        role = "" if name == clamped[-1] and not others else f"not beyond the {name} limit"
        limited = c.limit(role, "upper" if name == "lower" else "lower", limited, limit)
    if not others:
        c.outlet("thresholded input", limited if clamped else c.total("", limited), dims)
        return c.done("Envelope with a Boost for each limit" if clamped else "Sum, a copy")
    outside = {
        name: (c.below if name == "lower" else c.above)(f"beyond the {name} limit", limits[name], seen)
        for name in others
    }
    # what is replaced is multiplied by 0, so that the sum holds the other value itself
    inside = c.rest("inside", c.total("outside", *outside.values()))
    parts = [c.gain(f"{name} part", others[name], signal) for name, signal in outside.items()]
    c.outlet("thresholded input", c.total("", c.product("kept", limited, inside), *parts), dims)
    return c.done("a sum of what is kept and of what replaces the rest")


def masked(b: SourceStep) -> StepPiece:
    """Translate Mask: the input where the mask is not 0."""
    dims, mask = b.first("input"), b.first("mask")
    if dims != mask:
        raise Refused(f"the sizes {list(dims)} and {list(mask)} differ")
    size, is_on = Pointwise("abs", name=b.named("size")), Sigmoid(Step(0.0), name=b.named("not zero"))
    return StepPiece(
        [Product(name=b.label), is_on, size],
        {"input": [[InputSlot(b.label)]], "mask": [[InputSlot(size.name)]]},
        {"masked": OutputSlot(b.label, dims)},
        [(size.name, is_on.name), (is_on.name, b.label, "factor")],
        needs=("input", "mask"),
        why="Product with a Sigmoid of the mask",
    )


def variable_box(b: SourceStep) -> StepPiece:
    """Translate VariableBox: a box whose left end, or middle, is the input; along each axis a product of two
    steps.
    """
    dims = sizes(b.values, 50, 4)
    widths = b.values.numbers("widths", 10.0, len(dims), 0.0)
    amplitude, level = b.values.number("amplitude", 1.0), b.values.number("reference level", 0.0)
    middle = b.values.flag("center at input", False)
    if b.values.flag("no peak if NaN", False):
        b.values.say("no peak if NaN", "carried", "no value is undefined here")
    axes = b.axes(dims)
    if not dims:
        raise Unfit("it has no dimension")
    height, base = Gain(amplitude - level, name=b.named("height")), Boost(b.named("level"), axes, level)
    piece = StepPiece(
        [Sum(name=b.label), height, base],
        {"left bounds": [[]]},
        {"box": OutputSlot(b.label, dims)},
        [(height.name, b.label), (base.name, b.label)],
        wanted={"left bounds": () if len(dims) == 1 else (len(dims),)},
        needs=("left bounds",),
        why="a product of Sigmoid with Step along each axis",
    )
    last = ""
    for d, (axis, width) in enumerate(zip(axes, widths, strict=True)):
        places, shift = (
            Pattern(b.named(f"{axis.name} places"), [axis], axis.points),
            width / 2 if middle else 0.0,
        )
        inside = Sum(name=b.named(f"{axis.name} inside"))
        # a sample at the left end itself is inside, one at the right end is not
        begun = Sigmoid(Step(-shift - EDGE), name=b.named(f"{axis.name} begun"))
        ended = Sigmoid(Step(width - shift - EDGE), name=b.named(f"{axis.name} ended"))
        minus, box = Gain(-1.0, name=b.named(f"{axis.name} without")), Sum(name=b.named(f"{axis.name} box"))
        shift_back = Gain(-1.0, name=b.named(f"{axis.name} left"))
        entry = Weights(-np.eye(len(dims))[d], (), name=shift_back.name) if len(dims) > 1 else shift_back
        piece.elements += [places, inside, begun, ended, minus, box, entry]
        piece.inlets["left bounds"][0].append(InputSlot(entry.name))
        piece.inner += [
            (places.name, inside.name),
            (entry.name, inside.name),
            (inside.name, begun.name),
            (inside.name, ended.name),
            (ended.name, minus.name),
            (begun.name, box.name),
            (minus.name, box.name),
        ]
        wide = Project(axes, "sum", name=b.named(f"{axis.name} everywhere"))
        piece.elements.append(wide)
        piece.inner.append((box.name, wide.name))
        if last:
            product = Product(name=b.named(f"up to {axis.name}"))
            piece.elements.append(product)
            piece.inner += [(last, product.name), (wide.name, product.name, "factor")]
            last = product.name
        else:
            last = wide.name
    piece.inner.append((last, height.name))
    return piece


def variable_gauss(b: SourceStep) -> StepPiece:
    """Translate VariableGauss: a Gaussian whose centre is the input."""
    dims = sizes(b.values, 50, 4)
    if b.values.flag("no peak if NaN", False):
        b.values.say("no peak if NaN", "carried", "no value is undefined here")
    element = SpaceCode(
        b.axes(dims),
        b.values.numbers("sigma", 3.0, len(dims), 1e-6),
        b.values.number("amplitude", 1.0),
        boundary=None if not any(a.periodic for a in b.axes(dims)) else ["zero"] * len(dims),
        name=b.label,
    )
    piece = one_to_one(element, "centers", "box", dims)
    piece.wanted = {"centers": () if len(dims) == 1 else (len(dims),)}
    return piece


def to_vector(b: SourceStep) -> StepPiece:
    """Translate ScalarsToVector."""
    count = b.values.whole("number of vector entries", 1, 1, MOST_SCALARS)
    dims = () if count == 1 else (count,)
    piece = StepPiece(
        [Sum(name=b.label)],
        {},
        {"vector": OutputSlot(b.label, dims)},
        why="Sum of Weights to one sample each",
    )
    for k in range(count):
        slot = f"scalar {k}"
        if b.first(slot):
            raise Refused(f"the input at {slot!r} is not one number")
        name = b.named(f"entry {k}")
        piece.elements.append(Weights(np.eye(count)[k].reshape(dims), b.axes(dims), name=name))
        piece.inner.append((name, b.label))
        piece.inlets[slot] = [[InputSlot(name)]]
    return piece


def to_scalars(b: SourceStep) -> StepPiece:
    """Translate VectorToScalars: one number for each entry."""
    dims = b.first("input vector")
    count = b.values.whole("number of vector entries", 3, 1, MOST_SCALARS)
    if math.prod(dims) != count or len(dims) > 1:
        raise Refused(f"its input has the size {list(dims)}, and it has {count} entries")
    eye = np.eye(count)
    names = [b.label if k == 0 else b.named(f"entry {k}") for k in range(count)]
    return StepPiece(
        [*(Weights(eye[k].reshape(dims), (), name=name) for k, name in enumerate(names))],
        {"input vector": [[InputSlot(name) for name in names]]},
        {f"scalar {k}": OutputSlot(name, ()) for k, name in enumerate(names)},
        needs=("input vector",),
        why="Weights for each entry",
    )


CLASSES = {
    "cedar.processing.Resize": resize,
    "cedar.processing.Flip": flip,
    "cedar.processing.MatrixSlice": cut,
    "cedar.processing.MatrixPadding": pad,
    "cedar.processing.steps.ConcatVertically": concatenate,
    "cedar.processing.steps.Stack": stack,
    "cedar.processing.steps.Clamp": clamp,
    "cedar.processing.Mask": masked,
    "cedar.processing.steps.VariableGauss": variable_gauss,
    "cedar.processing.steps.VariableBox": variable_box,
    "cedar.processing.ScalarsToVector": to_vector,
    "cedar.processing.VectorToScalars": to_scalars,
}
