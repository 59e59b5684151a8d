"""Steady states along one parameter: residual, linear systems with one more row, and growth rates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from scipy.linalg import lapack
from scipy.sparse import linalg as sparse

from deodar.analysis.continuation.right_hand_side import RightHandSide
from deodar.summary import Summarised, Summary

DENSE = 600
"""Largest number of states whose matrices are stored; above, only products with them are computed."""

GrowthRates = npt.NDArray[np.complex128]
"""Growth rates per document time."""

LEADING = 8
"""Number of growth rates that are computed above `DENSE` states."""

FREE = 0.02
"""Change of a shifted state per longest time constant and length of the shift, below which the shift counts
as a neutral mode; the grid alone changes it then (a guess).
"""

SINGULAR = 1e-10
"""Ratio of the pivots of a matrix below which it counts as singular, as where a peak may stand anywhere."""


class Linearisation(Protocol):
    """The equations at one point, linear in the coordinates of the line."""

    residual: np.ndarray

    def solve(self, row: np.ndarray, right: np.ndarray, accuracy: float) -> np.ndarray:
        """Solve for a step: the rows of the equations, and one more row."""
        ...

    def rates(self) -> GrowthRates:
        """Return growth rates per document time, complex, the largest real parts first."""
        ...

    def mode(self, rate: complex) -> np.ndarray:
        """Return the mode whose growth rate is nearest to a given one: its real part, of unit length."""
        ...


@dataclass(frozen=True, repr=False)
class ParameterLine(Summarised):
    """A model in one of its parameters; a point is z = (w x, value / length).

    With w = 1 / sqrt(n) the length of a step is a root mean square of activation.

    Attributes:
        right_hand_side: the rate of change of the model, scaled.
        index: number of the parameter.
        parameters: values of all parameters.
        length: change of the parameter that counts as much as an activation of 1.
    """

    right_hand_side: RightHandSide
    index: int
    parameters: np.ndarray
    length: float

    @property
    def weight(self) -> float:
        """Return w."""
        return 1 / np.sqrt(max(self.right_hand_side.size, 1))

    @property
    def slowest(self) -> float:
        """Return the longest time constant."""
        return float(self.right_hand_side.time_constants.max(initial=1.0))

    def point(self, x: np.ndarray, value: float) -> np.ndarray:
        """Return the point of a state at a value of the parameter."""
        return np.append(self.weight * x, value / self.length)

    def state(self, z: np.ndarray) -> np.ndarray:
        """Return the state of a point."""
        return z[:-1] / self.weight

    def value(self, z: np.ndarray) -> float:
        """Return the value of the parameter at a point."""
        return float(z[-1]) * self.length

    def all_parameters(self, z: np.ndarray) -> np.ndarray:
        """Return the values of all parameters at a point."""
        out = self.parameters.copy()
        out[self.index] = self.value(z)
        return out

    def at(self, z: np.ndarray) -> Linearisation:
        """Return the equations at a point."""
        return _Dense(self, z) if self.right_hand_side.size <= DENSE else _Krylov(self, z)

    def _summary(self) -> Summary:
        return Summary(f"Model along parameter {self.index}, with {self.right_hand_side.size} states")


class _Dense:
    """The equations with their matrices."""

    def __init__(self, line: ParameterLine, z: np.ndarray) -> None:
        self.line, self.x = line, line.state(z)
        self.residual, jacobian, by = line.right_hand_side.linear(self.x, line.all_parameters(z))
        self.jacobian = jacobian
        self.rows = np.column_stack([jacobian / line.weight, by[:, line.index] * line.length])

    def solve(self, row: np.ndarray, right: np.ndarray, accuracy: float) -> np.ndarray:
        return solved(np.vstack([self.rows, row]), right)

    def rates(self) -> GrowthRates:
        matrix = self.jacobian / self.line.right_hand_side.time_constants[:, None]
        eigenvalues: GrowthRates = np.linalg.eigvals(matrix).astype(np.complex128)
        return _without_shifts(eigenvalues, self.line, self.x, lambda v: matrix @ v)

    def mode(self, rate: complex) -> np.ndarray:
        rates, modes = np.linalg.eig(self.jacobian / self.line.right_hand_side.time_constants[:, None])
        return _unit(modes[:, np.argmin(np.abs(rates - rate))])


class _Krylov:
    """The equations by products with their matrices.

    The matrix of a neural field is the identity minus a smoothing operator, so that a few products suffice.
    """

    def __init__(self, line: ParameterLine, z: np.ndarray) -> None:
        self.line, self._x, self._p = line, line.state(z), line.all_parameters(z)
        self.residual = line.right_hand_side.rates(self._x, self._p)
        self._unit = np.zeros(self._p.size)
        self._unit[line.index] = 1.0

    def _along(self, dx: np.ndarray, dp: float) -> np.ndarray:
        return self.line.right_hand_side.along(self._x, self._p, dx, dp * self._unit)

    def solve(self, row: np.ndarray, right: np.ndarray, accuracy: float) -> np.ndarray:
        line, n = self.line, self._x.size

        def product(d: np.ndarray) -> np.ndarray:
            return np.append(self._along(d[:n] / line.weight, d[n] * line.length), row @ d)

        # a step in the state has the size of the residual
        scale = np.append(np.full(n, line.weight), 1.0)
        search: Any = sparse.gmres
        step, _ = search(
            _operator(n + 1, product),
            right,
            rtol=accuracy,
            atol=0.0,
            restart=80,
            maxiter=5,
            M=_operator(n + 1, lambda d: d * scale),
        )
        return step

    def rates(self) -> GrowthRates:
        tau = self.line.right_hand_side.time_constants
        growth_rates = self._leading()[0]
        return _without_shifts(growth_rates, self.line, self._x, lambda v: self._along(v, 0.0) / tau)

    def mode(self, rate: complex) -> np.ndarray:
        rates, modes = self._leading()
        return _unit(modes[:, np.argmin(np.abs(rates - rate))])

    def _leading(self) -> tuple[GrowthRates, GrowthRates]:
        """Return the leading growth rates and their modes, by Arnoldi's method."""
        tau = self.line.right_hand_side.time_constants
        return leading(self._x.size, lambda d: self._along(d, 0.0) / tau)


