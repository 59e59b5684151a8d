"""Changes of dimension: sums over dimensions, expansions, transposition, shifts, diagonals."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar.couplings.arithmetic import Gain, Sum
from deodar.couplings.convolutions import Convolve
from deodar.couplings.projections import DiagonalExpansion, DiagonalSum
from deodar.elements.stimuli import Pattern
from deodar.numerics.axes import Axis, shape
from deodar.numerics.kernels.separable import NARROWEST, Shifted, TruncatedGaussian
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Dims, Unfit, axes
from deodar_interop.importers.cosivina.classes.kernels import add_sums
from deodar_interop.importers.cosivina.classes.stimuli import boundary
from deodar_interop.importers.cosivina.element import SourceElement


@translates("Transpose")
def transpose(b: SourceElement) -> ElementSignal:
    """Translate Transpose: its size is that of the output."""
    dims = b.sized()
    if len(dims) != 2:
        raise Unfit("only two dimensions can be transposed")
    came = b.of((_count(dims[1]), _count(dims[0])))
    places = [a for a, old in zip(reversed(dims), came, strict=True) if old is not None]
    return b.projected("", b.input(came), dims, places)


@translates("SumDimension")
def sum_dimension(b: SourceElement) -> ElementSignal:
    """Translate SumDimension: a projection that sums, then a gain."""
    dims = b.sized()
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
    b.explain("Project and Gain")
    summed_input = b.projected("sum", b.input(came), dims, [becomes.get(a) for a in axes(came)])
    return b.add(Gain(b.values.number("amplitude", 1), name=b.label), input=summed_input)


@translates("SumAllDimensions")
def sum_all(b: SourceElement) -> None:
    """Translate SumAllDimensions: one projection for each sum that has a reader."""
    seen = b.input(b.of(b.values.size()))
    add_sums(b, seen, ("fullSum", "horizontalSum", "verticalSum"))


@translates("ExpandDimension2D")
def expand_2d(b: SourceElement) -> ElementSignal:
    """Translate ExpandDimension2D: a row or column of any orientation, along one dimension of a plane."""
    dims = b.sized()
    along = int(b.values.number("expandDimension", 1, 1, 2)) - 1
    along_axis = dims[1 - along]
    came = b.source(0) or tuple(along_axis if d == 1 - along else None for d in range(2))
    return _expand(b, came, dims, [along_axis] if along_axis is not None else [])


@translates("ExpandDimension")
def expand(b: SourceElement) -> ElementSignal:
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


@translates("DiagonalSum")
def diagonal_sum(b: SourceElement) -> ElementSignal:
    """Translate DiagonalSum: a sum along diagonals, then a gain."""
    side = b.values.size("inputSize")[-1]
    came, dims = b.of((side, side)), b.dims()
    gain = Gain(b.values.number("amplitude", 0), name=b.label)
    if None in came:  # a diagonal of one sample
        return b.add(gain, dims, input=b.input(came, whole=False))
    b.explain("DiagonalSum and Gain")
    diagonals = DiagonalSum(axes(dims), name=b.named("sum"))
    return b.add(gain, input=b.add(diagonals, dims, input=b.input(came)))


@translates("DiagonalExpansion")
def diagonal_expansion(b: SourceElement) -> ElementSignal:
    """Translate DiagonalExpansion. cosivina never applies its amplitude; 0, if none was given, means 1."""
    came, dims = b.of(b.values.size("inputSize")), b.dims()
    amplitude = _unused_amplitude(b)
    if None in dims:  # a diagonal of one sample
        return b.add(Gain(amplitude, name=b.label), dims, input=b.input(came, whole=False))
    b.explain("Gain and DiagonalExpansion")
    scaled = b.add(Gain(amplitude, name=b.named("scaled")), input=b.input(came))
    return b.add(DiagonalExpansion(axes(dims), name=b.label), dims, input=scaled)


@translates("ShiftInput")
def shift_input(b: SourceElement) -> None:
    """Translate ShiftInput: a shifted kernel of one sample.

    cosivina never applies its amplitude; 0, if none was given, means 1.
    """
    dims = b.sized()
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
    border_is_filled = bool(fill and not circular and target_axes)
    moved = Convolve([kernel], name=b.named("moved" if border_is_filled else ""))
    shifted = b.add(moved, input=b.input(dims))
    if not border_is_filled:
        b.outlet("output", shifted, initial=fill)
        return
    border = np.full(shape(target_axes), fill)
    border[
        tuple(
            slice(max(0, int(s)), a.samples + min(0, int(s)))
            for s, a in zip(amounts, target_axes, strict=True)
        )
    ] = 0.0
    filled = b.add(Pattern(b.named("border"), target_axes, border), dims)
    b.outlet("output", b.add(Sum(name=b.label), input=(shifted, filled)), initial=fill)
    b.explain("Convolve, Pattern and Sum")


# ----------------------------------------------------------------------------------------------------- inside


def _count(axis: Axis | None) -> int:
    return 1 if axis is None else axis.samples


def _expand(b: SourceElement, came: Dims, dims: Dims, places: Sequence[Axis]) -> ElementSignal:
    if shape(axes(came)) != shape(places):
        raise Unfit(
            f"its input has {list(shape(axes(came)))} samples, where {list(shape(places))} are expanded"
        )
    return b.projected("", b.input(came), dims, places)


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
