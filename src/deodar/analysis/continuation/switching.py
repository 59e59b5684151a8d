"""The branches that leave a branch point."""

from __future__ import annotations

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.walk import ACCURACY, Walk, WalkPoint, tangent, walk

SIZES = (0.05, 0.2, 0.8)
"""Largest activations by which the state is moved along the mode, tried one after another (a guess)."""


def switched(at: Bifurcation, span: tuple[float, float], most: int) -> list[tuple[ParameterLine, Walk]]:
    """Return the walks along the other branch of a branch point, in both directions of its mode."""
    out: list[tuple[ParameterLine, Walk]] = []
    for sign in (1.0, -1.0):
        for size in SIZES:
            begin = _beside(at, sign * size * at.vector / np.abs(at.vector).max())
            if begin is not None:
                out.append((at.line, walk(at.line, begin, span, most, step=0.02)))
                break
    return out


def _beside(at: Bifurcation, move: np.ndarray) -> WalkPoint | None:
    """Return the steady state whose component along a move is that of the move, whatever the parameter.

    None if there is none on another branch.
    """
    line = at.line
    row = np.append(line.weight * move, 0.0)
    row /= np.linalg.norm(row)
    guess = line.point(at.state, at.value) + np.append(line.weight * move, 0.0)
    z = guess
    for _ in range(20):
        linear = line.at(z)
        size = np.abs(linear.residual).max()
        if not np.isfinite(size):
            return None
        if size < ACCURACY:
            moved = (line.state(z) - at.state) @ move / (move @ move)
            if moved < 0.3:
                return None
            return WalkPoint(z, tangent(linear, row), linear.rates())
        z = z + linear.solve(row, -np.append(linear.residual, row @ (z - guess)), 1e-6)
    return None
