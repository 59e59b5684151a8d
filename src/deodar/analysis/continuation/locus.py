"""A fold or branch point in two parameters: the line that it draws in their plane."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.dynamics import Dynamics
from deodar.analysis.continuation.line import DENSE, solved
from deodar.analysis.continuation.walk import zero
from deodar.codec import JsonObject
from deodar.errors import AnalysisError, ParameterError
from deodar.parameters import show

ACCURACY = 1e-9
LONGEST, SHORTEST = 0.5, 1e-6
MOST = 600
"""Largest number of points in each direction."""


@dataclass(frozen=True)
class LocusPoint:
    """A point at which the locus itself changes.

    Attributes:
        kind: `cusp`, where two folds meet and vanish, or `Bogdanov-Takens`, where a fold meets a Hopf point.
        values: both parameters.
    """

    kind: str
    values: tuple[float, float]


@dataclass(frozen=True)
class Locus:
    """Where a bifurcation lies in the plane of two parameters.

    Attributes:
        of: kind and name of the bifurcation.
        parameters: paths of both.
        values: points of the line, one row each.
        points: cusps and Bogdanov-Takens points on it, in their order.
    """

    of: str
    parameters: tuple[str, str]
    values: np.ndarray
    points: tuple[LocusPoint, ...] = field(default=())

    def __repr__(self) -> str:
        found = "".join(f"\n  {p.kind} {p.values[0]:.6g}, {p.values[1]:.6g}" for p in self.points)
        return f"<{self.of} over {' and '.join(self.parameters)}, {len(self.values)} points{found}>"

    def data(self) -> JsonObject:
        """Return the line as plain data."""
        return {
            "of": self.of,
            "parameters": list(self.parameters),
            "values": self.values.tolist(),
            "points": [{"kind": p.kind, "values": list(p.values)} for p in self.points],
        }


def locus(
    of: Bifurcation,
    parameter: str,
    span: tuple[float, float],
    within: tuple[float, float] | None = None,
) -> Locus:
    r"""Follow a fold or branch point as a second parameter changes.

    The line is that of minimally augmented equations: F = 0, and the last component of the solution of a
    bordered system is 0, which is where the derivative of F in the state is singular.

    Equation:
        F(x, p, q) = 0,\quad g(x, p, q) = 0,\quad
        \begin{pmatrix} F_x & b \\ c^T & 0 \end{pmatrix}
        \begin{pmatrix} v \\ g \end{pmatrix} = \begin{pmatrix} 0 \\ 1 \end{pmatrix}

    Args:
        of: a fold or branch point.
        parameter: path of the second parameter.
        span: lowest and highest value of it.
        within: lowest and highest value of the first one; None: ten times its distance from 0, at least 10.

    Raises:
        AnalysisError: it is a Hopf point, or the model has more states than are kept as matrices.
        ParameterError: a path is unknown, or a span is not an interval.

    Reference:
        Govaerts (2000), Numerical methods for bifurcations of dynamical equilibria, chapter 3 (minimally
        augmented systems).
    """
    if of.kind == "Hopf":
        raise AnalysisError("a Hopf point cannot be followed", fix="Give a fold or a branch point")
    line = of.line
    if line.dynamics.size > DENSE:
        raise AnalysisError(
            f"the model has {line.dynamics.size} states, and a locus is followed with at most {DENSE}",
            fix="Use a coarser grid, or even=[...]",
        )
    first = line.dynamics.parameters[line.index]
    if parameter == first:
        raise ParameterError("is the first parameter", where=parameter, fix="Name another one")
    reach = 10 * max(1.0, abs(of.value))
    box = np.array([_interval(within or (-reach, reach)), _interval(span)])
    plane = _Plane(of, parameter, box)
    start = plane.start(of)
    sides = [plane.follow(start, sign) for sign in (-1.0, 1.0)]
    walked = [*reversed(sides[0][1:]), *sides[1]]
    values = np.array([plane.values(z) for z in walked])
    name = f"{of.kind} ({of.instability})" if of.instability else of.kind
    # at a branch point both tests are 0 by symmetry
    found = plane.points(walked) if of.kind == "fold" else []
    return Locus(name, (first, parameter), values, tuple(found))


def _interval(span: tuple[float, float]) -> tuple[float, float]:
    try:
        low, high = sorted(float(value) for value in span)
    except (TypeError, ValueError):
        raise ParameterError(f"the span is {show(span)}; expected two numbers") from None
    if not (math.isfinite(low) and math.isfinite(high)) or low == high:
        raise ParameterError(f"the span is {show(span)}; expected two different, finite numbers")
    return low, high


class _Plane:
    """The augmented equations; a point is z = (w x, p / length, q / length)."""

    def __init__(self, of: Bifurcation, parameter: str, box: np.ndarray) -> None:
        line = of.line
        own = line.dynamics
        self.box = box
        self.dynamics = Dynamics(
            own.model, own.doc, [own.parameters[line.index], parameter], own.at, own.held, own.even
        )
        # other parameters of the line keep their values
        for path, value in zip(own.parameters, line.parameters, strict=True):
            if path not in self.dynamics.parameters and value != _value(own, path):
                raise AnalysisError(f"{path} has another value on the branch than in the model")
        self.weight = line.weight
        self.lengths = np.array([line.length, abs(box[1, 1] - box[1, 0]) / 10])
        self.left = self.right = np.zeros(0)
        self.seen = self.right, self.left

    def values(self, z: np.ndarray) -> np.ndarray:
        """Return both parameters."""
        return z[-2:] * self.lengths

    def state(self, z: np.ndarray) -> np.ndarray:
        return z[:-2] / self.weight

    def start(self, of: Bifurcation) -> np.ndarray:
        """Return the bifurcation as a point, and take its null vectors as borders."""
        values = np.array([of.value, self.dynamics.values[1]])
        z = np.append(self.weight * of.state, values / self.lengths)
        jacobian = self.dynamics.linear(of.state, values)[1]
        left, _, right = np.linalg.svd(jacobian)
        self.left, self.right = left[:, -1], right[-1]
        return z

    def linear(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return residuals and rows of the equations, and the null vectors: right and left."""
        own, x, p = self.dynamics, self.state(z), self.values(z)
        rates, jacobian, by = own.linear(x, p)
        n = x.size
        bordered = np.zeros((n + 1, n + 1))
        bordered[:n, :n], bordered[:n, n], bordered[n, :n] = jacobian, self.left, self.right
        unit = np.append(np.zeros(n), 1.0)
        v, w = solved(bordered, unit), solved(bordered.T, unit)
        by_state, by_parameter = own.curvature(x, p, v[:n], w[:n])
        top = np.column_stack([jacobian / self.weight, by * self.lengths])
        bottom = np.append(-by_state / self.weight, -by_parameter * self.lengths)
        return np.append(rates, v[n]), np.vstack([top, bottom]), v[:n], w[:n]

    def direction(self, rows: np.ndarray, before: np.ndarray) -> np.ndarray:
        found = solved(np.vstack([rows, before]), np.append(np.zeros(len(rows)), 1.0))
        return found / np.linalg.norm(found)

    def corrected(self, guess: np.ndarray, row: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the point of the locus in the plane through a guess across a direction, and its rows."""
        z = guess
        for effort in range(8):
            residual, rows, v, w = self.linear(z)
            size = np.abs(residual).max()
            if size < ACCURACY and effort > 0:
                self.right, self.left = v / np.linalg.norm(v), w / np.linalg.norm(w)
                return z, rows
            if not np.isfinite(size) or size > 1e4:
                return None
            z = z + solved(np.vstack([rows, row]), -np.append(residual, row @ (z - guess)))
        return None

    def follow(self, start: np.ndarray, sign: float) -> list[np.ndarray]:
        """Return the points in one direction of the second parameter, until the box is left."""
        residual, rows, _, _ = self.linear(start)
        assert np.isfinite(residual).all()
        ahead = self.direction(rows, np.append(np.zeros(start.size - 1), sign))
        points, size = [start], 0.1
        borders = self.left, self.right
        while len(points) < MOST:
            guess = points[-1] + size * ahead
            kept = self.left, self.right
            found = self.corrected(guess, ahead)
            new = self.direction(found[1], ahead) if found is not None else ahead
            if found is None or new @ ahead < 0.9 or np.linalg.norm(found[0] - guess) > 0.3 * size:
                self.left, self.right = kept
                size /= 2
                if size < SHORTEST:
                    break
                continue
            points.append(found[0])
            ahead, size = new, min(1.5 * size, LONGEST)
            values = self.values(points[-1])
            if (values < self.box[:, 0]).any() or (values > self.box[:, 1]).any():
                break
        self.left, self.right = borders
        return points

    def points(self, walked: list[np.ndarray]) -> list[LocusPoint]:
        """Return the cusps and Bogdanov-Takens points between points."""
        out: list[LocusPoint] = []
        for kind, test in {"cusp": self._bend, "Bogdanov-Takens": self._double}.items():
            before: float | None = None
            self.seen = self._null(walked[0])
            for k, z in enumerate(walked):
                now = test(z)
                if before is not None and before * now < 0:
                    place = self._between(walked[k - 1], z, test)
                    if place is not None:
                        out.append(LocusPoint(kind, (float(place[0]), float(place[1]))))
                before = now
        return out

    def _vectors(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the null vectors, right and left; their signs follow the line."""
        v, w = self._null(z)
        return v * _sign(float(v @ self.seen[0])), w * _sign(float(w @ self.seen[1]))

    def _null(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        left, _, right = np.linalg.svd(self.dynamics.linear(self.state(z), self.values(z))[1])
        return right[-1], left[:, -1]

    def _bend(self, z: np.ndarray) -> float:
        """Return w F_xx v v, which is 0 at a cusp."""
        v, w = self.seen = self._vectors(z)
        by_state, _ = self.dynamics.curvature(self.state(z), self.values(z), v, w)
        # the sign of v does not matter, that of w follows the line
        return float(by_state @ v)

    def _double(self, z: np.ndarray) -> float:
        """Return w T v, which is 0 where 0 is a double growth rate."""
        v, w = self.seen = self._vectors(z)
        return float(w @ (self.dynamics.time_constants * v))

    def _between(
        self, before: np.ndarray, after: np.ndarray, test: Callable[[np.ndarray], float]
    ) -> np.ndarray | None:
        """Return both parameters where a test is 0 between two points."""
        chord = after - before
        row = chord / np.linalg.norm(chord)
        reached: dict[float, np.ndarray] = {}

        def at(share: float) -> float:
            found = self.corrected(before + share * chord, row)
            if found is None:
                raise ValueError
            reached[share] = found[0]
            return test(found[0])

        try:
            share = zero(at)
        except ValueError:
            return None
        return self.values(reached[share]) if share in reached else None


def _sign(number: float) -> float:
    return -1.0 if number < 0 else 1.0


def _value(dynamics: Dynamics, path: str) -> float:
    return float(dynamics.values[dynamics.parameters.index(path)])
