"""Robotics: the null space of a Jacobian. All other steps of robots read or move one."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.pseudo_inverse import PseudoInverse
from deodar.elements.pattern import Pattern
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.functions import MOST_PRODUCTS
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.piece import Refused, SourceStep, StepPiece


def null_space(b: SourceStep) -> StepPiece:
    """Translate Nullspace: N = I - J^+ J of a Jacobian J, and N v of a vector v."""
    dims, c = b.first("jacobian"), Composition(b)
    if len(dims) != 2:
        raise Unfit(f"what it gives for a Jacobian of {len(dims)} dimensions is not documented")
    rows, columns = dims
    if rows * columns**2 > MOST_PRODUCTS:
        raise Unfit(f"deodar multiplies matrices of moderate size, not {list(dims)} by its inverse")
    k, i, j = (
        dc.replace(b.grid.axis(0, n), name=f"of {name}")
        for n, name in zip((columns, rows, columns), "kij", strict=True)
    )
    jacobian_axes, square = b.axes(dims), b.axes((columns, columns))
    jacobian = c.slot("jacobian")
    inverse = c.add(PseudoInverse(name=b.named("inverse")), input=jacobian)
    left = c.projected("left", inverse, jacobian_axes[::-1], (k, i, j), [k, i])
    right = c.projected("right", jacobian, jacobian_axes, (k, i, j), [i, j])
    products, places = c.product("products", left, right), [square[0], None, square[1]]
    row_space = c.projected("row space", products, (k, i, j), square, places)
    identity = c.add(Pattern(b.named("identity"), square, np.eye(columns)))
    space = c.total("", identity, c.gain("without row space", -1.0, row_space))
    c.outlet("nullspace", space, (columns, columns))
    if "vector" in b.ins:
        _projected(b, c, space, columns)
    return c.done("PseudoInverse, Product and Project")


def _projected(b: SourceStep, c: Composition, space: StepSignal, count: int) -> None:
    """Add the outlets that show the part of the vector inside the null space, and the rest of it."""
    if math.prod(b.first("vector")) != count or len(b.first("vector")) > 1:
        raise Refused(f"its vector has the size {list(b.first('vector'))}, and its Jacobian {count} columns")
    line, square = b.axes((count,)), b.axes((count, count))
    vector = c.slot("vector", optional=True)
    wide = c.projected("vector in rows", vector, line, square, [square[1]])
    inside = c.projected(
        "projected vector", c.product("weighted", space, wide), square, line, [line[0], None]
    )
    orthogonal = c.total("orthogonal vector", vector, c.gain("without projection", -1.0, inside))
    c.outlet("projected vector", inside, (count,))
    doubt = "that it is the rest of the vector is a guess"
    c.outlet("orthogonal vector", orthogonal, (count,), doubt=doubt)


CLASSES = {"cedar.processing.Nullspace": null_space}