def _without_shifts(
    growth_rates: GrowthRates, line: ParameterLine, x: np.ndarray, product: Callable[[np.ndarray], np.ndarray]
) -> GrowthRates:
    """Return growth rates, the largest real parts first; of a peak that may stand anywhere, its shift has 0.

    A shift of the state is such a mode, if the product of the matrix and the shift is small.
    """
    rates = growth_rates.copy()
    for shift in line.right_hand_side.shifts(x):
        change = product(shift)
        if float(np.linalg.norm(change)) * line.slowest < FREE:
            rates[np.argmin(np.abs(rates - shift @ change))] = 0.0
    return rates[np.argsort(-rates.real, kind="stable")]


def leading(n: int, product: Callable[[np.ndarray], np.ndarray]) -> tuple[GrowthRates, GrowthRates]:
    """Return the eigenvalues with the largest real parts of a matrix of which products are known, and its
    eigenvectors as columns, by Arnoldi's method.
    """
    # a fixed start: the same rates in every run
    begin = np.random.default_rng(0).standard_normal(n)
    search: Any = sparse.eigs
    rates, modes = search(_operator(n, product), k=min(LEADING, n - 2), which="LR", tol=1e-8, v0=begin)
    return rates, modes


def _operator(n: int, product: Callable[[np.ndarray], np.ndarray]) -> Any:
    make: Any = sparse.LinearOperator
    return make((n, n), matvec=lambda d: product(np.asarray(d).ravel()), dtype=float)


def _unit(mode: GrowthRates) -> np.ndarray:
    # a complex mode has any phase: the one with the largest real part
    turned = mode * np.exp(-1j * np.angle(mode[np.argmax(np.abs(mode))]))
    return turned.real / np.linalg.norm(turned.real)


def solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solve a linear system; in the sense of least squares and least length where it is singular.

    The right-hand side may have several columns.
    """
    routines: Any = lapack
    factors, pivots, _ = routines.dgetrf(matrix)
    diagonal = np.abs(np.diag(factors))
    if diagonal.min() > SINGULAR * diagonal.max():
        return routines.dgetrs(factors, pivots, right)[0]
    return np.linalg.lstsq(matrix, right, rcond=1e-9)[0]
