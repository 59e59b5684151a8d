"""Changes of dimension: sums over dimensions, expansions, transposition, shifts, diagonals."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar.couplings.convolve import Convolve
from deodar.couplings.diagonal_expansion import DiagonalExpansion
from deodar.couplings.diagonal_sum import DiagonalSum
from deodar.couplings.gain import Gain
from deodar.couplings.sum import Sum
from deodar.element import Element
from deodar.elements.pattern import Pattern
from deodar.numerics.axes import Axis, shape
from deodar.numerics.kernels.gaussian import NARROWEST
from deodar.numerics.kernels.shifted import Shifted
from deodar.numerics.kernels.truncated_gaussian import TruncatedGaussian
from deodar_interop.importers._piece import Dims, Inlet, Outlet, Piece, Unfit, axes, projection
from deodar_interop.importers.cosivina.classes.kernels import sums
from deodar_interop.importers.cosivina.classes.stimuli import boundary
from deodar_interop.importers.cosivina.element import SourceElement


def transpose(b: SourceElement) -> Piece:
    """Translate Transpose: its size is that of the output."""
    b.values.size()
    dims = b.dims()
    if len(dims) != 2:
        raise Unfit("only two dimensions can be transposed")
    came = b.of((_count(dims[1]), _count(dims[0])))
    places = [a for a, old in zip(reversed(dims), came, strict=True) if old is not None]
    return _projected(b, came, dims, places)


def sum_dimension(b: SourceElement) -> Piece:
    """Translate SumDimension: a projection that sums, then a gain."""
    b.values.size()
    dims = b.dims()
    listed = b.values.matrix("sumDimensions")
    summed = {int(v) - 1 for v in listed.reshape(-1)} if listed is not None else {0}
    came = b.source(0) or dims
    remaining = [a for d, a in enumerate(came) if a is not None and d not in summed]
    target_axes = axes(dims)
    order = b.values.matrix("dimensionOrder")
    if (
        order is not None
        and len(target_axes) > 1
        and sorted(int(v) for v in order.reshape(-1)) == list(range(1, len(remaining) + 1))
    ):
        remaining = [remaining[int(v) - 1] for v in order.reshape(-1)]
    if shape(remaining) != shape(target_axes):
        raise Unfit(
            f"what is left of its input has {list(shape(remaining))} samples,"
            f" its output {list(shape(target_axes))}"
        )
    becomes = dict(zip(remaining, target_axes, strict=True))
    name = b.named("sum")
    project = projection(name, axes(came), dims, [becomes.get(a) for a in axes(came)])
    gain = Gain(b.values.number("amplitude", 1), name=b.label)
    return Piece(
        [gain, project],
        [[Inlet(name, came, whole=True)]],
        {"output": Outlet(b.label, dims)},
        [(name, b.label)],
        needs=1,
        why="Project and Gain",
    )


def sum_all(b: SourceElement) -> Piece:
    """Translate SumAllDimensions: one projection for each sum that has a reader."""
    elements, inlets, outlets = sums(b)
    first = {"fullSum": outlets["fullSum"]}
    return Piece(list(reversed(elements)), [inlets], first | outlets, needs=1, why="Project")


def expand_2d(b: SourceElement) -> Piece:
    """Translate ExpandDimension2D: a row or column of any orientation, along one dimension of a plane."""
    b.values.size()
    dims = b.dims()
    along = int(b.values.number("expandDimension", 1, 1, 2)) - 1
    along_axis = dims[1 - along]
    came = b.source(0) or tuple(along_axis if d == 1 - along else None for d in range(2))
    return _expand(b, came, dims, [along_axis] if along_axis is not None else [])


def expand(b: SourceElement) -> Piece:
    """Translate ExpandDimension: the mapping assigns each dimension of the input; the others are filled with
    copies.
    """
    input_size, out = b.values.size("inputSize"), b.values.size("outputSize")
    came, dims = b.of(input_size), b.of(out)
    mapping = [
        int(v) - 1
        for v in b.values.numbers("dimensionMapping", list(range(1, len(input_size) + 1)), len(input_size))
    ]
    if any(not 0 <= m < len(dims) for m in mapping):
        raise Unfit("its dimensionMapping leads out of its outputSize")
    return _expand(
        b,
        came,
        dims,
        [a for m, old in zip(mapping, came, strict=True) if old is not None and (a := dims[m]) is not None],
    )


def diagonal_sum(b: SourceElement) -> Piece:
    """Translate DiagonalSum: a sum along diagonals, then a gain."""
    side = b.values.size("inputSize")[-1]
    came, dims = b.of((side, side)), b.dims()
    amplitude = b.values.number("amplitude", 0)
    if None in came:
        return _gain(b, amplitude, came, dims)
    name = b.named("sum")
    elements: list[Element] = [Gain(amplitude, name=b.label), DiagonalSum(axes(dims), name=name)]
    inlets = [[Inlet(name, came, whole=True)]]
    return Piece(
        elements,
        inlets,
        {"output": Outlet(b.label, dims)},
        [(name, b.label)],
        needs=1,
        why="DiagonalSum and Gain",
    )


def diagonal_expansion(b: SourceElement) -> Piece:
    """Translate DiagonalExpansion. cosivina never applies its amplitude; 0, if none was given, means 1."""
    came, dims = b.of(b.values.size("inputSize")), b.dims()
    amplitude = _unused_amplitude(b)
    if None in dims:
        return _gain(b, amplitude, came, dims)
    name = b.named("scaled")
    elements: list[Element] = [DiagonalExpansion(axes(dims), name=b.label), Gain(amplitude, name=name)]
    inlets = [[Inlet(name, came, whole=True)]]
    return Piece(
        elements,
        inlets,
        {"output": Outlet(b.label, dims)},
        [(name, b.label)],
        needs=1,
        why="Gain and DiagonalExpansion",
    )


def shift_input(b: SourceElement) -> Piece:
    """Translate ShiftInput: a shifted kernel of one sample.

    cosivina never applies its amplitude; 0, if none was given, means 1.
    """
    b.values.size()
    dims = b.dims()
    target_axes = axes(dims)
    listed = b.values.matrix("shiftValue")
    # a constructor that counts wrongly puts zeros in front
    shifts = [0.0, 0.0, *(listed.reshape(-1) if listed is not None else ())][-2:]
    amounts = [float(np.round(v)) for v, a in zip(shifts, dims, strict=False) if a is not None]
    amplitude, circular = _unused_amplitude(b), b.values.flag("circular", False)
    fill = b.values.number("fillValue", 0)
    ends = boundary(dims, ["periodic" if circular else "zero"] * len(target_axes))
    kernel = Shifted(
        TruncatedGaussian(amplitude, NARROWEST, 0.0, normalized=True), amounts or 0.0, boundary=ends
    )
    if not fill or circular or not target_axes:
        return Piece(
            [Convolve([kernel], name=b.label)],
            [[Inlet(b.label, dims, whole=True)]],
            {"output": Outlet(b.label, dims, initial=fill)},
            needs=1,
            why="Convolve",
        )
    border = np.full(shape(target_axes), fill)
    border[
        tuple(
            slice(max(0, int(s)), a.samples + min(0, int(s)))
            for s, a in zip(amounts, target_axes, strict=True)
        )
    ] = 0.0
    moved, filled = b.named("moved"), b.named("border")
    elements: list[Element] = [
        Sum(name=b.label),
        Convolve([kernel], name=moved),
        Pattern(filled, target_axes, border),
    ]
    inner = [(moved, b.label), (filled, b.label)]
    return Piece(
        elements,
        [[Inlet(moved, dims, whole=True)]],
        {"output": Outlet(b.label, dims, initial=fill)},
        inner,
        needs=1,
        why="Convolve, Pattern and Sum",
    )


# ----------------------------------------------------------------------------------------------------- inside


def _count(axis: Axis | None) -> int:
    return 1 if axis is None else axis.samples


def _gain(b: SourceElement, amplitude: float, came: Dims, dims: Dims) -> Piece:
    """Return a gain alone, for a diagonal of one sample."""
    return Piece(
        [Gain(amplitude, name=b.label)],
        [[Inlet(b.label, came)]],
        {"output": Outlet(b.label, dims)},
        needs=1,
        why="Gain",
    )


def _projected(b: SourceElement, came: Dims, dims: Dims, places: Sequence[Axis | None]) -> Piece:
    """Return a projection alone; `places` are the axes of the output that the axes of the input become."""
    return Piece(
        [projection(b.label, axes(came), dims, places)],
        [[Inlet(b.label, came, whole=True)]],
        {"output": Outlet(b.label, dims)},
        needs=1,
        why="Project",
    )


def _expand(b: SourceElement, came: Dims, dims: Dims, places: Sequence[Axis]) -> Piece:
    if shape(axes(came)) != shape(places):
        raise Unfit(
            f"its input has {list(shape(axes(came)))} samples, where {list(shape(places))} are expanded"
        )
    return _projected(b, came, dims, places)


def _unused_amplitude(b: SourceElement) -> float:
    """Return an amplitude that cosivina stores and never applies."""
    amplitude = b.values.number("amplitude", 1)
    if amplitude in (0, 1):
        if amplitude == 0 and "amplitude" in b.element.values:
            b.values.say(
                "amplitude", "carried", "0 where none was given; the input is taken as it is, as in cosivina"
            )
        return 1.0
    return 1.0 if b.bug(f"{b.element.kind} does not apply its amplitude") else amplitude


CLASSES = {
    "Transpose": transpose,
    "SumDimension": sum_dimension,
    "SumAllDimensions": sum_all,
    "ExpandDimension2D": expand_2d,
    "ExpandDimension": expand,
    "DiagonalSum": diagonal_sum,
    "DiagonalExpansion": diagonal_expansion,
    "ShiftInput": shift_input,
}
