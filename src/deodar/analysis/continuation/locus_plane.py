"""Lines of bifurcations in the plane of two parameters: following them, and locating points on them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import solved
from deodar.analysis.continuation.right_hand_side import RightHandSide
from deodar.analysis.continuation.walk import zero
from deodar.summary import Summarised, Summary

ACCURACY = 1e-9
"""Largest residual of a point of a line."""

LONGEST, SHORTEST = 0.5, 1e-6
"""Steps along a line, in root mean square of activation."""

MOST = 600
"""Largest number of points in each direction."""


@dataclass(frozen=True, repr=False)
class LocusPoint(Summarised):
    """A point at which the locus itself changes.

    Attributes:
        kind: `cusp`, where two folds meet and vanish, or `Bogdanov-Takens`, where a fold meets a Hopf point.
        values: both parameters.
    """

    kind: str
    values: tuple[float, float]

    def _summary(self) -> Summary:
        return Summary(f"{self.kind} at {self.values[0]:.6g}, {self.values[1]:.6g}")


@dataclass(frozen=True)
class LocusEquations:
    """The equations of a line at one point, linear in its coordinates.

    Attributes:
        residual: what is 0 on the line.
        rows: its derivatives, one row for each equation; there is one column more than rows.
        borders: null vectors there, with which the next point is solved.
    """

    residual: np.ndarray
    rows: np.ndarray
    borders: tuple[np.ndarray, np.ndarray]


class LocusPlane(ABC):
    """The equations of a bifurcation over two parameters.

    The last two coordinates of a point z are both parameters, each divided by a length, and the first are the
    state times a weight w, so that the length of a step is a root mean square of activation.

    Args:
        of: the bifurcation.
        parameter: path of the second parameter.
        box: lowest and highest values of both, one row each.
    """

    def __init__(self, of: Bifurcation, parameter: str, box: np.ndarray) -> None:
        line, equations = of.line, of.line.right_hand_side
        self.box, self.weight = box, line.weight
        values = line.parameters
        if parameter not in equations.parameters:
            wide = (*equations.parameters, parameter)
            equations = RightHandSide(
                equations.model, equations.doc, wide, equations.at, equations.held, equations.even
            )
            values = np.append(values, equations.values[-1])
        self.right_hand_side: RightHandSide = equations
        self.columns = [line.index, equations.parameters.index(parameter)]
        self.first = float(values[self.columns[1]])
        self._values = values
        self.lengths = np.array([line.length, abs(box[1, 1] - box[1, 0]) / 10])
        self.borders: tuple[np.ndarray, np.ndarray] = np.zeros(0), np.zeros(0)

    @abstractmethod
    def start(self, of: Bifurcation) -> np.ndarray:
        """Return the bifurcation as a point, and take its null vectors as borders."""

    @abstractmethod
    def linear(self, z: np.ndarray) -> LocusEquations:
        """Return the equations at a point."""

    @abstractmethod
    def points(self, walked: list[np.ndarray]) -> list[LocusPoint]:
        """Return the points on the line at which it changes, in its order."""

    def left(self, z: np.ndarray) -> bool:
        """Return whether the line ends before this point."""
        values = self.values(z)
        return bool((values < self.box[:, 0]).any() or (values > self.box[:, 1]).any())

    def ended(self, before: np.ndarray, after: np.ndarray) -> list[np.ndarray]:
        """Return the points with which a line ends that has been left between two points."""
        return [after]

    def values(self, z: np.ndarray) -> np.ndarray:
        """Return both parameters."""
        return z[-2:] * self.lengths

    def state(self, z: np.ndarray) -> np.ndarray:
        """Return the state."""
        return z[: self.right_hand_side.size] / self.weight

    def parameters(self, z: np.ndarray) -> np.ndarray:
        """Return the values of all parameters of the right-hand side."""
        out = self._values.copy()
        out[self.columns] = self.values(z)
        return out

    def both(self, of: Bifurcation) -> list[np.ndarray]:
        """Return the points of the line on both sides of a bifurcation."""
        start = self.start(of)
        back, forth = (self.follow(start, sign) for sign in (-1.0, 1.0))
        return [*reversed(back[1:]), *forth]

    def follow(self, start: np.ndarray, sign: float) -> list[np.ndarray]:
        """Return the points in one direction of the second parameter, until the line is left."""
        ahead = self._direction(self.linear(start).rows, np.append(np.zeros(start.size - 1), sign))
        points, size = [start], 0.1
        borders = self.borders
        while len(points) < MOST:
            guess = points[-1] + size * ahead
            borders_before = self.borders
            correction = self.corrected(guess, ahead)
            new = self._direction(correction[1], ahead) if correction is not None else ahead
            if correction is None or new @ ahead < 0.9 or np.linalg.norm(correction[0] - guess) > 0.3 * size:
                self.borders = borders_before
                size /= 2
                if size < SHORTEST:
                    break
                continue
            if self.left(correction[0]):
                points += self.ended(points[-1], correction[0])
                break
            points.append(correction[0])
            ahead, size = new, min(1.5 * size, LONGEST)
        self.borders = borders
        return points

    def corrected(self, guess: np.ndarray, row: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the point of the line in the plane through a guess across a direction, and its rows."""
        z = guess
        for effort in range(8):
            at = self.linear(z)
            size = np.abs(at.residual).max()
            if size < ACCURACY and effort > 0:
                self.borders = at.borders
                return z, at.rows
            if not np.isfinite(size) or size > 1e4:
                return None
            z = z + solved(np.vstack([at.rows, row]), -np.append(at.residual, row @ (z - guess)))
        return None

    def between(
        self, before: np.ndarray, after: np.ndarray, test: Callable[[np.ndarray], float]
    ) -> np.ndarray | None:
        """Return the point at which a test is 0 between two points; None if it is not found."""
        chord = after - before
        row = chord / np.linalg.norm(chord)
        reached: dict[float, np.ndarray] = {}

        def at(share: float) -> float:
            correction = self.corrected(before + share * chord, row)
            if correction is None:
                raise ValueError
            reached[share] = correction[0]
            return test(correction[0])

        try:
            return reached.get(zero(at))
        except ValueError:
            return None

    def _direction(self, rows: np.ndarray, before: np.ndarray) -> np.ndarray:
        direction = solved(np.vstack([rows, before]), np.append(np.zeros(len(rows)), 1.0))
        return direction / np.linalg.norm(direction)


