"""Robotics: the null space of a Jacobian. All other steps of robots read or move one."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.pseudo_inverse import PseudoInverse
from deodar.elements.pattern import Pattern
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.functions import MOST_PRODUCTS
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.piece import Refused


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
