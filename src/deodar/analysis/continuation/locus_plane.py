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