class FoldPlane(LocusPlane):
    """The minimally augmented equations of a fold or branch point; a point is z = (w x, p / l, q / l)."""

    _symmetric = False
    _seen: tuple[np.ndarray, np.ndarray] = np.zeros(0), np.zeros(0)

    def start(self, of: Bifurcation) -> np.ndarray:
        """Return the bifurcation as a point, and take its null vectors as borders."""
        self._symmetric = of.kind == "branch point"
        z = np.concatenate([self.weight * of.state, np.array([of.value, self.first]) / self.lengths])
        self.borders = self._null(z)
        return z

    def linear(self, z: np.ndarray) -> LocusEquations:
        """Return the equations at a point; the borders are its null vectors, right and left."""
        equations, x, p = self.right_hand_side, self.state(z), self.parameters(z)
        rates, jacobian, by = equations.linear(x, p)
        n = x.size
        bordered = np.zeros((n + 1, n + 1))
        right, left = self.borders
        bordered[:n, :n], bordered[:n, n], bordered[n, :n] = jacobian, left, right
        unit = np.append(np.zeros(n), 1.0)
        v, w = solved(bordered, unit), solved(bordered.T, unit)
        by_state, by_parameter = equations.curvature(x, p, v[:n], w[:n])
        top = np.column_stack([jacobian / self.weight, by[:, self.columns] * self.lengths])
        bottom = np.append(-by_state / self.weight, -by_parameter[self.columns] * self.lengths)
        borders = v[:n] / np.linalg.norm(v[:n]), w[:n] / np.linalg.norm(w[:n])
        return LocusEquations(np.append(rates, v[n]), np.vstack([top, bottom]), borders)

    def points(self, walked: list[np.ndarray]) -> list[LocusPoint]:
        """Return the cusps and Bogdanov-Takens points."""
        if self._symmetric:
            return []  # both tests are 0 by symmetry
        out: list[tuple[int, LocusPoint]] = []
        for kind, test in {"cusp": self._bend, "Bogdanov-Takens": self._double}.items():
            before: float | None = None
            self._seen = self._null(walked[0])
            for k, z in enumerate(walked):
                after = test(z)
                if before is not None and before * after < 0:
                    place = self.between(walked[k - 1], z, test)
                    if place is not None:
                        first, second = self.values(place)
                        out.append((k, LocusPoint(kind, (float(first), float(second)))))
                before = after
        return [point for _, point in sorted(out, key=lambda pair: pair[0])]

    def beyond(self, z: np.ndarray) -> np.ndarray:
        """Return the direction in the plane in which both states of a fold vanish, in lengths."""
        equations, x, p = self.right_hand_side, self.state(z), self.parameters(z)
        v, w = self._null(z)
        bend = float(equations.curvature(x, p, v, w)[0] @ v)
        slopes = equations.gradient(x, p, w)[self.columns] * self.lengths
        return slopes * _sign(bend) / (np.linalg.norm(slopes) or 1.0)

    def _vectors(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the null vectors, right and left; their signs follow the line."""
        v, w = self._null(z)
        return v * _sign(float(v @ self._seen[0])), w * _sign(float(w @ self._seen[1]))

    def _null(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        left, _, right = np.linalg.svd(self.right_hand_side.linear(self.state(z), self.parameters(z))[1])
        return right[-1], left[:, -1]

    def _bend(self, z: np.ndarray) -> float:
        """Return w F_xx v v, which is 0 at a cusp."""
        v, w = self._seen = self._vectors(z)
        by_state, _ = self.right_hand_side.curvature(self.state(z), self.parameters(z), v, w)
        # the sign of v does not matter, that of w follows the line
        return float(by_state @ v)

    def _double(self, z: np.ndarray) -> float:
        """Return w T v, which is 0 where 0 is a double growth rate."""
        v, w = self._seen = self._vectors(z)
        return float(w @ (self.right_hand_side.time_constants * v))


def _sign(number: float) -> float:
    return -1.0 if number < 0 else 1.0


class HopfPlane(LocusPlane):
    r"""The minimally augmented equations of a Hopf point; a point is z = (w x, k, p / l, q / l).

    The matrix A of growth rates, in units of the longest time constant, has the eigenvalues i omega and -i
    omega where A^2 + k has rank n - 2, with k = omega^2. At k = 0 the line ends in a Bogdanov-Takens point;
    beyond it two real growth rates have the sum 0, and nothing oscillates.

    Equation:
        \begin{pmatrix} A^2 + k & B \\ C^T & 0 \end{pmatrix}
        \begin{pmatrix} V \\ G \end{pmatrix} = \begin{pmatrix} 0 \\ 1 \end{pmatrix},\quad G = 0

    G has four numbers and two of them are independent on the line: the two combinations that change most.
    """

    def start(self, of: Bifurcation) -> np.ndarray:
        """Return the bifurcation as a point, and take its null vectors as borders."""
        values = np.array([of.value, self.first]) / self.lengths
        z = np.concatenate([self.weight * of.state, [(of.frequency * self._unit) ** 2], values])
        matrix = self._matrix(z)
        left, _, right = np.linalg.svd(matrix @ matrix + self._square(z) * np.eye(len(matrix)))
        self.borders = right[-2:].T, left[:, -2:]
        return z

    def linear(self, z: np.ndarray) -> LocusEquations:
        """Return the equations at a point; the borders span its null spaces, right and left."""
        equations, x, p, unit = self.right_hand_side, self.state(z), self.parameters(z), self._unit
        rates, jacobian, by = equations.linear(x, p)
        scale = unit / equations.time_constants
        a, n = jacobian * scale[:, None], x.size
        bordered = np.zeros((n + 2, n + 2))
        bordered[:n, :n] = a @ a + self._square(z) * np.eye(n)
        right, left = self.borders
        bordered[:n, n:], bordered[n:, :n] = left, right.T
        units = np.vstack([np.zeros((n, 2)), np.eye(2)])
        v, w = solved(bordered, units), solved(bordered.T, units)
        rows: list[np.ndarray] = []
        for i in (0, 1):
            for j in (0, 1):
                to, back = v[:n, j], w[:n, i]
                # w d(A^2) v = w dA (A v) + (w A) dA v
                pairs = ((a @ to, scale * back), (to, scale * (back @ a)))
                by_state, by_parameter = (
                    sum(parts)
                    for parts in zip(*(equations.curvature(x, p, *pair) for pair in pairs), strict=True)
                )
                parameters = np.asarray(by_parameter)[self.columns] * self.lengths
                rows.append(-np.concatenate([by_state / self.weight, [back @ to], parameters]))
        # two combinations of the four: those in which the line is steepest
        steepest = np.linalg.svd(np.array(rows))[0][:, :2]
        top = np.column_stack([jacobian / self.weight, np.zeros(n), by[:, self.columns] * self.lengths])
        residual = np.append(rates, steepest.T @ v[n:].ravel())
        borders = np.linalg.qr(v[:n])[0], np.linalg.qr(w[:n])[0]
        return LocusEquations(residual, np.vstack([top, steepest.T @ np.array(rows)]), borders)

    def left(self, z: np.ndarray) -> bool:
        """Return whether the line ends before this point: outside of the box, or where nothing oscillates."""
        return super().left(z) or self._square(z) < 0

    def ended(self, before: np.ndarray, after: np.ndarray) -> list[np.ndarray]:
        """Return the Bogdanov-Takens point in which a line ends, or its first point outside of the box."""
        if self._square(after) >= 0:
            return [after]
        place = self.between(before, after, self._square)
        if place is None:
            return []
        place[-3] = 0.0
        return [place]

    def points(self, walked: list[np.ndarray]) -> list[LocusPoint]:
        """Return the Bogdanov-Takens points at the ends."""
        ends = [walked[0], walked[-1]] if len(walked) > 1 else []
        values = [self.values(z) for z in ends if self._square(z) == 0]
        return [LocusPoint("Bogdanov-Takens", (float(first), float(second))) for first, second in values]

    def frequency(self, z: np.ndarray) -> float:
        """Return the angular frequency at a point, per document time."""
        return float(np.sqrt(max(self._square(z), 0.0))) / self._unit

    @property
    def _unit(self) -> float:
        return float(self.right_hand_side.time_constants.max())

    def _square(self, z: np.ndarray) -> float:
        """Return k."""
        return float(z[-3])

    def _matrix(self, z: np.ndarray) -> np.ndarray:
        """Return A."""
        equations = self.right_hand_side
        jacobian = equations.linear(self.state(z), self.parameters(z))[1]
        return jacobian * (self._unit / equations.time_constants)[:, None]
