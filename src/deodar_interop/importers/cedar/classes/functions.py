"""Algebra beyond sums and products: functions of each sample, quotients, norms, products of vectors."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.envelope import Envelope
from deodar.couplings.gain import Gain
from deodar.couplings.pointwise import Pointwise
from deodar.couplings.product import Product
from deodar.couplings.project import Project
from deodar.couplings.pseudo_inverse import PseudoInverse
from deodar.couplings.quotient import Quotient
from deodar.couplings.sum import Sum
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.algebra import chain, one_to_one
from deodar_interop.importers.cedar.composition import Composition
from deodar_interop.importers.cedar.file import items, text
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, Refused, SourceStep, StepPiece

MOST_PRODUCTS = 4_000_000
"""Most products of samples in a product of matrices (a guess)."""

TINY = 1e-30


def absolute(b: SourceStep) -> StepPiece:
    """Translate AbsoluteValue."""
    return one_to_one(Pointwise("abs", name=b.label), "input", "absolute value", b.first("input"))


def logarithm(b: SourceStep) -> StepPiece:
    """Translate Logarithm: ln x / ln base; the base may be an input."""
    if "base (optional)" in b.ins:
        dims, c = b.first("input"), Composition(b)
        of_input = c.function("ln", "log", c.slot("input"))
        base = c.slot("base (optional)", ())
        whole = c.quotient("ln by ln", of_input, c.function("ln of the base", "log", base), TINY)
        # the logarithm of 0 is infinite in cedar, and what is divided by it 0
        c.outlet("result", c.product("", whole, c.above("a base", 0.0, base)), dims)
        return c.done("Quotient of two Pointwise")
    base = b.values.number("base", math.e, TINY)
    if base == 1:
        raise Refused("its base is 1")
    return _scaled(b, Pointwise("log", name=b.named("ln")), 1 / math.log(base), "result")


def _scaled(b: SourceStep, inside: Element, factor: float, out: str) -> StepPiece:
    """Return a function with a factor; the Gain has the step's name."""
    piece = one_to_one(inside, "input", out, b.first("input"))
    piece.elements.insert(0, Gain(factor, name=b.label))
    piece.inner.append((inside.name, b.label))
    piece.outlets = {out: OutputSlot(b.label, b.first("input"))}
    piece.why = f"{type(inside).__name__} and Gain"
    return piece


def sinus(b: SourceStep) -> StepPiece:
    """Translate Sinus: A sin(x + shift)."""
    amplitude, shift = b.values.number("amplitude", 1.0), b.values.number("phase shift", 0.0)
    function = "cos" if b.values.flag("make cos", False) else "sin"
    piece = _scaled(b, Pointwise(function, name=b.named(function)), amplitude, "result")
    return _shifted(b, piece, "phase shift (optional)", shift)


def linear(b: SourceStep) -> StepPiece:
    """Translate LinearFunction: slope (x + shift)."""
    slope, shift = b.values.number("slope", 1.0), b.values.number("horizontal shift", 0.0)
    piece = one_to_one(Gain(slope, name=b.label), "input", "result", b.first("input"))
    return _shifted(b, piece, "horizontal shift (optional)", shift)


def _shifted(b: SourceStep, piece: StepPiece, slot: str, shift: float) -> StepPiece:
    """Add a shift to the input: that of a slot if something is connected there, else a constant."""
    target = piece.inlets["input"][0][0].name
    if slot in b.ins:
        piece.inlets[slot] = [[InputSlot(target)]]
    elif shift:
        constant = Boost(b.named("shift"), (), shift)
        piece.elements.append(constant)
        piece.inner.append((constant.name, target))
    return piece


def divide(b: SourceStep) -> StepPiece:
    """Translate DivideElementwise; a divisor of 0 gives a very large number."""
    first, second = b.first("dividend"), b.first("divisor")
    if first != second:
        raise Refused(f"the sizes {list(first)} and {list(second)} differ")
    return _quotient(b, TINY, ("dividend", "divisor", "result"), first)


def divide_by_scalar(b: SourceStep) -> StepPiece:
    """Translate ScalarDivision; a divisor near 0 is replaced."""
    dims = b.first("matrix")
    if b.first("divisor"):
        raise Refused("its divisor is not one number")
    least = b.values.number("zero divisor replacement", 1e-6, TINY)
    if not b.values.flag("treat division by zero", True):
        least = TINY
    return _quotient(b, least, ("matrix", "divisor", "result"), dims)


def _quotient(b: SourceStep, least: float, slots: tuple[str, str, str], dims: Counts) -> StepPiece:
    over, under, out = slots
    return StepPiece(
        [Quotient(least, name=b.label)],
        {over: [[InputSlot(b.label)]], under: [[InputSlot(b.label, "divisor")]]},
        {out: OutputSlot(b.label, dims)},
        needs=(over, under),
        why="Quotient",
    )


