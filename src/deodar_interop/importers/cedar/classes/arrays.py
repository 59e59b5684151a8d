"""Arrays: resizing, cropping, padding, permuting, collecting and separating."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from deodar.couplings.positions import SpaceCode
from deodar.elements.stimuli import Pattern
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.convolution_kernels import CedarBorder
from deodar_interop.importers.cedar.file import items, text
from deodar_interop.importers.cedar.interpolation import WAYS, matrix
from deodar_interop.importers.cedar.piece import Refused, sizes

MOST_SCALARS = 255
EDGE = 1e-6
"""By how much an edge lies before its sample: deodar's step is 1 only above its threshold."""


def along_axes(
    s: SourceStep, seen: StepSignal, matrices: Sequence[np.ndarray | None], role: str = ""
) -> StepSignal:
    """Return the product of weights with a signal along each axis; None leaves an axis as it is."""
    changed = {d: m for d, m in enumerate(matrices) if m is not None}
    if not changed:
        s.explain("Sum, a copy")
        return s.total(role, seen)
    axes = s.axes(tuple(n if m is None else len(m) for n, m in zip(seen.dims, matrices, strict=True)))
    for d, weights in changed.items():
        seen = s.turned(role if d == max(changed) else f"along {axes[d].name}", weights, axes[d], seen, d)
    return seen


