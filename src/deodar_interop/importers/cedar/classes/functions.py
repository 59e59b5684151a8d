"""Algebra beyond sums and products: functions of each sample, quotients, norms, vectors, inverses."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.weights import AxisWeights, PseudoInverse
from deodar.elements.stimuli import Pattern
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.algebra import chain
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.file import items, text
from deodar_interop.importers.cedar.piece import Refused

MOST_PRODUCTS = 4_000_000
"""Most products of samples in a product of matrices (a guess)."""

TINY = 1e-30


@step("cedar.processing.AbsoluteValue", "input", gives="absolute value")
def absolute(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate AbsoluteValue."""
    return s.function("", "abs", seen)


@step("cedar.processing.steps.Logarithm", "input", gives="result")
def logarithm(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Logarithm: ln x / ln base; the base may be an input."""
    base, of_input = s.optional("base (optional)", ()), s.function("ln", "log", seen)
    if base is not None:
        whole = s.quotient("ln by ln", of_input, s.function("ln of the base", "log", base), TINY)
        s.explain("Quotient of two Pointwise")
        # the logarithm of 0 is infinite in cedar, and what is divided by it 0
        return s.product("", whole, s.above("a base", 0.0, base))
    number = s.values.number("base", math.e, TINY)
    if number == 1:
        raise Refused("its base is 1")
    s.explain("Pointwise and Gain")
    return s.gain("", 1 / math.log(number), of_input)


@step("cedar.processing.steps.Sinus", "input", gives="result", why="Pointwise and Gain")
def sinus(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Sinus: A sin(x + shift)."""
    amplitude, shift = s.values.number("amplitude", 1.0), s.values.number("phase shift", 0.0)
    function = "cos" if s.values.flag("make cos", False) else "sin"
    signals = _with_shift(s, seen, "phase shift (optional)", shift)
    return s.gain("", amplitude, s.function(function, function, *signals))


@step("cedar.processing.steps.LinearFunction", "input", gives="result")
def linear(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate LinearFunction: slope (x + shift)."""
    slope, shift = s.values.number("slope", 1.0), s.values.number("horizontal shift", 0.0)
    return s.gain("", slope, *_with_shift(s, seen, "horizontal shift (optional)", shift))


def _with_shift(s: SourceStep, seen: StepSignal, slot: str, shift: float) -> list[StepSignal]:
    """Return the input and its shift: that of a slot if something is connected there, else a constant."""
    shift_signal = s.optional(slot)
    if shift_signal is None and shift:
        shift_signal = s.constant("shift", shift)
    return [seen] if shift_signal is None else [seen, shift_signal]


@step("cedar.processing.DivideElementwise", "dividend", "divisor", gives="result")
def divide(s: SourceStep, dividend: StepSignal, divisor: StepSignal) -> StepSignal:
    """Translate DivideElementwise; a divisor of 0 gives a very large number."""
    s.require_equal(dividend, divisor)
    return s.quotient("", dividend, divisor, TINY)


@step("cedar.processing.ScalarDivision", "matrix", "divisor", gives="result")
def divide_by_scalar(s: SourceStep, seen: StepSignal, divisor: StepSignal) -> StepSignal:
    """Translate ScalarDivision; a divisor near 0 is replaced."""
    if divisor.dims:
        raise Refused("its divisor is not one number")
    least = s.values.number("zero divisor replacement", 1e-6, TINY)
    if not s.values.flag("treat division by zero", True):
        least = TINY
    return s.quotient("", seen, divisor, least)


@step("cedar.processing.steps.Maximum", gives="maximum")
def maximum(s: SourceStep) -> StepSignal:
    """Translate Maximum."""
    return chain(s, "terms", lambda role, first, second: s.limit(role, "upper", first, second), "of {1}")


@step("cedar.processing.steps.Minimum", gives="minimum")
def minimum(s: SourceStep) -> StepSignal:
    """Translate Minimum."""
    return chain(s, "terms", lambda role, first, second: s.limit(role, "lower", first, second), "of {1}")


@step("cedar.processing.Norm", "input", gives="output", why="Pointwise and Project")
def norm(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Norm: the root of the sum of squares."""
    return _norm(s, "L2Norm", "", seen)


def _norm(s: SourceStep, kind: str, role: str, seen: StepSignal) -> StepSignal:
    """Add a norm of a signal."""
    if kind == "L2Norm":
        squares = s.function("of each sample", "square", seen)
        return s.function(role, "root", s.reduced("whole", squares))
    sizes = s.function("of each sample", "abs", seen)
    return s.reduced(role, sizes, "sum" if kind == "L1Norm" else "max")


@step("cedar.processing.Normalization", "input", gives="normalized input", why="Quotient by a norm")
def normalization(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Normalization: the input divided by its norm."""
    kind = s.values.word("normalization type", "L2Norm", ("None", "InfinityNorm", "L1Norm", "L2Norm"))
    listed = [text(v) == "true" for v in items(s.values.body.get("normalized dimensions"))]
    if any(listed) and not all(listed):
        raise Unfit("it normalizes along some of its dimensions")
    s.values.say("normalized dimensions")
    if kind == "None":
        return s.copy(seen)
    return s.quotient("", seen, _norm(s, kind, "norm", seen), TINY)


@step("cedar.processing.RemoveMean", "matrix", gives="mean-free matrix", why="Sum with minus the mean")
def remove_mean(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate RemoveMean."""
    return s.total("", seen, s.gain("minus", -1.0, s.reduced("mean", seen, "mean")))


@step("cedar.processing.steps.InnerProduct", "input", "input 2", gives="output", why="Product and Project")
def inner_product(s: SourceStep, first: StepSignal, second: StepSignal) -> StepSignal:
    """Translate InnerProduct."""
    s.require_equal(first, second)
    return s.reduced("", s.product("products", first, second))


@step("cedar.processing.steps.OuterProduct", "input", "input 2", gives="output", why="Product of two Project")
def outer_product(s: SourceStep, first: StepSignal, second: StepSignal) -> StepSignal:
    """Translate OuterProduct: a column times a row."""
    if len(first.dims) != 1 or len(second.dims) != 1:
        raise Refused(f"its inputs are not vectors: {list(first.dims)} and {list(second.dims)}")
    axes = s.axes((*first.dims, *second.dims))
    column = s.projected("column", first, axes, axes[:1])
    return s.product("", column, s.projected("row", second, axes, axes[1:]))


@step(
    "cedar.processing.steps.CrossProduct", "input", "input 2", gives="output", why="AxisWeights and Product"
)
def cross_product(s: SourceStep, first: StepSignal, second: StepSignal) -> StepSignal:
    """Translate CrossProduct: both vectors turned by one place and by two, and multiplied."""
    if first.dims != (3,) or second.dims != (3,):
        raise Refused(f"its inputs do not have three entries: {list(first.dims)} and {list(second.dims)}")

    def turned(role: str, signal: StepSignal, by: int) -> StepSignal:
        weights = np.roll(np.eye(3), by, axis=1)
        return s.add(AxisWeights(weights, first.axes[0], name=s.named(role)), input=signal)

    ahead = s.product("products", turned("a turned", first, 1), turned("b turned back", second, -1))
    back = s.product("products back", turned("a turned back", first, -1), turned("b turned", second, 1))
    return s.total("", ahead, s.gain("minus", -1.0, back))


@step("cedar.processing.MatrixMultiply", "operand1", "operand2", gives="matrixProduct")
def matrix_multiply(s: SourceStep, first: StepSignal, second: StepSignal) -> StepSignal:
    """Translate MatrixMultiply: all products of samples, summed over the shared dimension.

    One dimension is a column.
    """
    turned = s.values.flag("transposeOperand1", False)
    if len(first.dims) > 2 or len(second.dims) > 2:
        raise Refused(f"its operands are not matrices: {list(first.dims)} and {list(second.dims)}")
    rows, columns = (*first.dims, 1, 1)[:2], (*second.dims, 1, 1)[:2]
    rows = rows[::-1] if turned else rows
    if rows[1] != columns[0]:
        raise Refused(f"the sizes {list(rows)} and {list(columns)} cannot be multiplied")
    counts = (rows[0], rows[1], columns[1])
    if math.prod(counts) > MOST_PRODUCTS:
        raise Unfit(f"deodar multiplies matrices of moderate size, not {list(rows)} by {list(columns)}")
    axes = i, k, j = tuple(
        dc.replace(s.grid.axis(0, n), name=f"of {name}") for n, name in zip(counts, "ikj", strict=True)
    )
    left = s.projected("left", first, axes, ([k, i] if turned else [i, k])[: len(first.dims)])
    right = s.projected("right", second, axes, [k, j][: len(second.dims)])
    target_axes = s.axes(tuple(n for n in (counts[0], counts[2]) if n > 1))
    remaining = iter(target_axes)
    ends = [next(remaining) if n > 1 and d != 1 else None for d, n in enumerate(counts)]
    s.explain("Product of two Project, summed")
    return s.projected("", s.product("products", left, right), target_axes, ends)


@step("cedar.processing.PseudoInverse", "matrix", gives="inverted")
def pseudo_inverse(s: SourceStep, matrix: StepSignal) -> StepSignal:
    """Translate PseudoInverse; a number becomes its inverse, and 0 remains 0."""
    if len(matrix.dims) > 2:
        raise Refused(f"its input has {len(matrix.dims)} dimensions")
    if not matrix.dims:
        s.explain("Quotient by its square")
        return s.quotient("", matrix, s.function("square", "square", matrix), TINY)
    s.explain("PseudoInverse")
    if len(matrix.dims) == 1:
        return s.add(PseudoInverse(name=s.label), input=matrix)
    inverse = s.add(PseudoInverse(name=s.named("inverse")), matrix.axes[::-1], input=matrix)
    axes = s.axes(matrix.dims[::-1])
    return s.projected("", inverse, axes, axes)


@step("cedar.processing.Nullspace", "jacobian", "vector?", gives="nullspace")
def null_space(s: SourceStep, jacobian: StepSignal, vector: StepSignal | None) -> StepSignal:
    """Translate Nullspace: N = I - J^+ J of a Jacobian J, and N v of a vector v."""
    dims = jacobian.dims
    if len(dims) != 2:
        raise Unfit(f"what it gives for a Jacobian of {len(dims)} dimensions is not documented")
    rows, columns = dims
    if rows * columns**2 > MOST_PRODUCTS:
        raise Unfit(f"deodar multiplies matrices of moderate size, not {list(dims)} by its inverse")
    k, i, j = (
        dc.replace(s.grid.axis(0, n), name=f"of {name}")
        for n, name in zip((columns, rows, columns), "kij", strict=True)
    )
    square = s.axes((columns, columns))
    inverse = s.add(PseudoInverse(name=s.named("inverse")), jacobian.axes[::-1], input=jacobian)
    left = s.projected("left", inverse, (k, i, j), [k, i])
    right = s.projected("right", jacobian, (k, i, j), [i, j])
    row_space = s.projected(
        "row space", s.product("products", left, right), square, [square[0], None, square[1]]
    )
    identity = s.add(Pattern(s.named("identity"), square, np.eye(columns)))
    space = s.total("", identity, s.gain("without row space", -1.0, row_space))
    if vector is not None:
        _project(s, vector, space)
    s.explain("PseudoInverse, Product and Project")
    return space


def _project(s: SourceStep, vector: StepSignal, space: StepSignal) -> None:
    """Add the outlets that show the part of the vector inside the null space, and the rest of it."""
    count = space.dims[0]
    if math.prod(vector.dims) != count or len(vector.dims) > 1:
        raise Refused(f"its vector has the size {list(vector.dims)}, and its Jacobian {count} columns")
    line, square = s.axes((count,)), space.axes
    vector = dc.replace(vector, arriving_axes=line)
    wide = s.projected("vector in rows", vector, square, [square[1]])
    inside = s.projected("projected vector", s.product("weighted", space, wide), line, [line[0], None])
    s.outlet("projected vector", inside)
    orthogonal = s.total("orthogonal vector", vector, s.gain("without projection", -1.0, inside))
    s.outlet("orthogonal vector", orthogonal, doubt="that it is the rest of the vector is a guess")