def maximum(b: SourceStep) -> StepPiece:
    """Translate Maximum."""
    return chain(b, "terms", "maximum", lambda name: Envelope("upper", name=name), "other", "of {1}")


def minimum(b: SourceStep) -> StepPiece:
    """Translate Minimum."""
    return chain(b, "terms", "minimum", lambda name: Envelope("lower", name=name), "other", "of {1}")


def norm(b: SourceStep) -> StepPiece:
    """Translate Norm: the root of the sum of squares."""
    piece = StepPiece([], {"input": []}, needs=("input",), why="Pointwise and Project")
    b.first("input")
    _norm(b, piece, "L2Norm", b.label)
    piece.outlets = {"output": OutputSlot(b.label, ())}
    return piece


def _norm(b: SourceStep, piece: StepPiece, kind: str, name: str) -> None:
    """Add a norm of the input to a translation."""
    inside, whole = b.named("of each sample"), b.named("whole")
    if kind == "L2Norm":
        piece.elements += [Pointwise("root", name=name), Project([], "sum", name=whole)]
        piece.elements.append(Pointwise("square", name=inside))
        piece.inner += [(inside, whole), (whole, name)]
    else:
        piece.elements += [
            Project([], "sum" if kind == "L1Norm" else "max", name=name),
            Pointwise("abs", name=inside),
        ]
        piece.inner.append((inside, name))
    if not piece.inlets["input"]:
        piece.inlets["input"].append([])
    piece.inlets["input"][0] = [*piece.inlets["input"][0], InputSlot(inside)]


def normalization(b: SourceStep) -> StepPiece:
    """Translate Normalization: the input divided by its norm."""
    dims = b.first("input")
    kind = b.values.word("normalization type", "L2Norm", ("None", "InfinityNorm", "L1Norm", "L2Norm"))
    listed = [text(v) == "true" for v in items(b.values.body.get("normalized dimensions"))]
    if any(listed) and not all(listed):
        raise Unfit("it normalizes along some of its dimensions")
    b.values.say("normalized dimensions")
    if kind == "None":
        return one_to_one(Sum(name=b.label), "input", "normalized input", dims, why="Sum, a copy")
    piece = _quotient(b, TINY, ("input", "norm", "normalized input"), dims)
    del piece.inlets["norm"]
    piece.needs, piece.why = ("input",), "Quotient by a norm"
    size = b.named("norm")
    _norm(b, piece, kind, size)
    piece.inner.append((size, b.label, "divisor"))
    return piece


def remove_mean(b: SourceStep) -> StepPiece:
    """Translate RemoveMean."""
    dims = b.first("matrix")
    mean, minus = b.named("mean"), b.named("minus")
    return StepPiece(
        [Sum(name=b.label), Project([], "mean", name=mean), Gain(-1.0, name=minus)],
        {"matrix": [[InputSlot(b.label), InputSlot(mean)]]},
        {"mean-free matrix": OutputSlot(b.label, dims)},
        [(mean, minus), (minus, b.label)],
        needs=("matrix",),
        why="Sum with minus the mean",
    )


def inner_product(b: SourceStep) -> StepPiece:
    """Translate InnerProduct."""
    first, second = b.first("input"), b.first("input 2")
    if first != second:
        raise Refused(f"the sizes {list(first)} and {list(second)} differ")
    product = b.named("products")
    return StepPiece(
        [Project([], "sum", name=b.label), Product(name=product)],
        {"input": [[InputSlot(product)]], "input 2": [[InputSlot(product, "factor")]]},
        {"output": OutputSlot(b.label, ())},
        [(product, b.label)],
        needs=("input", "input 2"),
        why="Product and Project",
    )


def outer_product(b: SourceStep) -> StepPiece:
    """Translate OuterProduct: a column times a row."""
    first, second = b.first("input"), b.first("input 2")
    if len(first) != 1 or len(second) != 1:
        raise Refused(f"its inputs are not vectors: {list(first)} and {list(second)}")
    dims = (first[0], second[0])
    rows, columns = b.axes(dims)
    names = b.named("column"), b.named("row")
    elements: list[Element] = [
        Product(name=b.label),
        _spread((rows, columns), b.axes(first)[0], rows, names[0]),
        _spread((rows, columns), b.axes(second)[0], columns, names[1]),
    ]
    return StepPiece(
        elements,
        {"input": [[InputSlot(names[0])]], "input 2": [[InputSlot(names[1])]]},
        {"output": OutputSlot(b.label, dims)},
        [(names[0], b.label), (names[1], b.label, "factor")],
        needs=("input", "input 2"),
        why="Product of two Project",
    )


def _spread(axes: tuple[Axis, ...], source: Axis, to: Axis, name: str) -> Project:
    return Project(axes, "sum", {source.name: to.name} if source.name != to.name else {}, name=name)