@step("cedar.processing.Resize", "input", gives="output")
def resize(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Resize: each axis of the input has another number of samples over the same extent."""
    counts = seen.dims
    if not counts:
        raise Refused("its input is one number")
    dims = [int(n) for n in s.values.numbers("output size", 50, len(counts), 1, 5000)]
    interpolation = s.values.word("interpolation", "LINEAR", WAYS)
    if len(counts) > 2:
        if interpolation != "LINEAR":
            s.values.say("interpolation", "carried", "cedar resizes three dimensions linearly only")
        interpolation = "LINEAR"
        s.bug("resizing three dimensions mixes up the weights of neighbours")
    if interpolation == "LANCZOS4":
        s.values.say("interpolation", "approximated", "CUBIC is used")
    matrices = [None if n == m else matrix(n, m, interpolation) for n, m in zip(counts, dims, strict=True)]
    return along_axes(s, seen, matrices)


@step("cedar.processing.Flip", "input", gives="output")
def flip(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Flip."""
    listed = [text(v) != "false" for v in items(s.values.body.get("flipped dimensions"))]
    s.values.say("flipped dimensions")
    flags = (listed + [True] * len(seen.dims))[: len(seen.dims)]
    matrices = [np.eye(n)[::-1] if f else None for n, f in zip(seen.dims, flags, strict=True)]
    return along_axes(s, seen, matrices)


@step("cedar.processing.MatrixSlice", "matrix", gives="slice", why="AxisWeights")
def cut(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate MatrixSlice: a part of each axis, its upper end excluded.

    Axes of one sample are dropped, because cedar does not count them as dimensions.
    """
    counts = seen.dims
    lower, upper = (
        s.values.numbers(f"range {end}", float(v), len(counts)) for end, v in (("lower", 0), ("upper", 1))
    )
    if s.values.word("anchor type", "Absolute", ("Absolute", "Center")) == "Center":
        half = [n // 2 for n in counts]
        lower = [v + h for v, h in zip(lower, half, strict=True)]
        upper = [v + h for v, h in zip(upper, half, strict=True)]
    spans = [(int(a), int(z)) for a, z in zip(lower, upper, strict=True)]
    if any(not 0 <= a < z <= n for (a, z), n in zip(spans, counts, strict=True)):
        raise Refused(f"its range {spans} is not inside an array of {list(counts)}")
    matrices = [np.eye(n)[a:z] if (a, z) != (0, n) else None for (a, z), n in zip(spans, counts, strict=True)]
    lone = any(z - a == 1 for a, z in spans)
    sliced = along_axes(s, seen, matrices, "with all axes" if lone else "")
    if not lone:
        return sliced
    axes = s.axes(tuple(n for n in sliced.dims if n > 1))
    remaining = iter(axes)
    return s.projected("", sliced, axes, [next(remaining) if n > 1 else None for n in sliced.dims])


@step("cedar.processing.MatrixPadding", "input", gives="padded")
def pad(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate MatrixPadding: more samples at both ends of each axis."""
    counts = seen.dims
    border = s.values.numbers("border size", 0.0, len(counts), 0.0, 5000.0)
    mode = s.values.word("padding mode", "PadByBorder", ("PadByBorder", "PadToSize"))
    kind = s.values.word("border type", "Zero", ("Zero", "Cyclic", "Replicate", "Reflect"))
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
    return along_axes(s, seen, matrices)


@step("cedar.processing.steps.ConcatVertically", "input above", "input below", gives="output")
def concatenate(s: SourceStep, above: StepSignal, below: StepSignal) -> StepSignal:
    """Translate ConcatVertically: rows above rows."""
    if above.dims[1:] != below.dims[1:] or not above.dims or not below.dims:
        raise Refused(f"the sizes {list(above.dims)} and {list(below.dims)} do not fit above each other")
    rows = above.dims[0]
    dims = (rows + below.dims[0], *above.dims[1:])
    axis, eye = s.axes(dims)[0], np.eye(dims[0])
    s.explain("AxisWeights, and Sum")
    upper = s.turned("above", eye[:, :rows], axis, above, 0)
    return s.total("", upper, s.turned("below", eye[:, rows:], axis, below, 0))


@step("cedar.processing.steps.Stack", gives="stack")
def stack(s: SourceStep) -> StepSignal:
    """Translate Stack: matrices become the layers of a volume."""
    count = s.values.whole("dimensionality", 1, 1, MOST_SCALARS)
    layers = [s.optional(str(k)) for k in range(count)]
    dims = [layer.dims for layer in layers if layer is not None]
    if not dims:
        raise Refused("nothing is connected to it")
    if len(set(dims)) > 1 or len(dims[0]) != 2:
        raise Refused(f"it stacks matrices of one size, not {', '.join(str(list(d)) for d in dims)}")
    return layered(s, layers)


def layered(s: SourceStep, layers: Sequence[StepSignal | None]) -> StepSignal:
    """Return matrices as the layers of a volume; a layer of None is 0."""
    count, flat = len(layers), Axis("layer", 0, 1, 1, periodic=True)
    parts: list[StepSignal] = []
    for k, signal in enumerate(layers):
        if signal is not None:
            layer = s.projected(f"layer {k}", signal, (*signal.axes, flat), signal.axes)
            through = s.axes((*signal.dims, count))[2]
            parts.append(s.turned(f"at {k}", np.eye(count)[:, k : k + 1], through, layer, 2))
    s.explain("AxisWeights, and Sum")
    return s.total("", *parts)


@step("cedar.processing.steps.Clamp", "input", gives="thresholded input")
def clamp(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Clamp: what lies beyond a limit becomes the limit, or another value."""
    values = s.values
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
    limited, clamped = seen, [name for name in limits if name not in others]
    for name in clamped:
        limit = s.constant(f"{name} limit", limits[name])
        role = "" if name == clamped[-1] and not others else f"not beyond the {name} limit"
        limited = s.limit(role, "upper" if name == "lower" else "lower", limited, limit)
    if not others:
        s.explain("Envelope with a Boost for each limit")
        return limited if clamped else s.copy(seen)
    outside = {
        name: (s.below if name == "lower" else s.above)(f"beyond the {name} limit", limits[name], seen)
        for name in others
    }
    # what is replaced is multiplied by 0, so that the sum holds the other value itself
    inside = s.rest("inside", s.total("outside", *outside.values()))
    parts = [s.gain(f"{name} part", others[name], signal) for name, signal in outside.items()]
    s.explain("a sum of what is kept and of what replaces the rest")
    return s.total("", s.product("kept", limited, inside), *parts)


@step("cedar.processing.Mask", "input", "mask", gives="masked", why="Product with a Sigmoid of the mask")
def masked(s: SourceStep, seen: StepSignal, mask: StepSignal) -> StepSignal:
    """Translate Mask: the input where the mask is not 0."""
    s.require_equal(seen, mask)
    return s.product("", seen, s.above("not zero", 0.0, s.function("size", "abs", mask)))


@step("cedar.processing.steps.VariableBox", gives="box")
def variable_box(s: SourceStep) -> StepSignal:
    """Translate VariableBox: a box whose left end, or middle, is the input; along each axis a product of two
    steps.
    """
    dims = sizes(s.values, 50, 4)
    widths = s.values.numbers("widths", 10.0, len(dims), 0.0)
    amplitude, level = s.values.number("amplitude", 1.0), s.values.number("reference level", 0.0)
    middle = s.values.flag("center at input", False)
    _say_undefined(s)
    axes = s.axes(dims)
    if not dims:
        raise Unfit("it has no dimension")
    bounds = s.slot("left bounds", () if len(dims) == 1 else (len(dims),))
    boxes: list[StepSignal] = []
    for d, (axis, width) in enumerate(zip(axes, widths, strict=True)):
        shift, role = width / 2 if middle else 0.0, f"{axis.name} left"
        negated = (
            s.weighted(role, -np.eye(len(dims))[d], (), bounds)
            if len(dims) > 1
            else s.gain(role, -1.0, bounds)
        )
        places = s.add(Pattern(s.named(f"{axis.name} places"), [axis], axis.points))
        inside = s.total(f"{axis.name} inside", places, negated)
        # a sample at the left end itself is inside, one at the right end is not
        begun = s.above(f"{axis.name} begun", -shift - EDGE, inside)
        ended = s.above(f"{axis.name} ended", width - shift - EDGE, inside)
        box = s.total(f"{axis.name} box", begun, s.gain(f"{axis.name} without", -1.0, ended))
        boxes.append(s.projected(f"{axis.name} everywhere", box, axes, [axis]))
    whole = boxes[0]
    for axis, box in zip(axes[1:], boxes[1:], strict=True):
        whole = s.product(f"up to {axis.name}", whole, box)
    s.explain("a product of Sigmoid with Step along each axis")
    return s.total("", s.gain("height", amplitude - level, whole), s.constant("level", level, axes))


@step("cedar.processing.steps.VariableGauss", gives="box")
def variable_gauss(s: SourceStep) -> StepSignal:
    """Translate VariableGauss: a Gaussian whose centre is the input."""
    dims = sizes(s.values, 50, 4)
    _say_undefined(s)
    axes = s.axes(dims)
    sigmas = s.values.numbers("sigma", 3.0, len(dims), 1e-6)
    amplitude, ends = s.values.number("amplitude", 1.0), CedarBorder().ends(axes)
    code = SpaceCode(axes, sigmas, amplitude, boundary=ends, name=s.label)
    return s.add(code, axes, input=s.slot("centers", () if len(dims) == 1 else (len(dims),)))


def _say_undefined(s: SourceStep) -> None:
    if s.values.flag("no peak if NaN", False):
        s.values.say("no peak if NaN", "carried", "no value is undefined here")


@step("cedar.processing.ScalarsToVector", gives="vector", why="Sum of Weights to one sample each")
def to_vector(s: SourceStep) -> StepSignal:
    """Translate ScalarsToVector."""
    count = s.values.whole("number of vector entries", 1, 1, MOST_SCALARS)
    dims, parts = () if count == 1 else (count,), list[StepSignal]()
    for k in range(count):
        signal = s.arriving(f"scalar {k}")
        if signal.dims:
            raise Refused(f"the input at {signal.name!r} is not one number")
        parts.append(s.weighted(f"entry {k}", np.eye(count)[k].reshape(dims), s.axes(dims), signal))
    return s.total("", *parts)


@step("cedar.processing.VectorToScalars", "input vector", why="Weights for each entry")
def to_scalars(s: SourceStep, vector: StepSignal) -> None:
    """Translate VectorToScalars: one number for each entry."""
    dims, count = vector.dims, s.values.whole("number of vector entries", 3, 1, MOST_SCALARS)
    if math.prod(dims) != count or len(dims) > 1:
        raise Refused(f"its input has the size {list(dims)}, and it has {count} entries")
    for k, chosen in enumerate(np.eye(count)):
        role = f"entry {k}" if k else ""
        s.outlet(f"scalar {k}", s.weighted(role, chosen.reshape(dims), (), vector))
