"""Equations of parameter links, such as `target = 2 * source + 1`."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable

LONGEST = 200
"""Largest number of characters of an equation (a guess)."""

OF_TWO: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}


def solved(equation: str, source: float) -> float | None:
    """Return the target that an equation gives for a source.

    Returns:
        None: the equation is not a sum, difference, product or quotient of numbers and `source`, or its value
            is not finite.
    """
    left, sign, right = equation.partition("=")
    text = (right if sign else left).strip()
    if len(text) > LONGEST or (sign and left.strip() != "target"):
        return None
    try:
        target = _value(ast.parse(text, mode="eval").body, source)
    except (SyntaxError, ValueError, ArithmeticError, RecursionError, MemoryError):
        return None
    return target if math.isfinite(target) else None


def _value(node: ast.expr, source: float) -> float:
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return float(value)
        case ast.Name(id="source"):
            return source
        case ast.UnaryOp(op=ast.USub(), operand=inside):
            return -_value(inside, source)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OF_TWO:
            return OF_TWO[type(op)](_value(left, source), _value(right, source))
        case _:
            raise ValueError("unknown")