def cross_product(b: SourceStep) -> StepPiece:
    """Translate CrossProduct: both vectors turned by one place and by two, and multiplied."""
    first, second = b.first("input"), b.first("input 2")
    if first != (3,) or second != (3,):
        raise Refused(f"its inputs do not have three entries: {list(first)} and {list(second)}")
    axis = b.axes(first)[0]
    names = [b.named(w) for w in ("a turned", "a turned back", "b turned", "b turned back")]
    up, down, minus = b.named("products"), b.named("products back"), b.named("minus")
    turns = (1, -1, 1, -1)
    return StepPiece(
        [
            Sum(name=b.label),
            Product(name=up),
            Product(name=down),
            Gain(-1.0, name=minus),
            *(
                AxisWeights(np.roll(np.eye(3), k, axis=1), axis, name=n)
                for n, k in zip(names, turns, strict=True)
            ),
        ],
        {
            "input": [[InputSlot(names[0]), InputSlot(names[1])]],
            "input 2": [[InputSlot(names[2]), InputSlot(names[3])]],
        },
        {"output": OutputSlot(b.label, (3,))},
        [
            (names[0], up),
            (names[3], up, "factor"),
            (names[1], down),
            (names[2], down, "factor"),
            (up, b.label),
            (down, minus),
            (minus, b.label),
        ],
        needs=("input", "input 2"),
        why="AxisWeights and Product",
    )


def matrix_multiply(b: SourceStep) -> StepPiece:
    """Translate MatrixMultiply: all products of samples, summed over the shared dimension.

    One dimension is a column.
    """
    first, second = b.first("operand1"), b.first("operand2")
    turned = b.values.flag("transposeOperand1", False)
    if len(first) > 2 or len(second) > 2:
        raise Refused(f"its operands are not matrices: {list(first)} and {list(second)}")
    rows, columns = (*first, 1, 1)[:2], (*second, 1, 1)[:2]
    rows = rows[::-1] if turned else rows
    if rows[1] != columns[0]:
        raise Refused(f"the sizes {list(rows)} and {list(columns)} cannot be multiplied")
    counts = (rows[0], rows[1], columns[1])
    if math.prod(counts) > MOST_PRODUCTS:
        raise Unfit(f"deodar multiplies matrices of moderate size, not {list(rows)} by {list(columns)}")
    axes = i, k, j = tuple(
        dc.replace(b.grid.axis(0, n), name=f"of {name}") for n, name in zip(counts, "ikj", strict=True)
    )
    c = Composition(b)
    places = [[k, i] if turned else [i, k], [k, j]]
    left, right = (
        c.projected(side, c.slot(slot), b.axes(dims), axes, places[d][: len(dims)])
        for d, (side, slot, dims) in enumerate((("left", "operand1", first), ("right", "operand2", second)))
    )
    dims = tuple(n for n in (counts[0], counts[2]) if n > 1)
    free_axes = list(b.axes(dims))
    ends = [free_axes.pop(0) if n > 1 and d != 1 else None for d, n in enumerate(counts)]
    product = c.product("products", left, right)
    c.outlet("matrixProduct", c.projected("", product, axes, b.axes(dims), ends), dims)
    return c.done("Product of two Project, summed")


def pseudo_inverse(b: SourceStep) -> StepPiece:
    """Translate PseudoInverse; a number becomes its inverse, and 0 remains 0."""
    dims, c = b.first("matrix"), Composition(b)
    matrix = c.slot("matrix")
    if len(dims) > 2:
        raise Refused(f"its input has {len(dims)} dimensions")
    if len(dims) == 2:
        inverse = c.add(PseudoInverse(name=b.named("inverse")), input=matrix)
        target_axes, source_axes = b.axes(dims[::-1]), b.axes(dims)
        turned = c.projected("", inverse, source_axes[::-1], target_axes, list(target_axes))
        c.outlet("inverted", turned, dims[::-1])
        return c.done("PseudoInverse")
    if dims:
        c.outlet("inverted", c.add(PseudoInverse(name=b.label), input=matrix), dims)
        return c.done("PseudoInverse")
    c.outlet("inverted", c.quotient("", matrix, c.function("square", "square", matrix), TINY), ())
    return c.done("Quotient by its square")


CLASSES = {
    "cedar.processing.AbsoluteValue": absolute,
    "cedar.processing.steps.Logarithm": logarithm,
    "cedar.processing.steps.Sinus": sinus,
    "cedar.processing.steps.LinearFunction": linear,
    "cedar.processing.DivideElementwise": divide,
    "cedar.processing.ScalarDivision": divide_by_scalar,
    "cedar.processing.steps.Maximum": maximum,
    "cedar.processing.steps.Minimum": minimum,
    "cedar.processing.Norm": norm,
    "cedar.processing.Normalization": normalization,
    "cedar.processing.RemoveMean": remove_mean,
    "cedar.processing.steps.InnerProduct": inner_product,
    "cedar.processing.steps.OuterProduct": outer_product,
    "cedar.processing.steps.CrossProduct": cross_product,
    "cedar.processing.MatrixMultiply": matrix_multiply,
    "cedar.processing.PseudoInverse": pseudo_inverse,
}
